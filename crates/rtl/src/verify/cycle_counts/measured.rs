//! Counts, by name.

use std::collections::BTreeMap;

/// Counts under the names that [`Promise::key`](super::promises::Promise::key) has.
#[derive(Debug, Default)]
pub struct Measured(BTreeMap<String, Vec<u64>>);

impl Measured {
    /// Adds a count.
    pub fn add(&mut self, key: impl Into<String>, count: u64) {
        self.0.entry(key.into()).or_default().push(count);
    }

    /// The first count under `key` that is not `expected`; `expected` if all are; else `None`.
    pub fn count(&self, key: &str, expected: u64) -> Option<u64> {
        let counts = self.0.get(key)?;
        let odd = counts.iter().find(|&&count| count != expected);
        odd.or(counts.first()).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_odd_count_among_many_is_the_one_that_shows() {
        let mut measured = Measured::default();
        for count in [25, 24, 25] {
            measured.add("period", count);
        }
        assert_eq!(measured.count("period", 25), Some(24));
        assert_eq!(measured.count("period", 24), Some(25));
        assert_eq!(measured.count("latency", 267), None);
    }
}
