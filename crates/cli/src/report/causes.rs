//! The histogram's counts by what set the avalanche off.

use tofsim::firmware::histogram_builder::BINS;
use tofsim::optics::hazard::Cause;
use tofsim::sim::shot_recorder::Shot;

/// Causes in the order in which they are stacked, with their words in plots; `None` is unknown.
pub const CAUSES: [(Option<Cause>, &str); 4] = [
    (Some(Cause::Dark), "dark"),
    (Some(Cause::Ambient), "ambient"),
    (Some(Cause::Signal), "signal"),
    (None, "hits"),
];

/// Counts of each bin for each of [`CAUSES`] [hits].
pub type Causes = [[u32; BINS]; CAUSES.len()];

/// Counts a shot, if it has a code.
pub fn count(causes: &mut Causes, shot: &Shot) {
    for ((cause, _), counts) in CAUSES.iter().zip(causes) {
        if let (true, Some(code)) = (*cause == shot.cause, shot.code) {
            counts[code as usize] += 1;
        }
    }
}

/// The word for a cause.
pub fn name(cause: Option<Cause>) -> &'static str {
    CAUSES.iter().find(|(known, _)| *known == cause).map_or("", |(_, name)| name)
}
