//! Items that were made, and what they come to.

use super::item::{Finding, Item};
use super::verdict::Verdict;

/// An item, and what was found of it.
pub struct Made {
    pub item: &'static Item,
    pub finding: Finding,
    pub verdict: Verdict,
    /// The command that makes it alone.
    pub command: String,
}

impl Made {
    pub fn new(item: &'static Item, finding: Finding, seed: u64, quick: bool) -> Self {
        let quick = if quick { " --quick" } else { "" };
        let command = format!("tofsim reproduce {}{quick} --seed {seed}", item.id);
        Made { item, verdict: finding.verdict(), finding, command }
    }
}

/// How many items have each verdict.
pub fn tally(made: &[Made]) -> [(Verdict, usize); 3] {
    [Verdict::Same, Verdict::Differs, Verdict::CannotBeReproduced]
        .map(|verdict| (verdict, made.iter().filter(|one| one.verdict == verdict).count()))
}
