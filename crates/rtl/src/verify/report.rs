//! Report on a block.

use std::path::PathBuf;

use super::verdict::Verdict;

/// Report on a block.
#[derive(Clone, Debug)]
pub struct BlockReport {
    /// The block, and what of it if that is not its own bench.
    pub name: String,
    /// Lines compared.
    pub cycles: usize,
    /// Result of the check.
    pub verdict: Verdict,
    /// The cycles around the first mismatch, as rows of a table; none without one.
    pub around: Vec<Vec<String>>,
    /// Inputs of the module that ours lacks and no map ties: nothing drives them.
    pub open: Vec<String>,
    /// The waveform of both sides.
    pub wave: Option<PathBuf>,
    /// Goals of the stimulus met, and goals.
    pub coverage: (usize, usize),
    /// Coverage that it has not reached: name, cases missed, cases in all.
    pub missed: Vec<(&'static str, usize, usize)>,
}

impl BlockReport {
    /// Returns whether nothing is wrong: it passes, or the design need not have it.
    pub fn is_good(&self) -> bool {
        matches!(self.verdict, Verdict::Pass | Verdict::NotRun { .. })
    }

    /// Returns whether the block does not do what it should; one that could not be checked is not said to.
    pub fn failed(&self) -> bool {
        !self.is_good() && !matches!(self.verdict, Verdict::NotChecked { .. })
    }

    /// Returns whether it never came to an end.
    pub fn hangs(&self) -> bool {
        matches!(self.verdict, Verdict::Hangs { .. } | Verdict::TimedOut { .. })
    }

    /// Creates the report on a block that was not run, or could not be checked.
    pub fn without_run(name: &str, verdict: Verdict) -> Self {
        BlockReport {
            name: name.to_owned(),
            cycles: 0,
            verdict,
            around: Vec::new(),
            open: Vec::new(),
            wave: None,
            coverage: (0, 0),
            missed: Vec::new(),
        }
    }

    /// Returns what went wrong, in a line; empty if nothing did.
    pub fn fault(&self) -> String {
        match &self.verdict {
            Verdict::Pass => String::new(),
            Verdict::Differs { first, .. } => format!(
                "cycle {}, {} ps: {} expected {}, got {}",
                first.cycle,
                first.time_ps,
                first.signal,
                short(&first.expected),
                short(&first.got),
            ),
            Verdict::Hangs { seconds, cycle } => format!(
                "hangs after cycle {cycle}: nothing has moved for {seconds} s, something goes round \
                 without a delay",
            ),
            Verdict::NotRun { reason } | Verdict::NotChecked { reason } => reason.clone(),
            Verdict::TimedOut { after } => {
                format!("the bench has not ended after {after} and was killed")
            }
            Verdict::Broke { message } => format!("the bench broke off: {}", message.trim()),
        }
    }

    /// Cycles that differ.
    pub fn mismatches(&self) -> usize {
        match &self.verdict {
            Verdict::Differs { mismatches, .. } => *mismatches,
            _ => 0,
        }
    }

    /// Returns the result in a word or two.
    pub fn word(&self) -> &'static str {
        match self.verdict {
            Verdict::Pass => "pass",
            Verdict::Differs { .. } => "differs",
            Verdict::Hangs { .. } => "hangs",
            Verdict::NotRun { .. } => "not run",
            Verdict::NotChecked { .. } => "not checked",
            Verdict::TimedOut { .. } => "timed out",
            Verdict::Broke { .. } => "broke off",
        }
    }
}

/// A value too long to read, shortened in its middle.
fn short(digits: &str) -> String {
    const LONGEST: usize = 40;
    match (digits.get(..16), digits.len().checked_sub(16).and_then(|end| digits.get(end..))) {
        (Some(head), Some(tail)) if digits.len() > LONGEST => format!("{head}..{tail}"),
        _ => digits.to_owned(),
    }
}
