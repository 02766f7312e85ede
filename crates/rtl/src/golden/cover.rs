//! Coverage of a stimulus: cases reached, and cases that should be.

use std::collections::BTreeSet;

/// One goal: a set of cases, each to be met at least once.
#[derive(Clone, Debug, PartialEq)]
pub struct Cover {
    /// Meaning of the cases.
    pub what: &'static str,
    missing: BTreeSet<u64>,
    cases: usize,
}

impl Cover {
    /// No case met yet.
    pub fn new(what: &'static str, cases: impl IntoIterator<Item = u64>) -> Self {
        let missing: BTreeSet<_> = cases.into_iter().collect();
        Cover { what, cases: missing.len(), missing }
    }

    /// A case is met; one that is no goal is let pass.
    pub fn see(&mut self, case: u64) {
        self.missing.remove(&case);
    }

    /// A case is met if `met`.
    pub fn see_if(&mut self, met: bool, case: u64) {
        if met {
            self.see(case);
        }
    }

    /// Cases not met.
    pub fn missing(&self) -> impl Iterator<Item = u64> + '_ {
        self.missing.iter().copied()
    }

    /// Cases in all.
    pub fn cases(&self) -> usize {
        self.cases
    }

    /// Cases met.
    pub fn met(&self) -> usize {
        self.cases - self.missing.len()
    }
}

/// All numbers below `n`, or of many the first and the last eight.
pub fn ends(n: u64) -> impl Iterator<Item = u64> + Clone {
    (0..n.min(8)).chain((8..n).filter(move |k| n <= 16 || n - k <= 8))
}

/// Levels as the bits of a number, the first on top.
pub fn bits<const N: usize>(levels: [bool; N]) -> u64 {
    levels.into_iter().fold(0, |bits, level| 2 * bits + u64::from(level))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_counts_once() {
        let mut cover = Cover::new("codes", 0..4);
        cover.see(2);
        cover.see(2);
        cover.see(9);
        cover.see_if(false, 1);
        assert_eq!((cover.met(), cover.cases()), (1, 4));
        assert_eq!(cover.missing().collect::<Vec<_>>(), [0, 1, 3]);
        assert_eq!(bits([true, true, false]), 6);
    }
}
