//! The histogram's counts by what set the avalanche off.

use plotters::style::RGBColor;

use tofsim::optics::hazard::Cause;
use tofsim::sim::shot_recorder::Shot;

/// Causes in the order in which they are stacked, with words and colours; `None` is unknown.
pub const CAUSES: [(Option<Cause>, &str, RGBColor); 5] = [
    (Some(Cause::Dark), "dark", RGBColor(80, 80, 80)),
    (Some(Cause::Ambient), "ambient", RGBColor(236, 180, 84)),
    (Some(Cause::Signal), "signal", RGBColor(43, 108, 176)),
    (Some(Cause::Afterpulse), "afterpulse", RGBColor(176, 58, 46)),
    (None, "hits", RGBColor(120, 150, 120)),
];

/// Counts of each bin for each of [`CAUSES`] [hits].
pub type Causes = [Vec<u32>; CAUSES.len()];

/// Counts a shot, if it has a code.
pub fn count(causes: &mut Causes, shot: &Shot) {
    for ((cause, ..), counts) in CAUSES.iter().zip(causes) {
        if let (true, Some(code)) = (*cause == shot.cause, shot.code) {
            counts[code as usize] += 1;
        }
    }
}

/// The word for a cause.
pub fn name(cause: Option<Cause>) -> &'static str {
    CAUSES.iter().find(|(known, ..)| *known == cause).map_or("", |(_, name, _)| name)
}
