//! Causes of avalanches, and the cover window's part of the laser light.

use crate::kernel::Time;

/// Cause of an avalanche.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cause {
    /// A laser photon from the scene.
    Signal,
    /// Ambient light.
    Ambient,
    /// A dark count.
    Dark,
    /// A trapped carrier from an earlier avalanche.
    Afterpulse,
    /// A laser photon that the cover window sent back.
    Cover,
}

impl Cause {
    /// Returns its name in results and pictures.
    pub const fn word(self) -> &'static str {
        match self {
            Cause::Signal => "signal",
            Cause::Ambient => "ambient",
            Cause::Dark => "dark",
            Cause::Afterpulse => "afterpulse",
            Cause::Cover => "cover",
        }
    }
}

/// Causes that the light and the dark of a shot have by themselves, in the order of sums by cause.
pub const BY_CAUSE: [Cause; 4] = [Cause::Signal, Cause::Ambient, Cause::Dark, Cause::Cover];

/// Returns the increase of a piecewise linear function from the node before a place to the next; 0 beyond its ends.
pub fn growth(nodes: &[f64], place: f64) -> f64 {
    let node = place as usize;
    match nodes.get(node..node.saturating_add(2)) {
        Some(piece) if place >= 0.0 => piece[1] - piece[0],
        _ => 0.0,
    }
}

/// Returns a piecewise linear function at a place between its nodes; 0 before the first, constant from the last on.
pub fn cumulative(nodes: &[f64], place: f64) -> f64 {
    let Some(last) = nodes.last().filter(|_| place >= 0.0) else { return 0.0 };
    let below = nodes.get(place as usize).unwrap_or(last);
    below + place.fract() * growth(nodes, place)
}

/// Returns the window's part of the rate of a unit of laser light at `t`, as far as it has not arrived at the laser edge;
/// at 0, that with what the pulse would put before [1/fs].
pub fn cover_beside(cover: &[f64], t: Time, place: f64, step: f64) -> f64 {
    let rate = growth(cover, place) / step;
    if t == Time::ZERO { rate + cumulative(cover, place) } else { rate }
}
