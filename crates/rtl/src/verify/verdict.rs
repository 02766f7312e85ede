//! Output of a bench, and the verdict on it.

use serde::Serialize;

use super::process::{End, Overrun};

/// The first line on which the two sides differ.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Mismatch {
    /// Line of the vectors.
    pub cycle: usize,
    /// When the bench looked [ps].
    pub time_ps: u64,
    /// Port, or path of a register.
    pub signal: String,
    /// Hexadecimal digits.
    pub expected: String,
    /// Hexadecimal digits, or x and z.
    pub got: String,
}

/// Verdict on a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Every cycle is as expected.
    Pass,
    /// Cycles that differ, and the first.
    Differs {
        /// Number of cycles with a mismatch.
        mismatches: usize,
        /// The first.
        first: Mismatch,
    },
    /// The bench has stood still: something in the design goes round without a delay.
    Hangs {
        /// For how long [s].
        seconds: u64,
        /// The cycle that it last said it had reached.
        cycle: u64,
    },
    /// The block was not run.
    NotRun {
        /// Reason for that.
        reason: String,
    },
    /// The bench did not end in time.
    TimedOut {
        /// The time that it was given.
        after: Overrun,
    },
    /// The block could not be checked: it is not known whether it is as it should be.
    NotChecked {
        /// The fault that kept it from being checked.
        reason: String,
    },
    /// The bench broke off.
    Broke {
        /// Its last words.
        message: String,
    },
}

impl Verdict {
    /// From what a bench has printed.
    pub fn read(output: &str, end: End) -> Self {
        let reached = || {
            let cycle = |line: &str| line.strip_prefix("cycle ")?.parse().ok();
            output.lines().rev().find_map(cycle).unwrap_or(0)
        };
        match end {
            End::OutOfTime(after) => return Verdict::TimedOut { after },
            End::Stalled(limit) => {
                return Verdict::Hangs { seconds: limit.as_secs(), cycle: reached() };
            }
            End::Wild => {
                let message = "it has written too much".to_owned();
                return Verdict::Broke { message };
            }
            End::Exit(_) => {}
        }
        let first = output.lines().find_map(Mismatch::read);
        let total = output.lines().find_map(|line| {
            let count = line.strip_suffix(" mismatches")?;
            line.starts_with("tb_").then(|| count.rsplit(' ').next()?.parse().ok())?
        });
        match (first, total) {
            (None, Some(0)) if output.contains(": PASS, ") => Verdict::Pass,
            (Some(first), Some(mismatches)) if mismatches > 0 => {
                Verdict::Differs { mismatches, first }
            }
            _ => {
                let is_beat = |line: &&str| line.starts_with("cycle ");
                let lines: Vec<_> = output.lines().filter(|line| !is_beat(line)).collect();
                let last = lines.len().saturating_sub(6);
                Verdict::Broke { message: lines[last..].join("\n") }
            }
        }
    }
}

impl Mismatch {
    /// From a line such as `mismatch: cycle 7, time 63999 ps, depth: expected 0, got 1`.
    fn read(line: &str) -> Option<Self> {
        let rest = line.strip_prefix("mismatch: cycle ")?;
        let (cycle, rest) = rest.split_once(", time ")?;
        let (time, rest) = rest.split_once(" ps, ")?;
        let (signal, rest) = rest.split_once(": expected ")?;
        let (expected, got) = rest.split_once(", got ")?;
        Some(Mismatch {
            cycle: cycle.trim().parse().ok()?,
            time_ps: time.trim().parse().ok()?,
            signal: signal.to_owned(),
            expected: expected.to_owned(),
            got: got.to_owned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn a_pass_is_one_only_if_no_mismatch_was_printed() {
        let pass = "tb_a: PASS, 20 cycles, 0 mismatches\n- tb.v:9: Verilog $finish\n";
        assert_eq!(Verdict::read(pass, End::Exit(true)), Verdict::Pass);
        let odd = format!("mismatch: cycle 3, time 31999 ps, a: expected 1, got 0\n{pass}");
        assert!(matches!(Verdict::read(&odd, End::Exit(true)), Verdict::Broke { .. }));
        assert!(matches!(Verdict::read("", End::Exit(true)), Verdict::Broke { .. }));
    }

    #[test]
    fn a_bench_that_stands_still_says_where() {
        let output = "cycle 0\ncycle 100\nmismatch: nothing yet\n";
        let stalled = Verdict::read(output, End::Stalled(Duration::from_secs(20)));
        assert_eq!(stalled, Verdict::Hangs { seconds: 20, cycle: 100 });
        let after = Overrun::Processor(Duration::from_secs(300));
        let late = Verdict::read(output, End::OutOfTime(after));
        assert_eq!(late, Verdict::TimedOut { after });
    }

    #[test]
    fn the_first_mismatch_and_the_total_are_read() {
        let output = "mismatch: cycle 3, time 31999 ps, a.b: expected 0f, got xx\n\
            mismatch: cycle 3, time 31999 ps, c: expected 1, got 0\n\
            tb_a: FAIL, 20 cycles, 17 mismatches\nFATAL: tb.v:9: tb_a: 17 mismatches\n";
        let Verdict::Differs { mismatches, first } = Verdict::read(output, End::Exit(false)) else {
            panic!("no mismatch read");
        };
        assert_eq!((mismatches, first.cycle, first.time_ps), (17, 3, 31999));
        assert_eq!((first.signal.as_str(), first.got.as_str()), ("a.b", "xx"));
    }
}
