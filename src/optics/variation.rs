//! What is not the same in every shot.

/// How shots differ from each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variation {
    /// Standard deviation of the time at which the pulse leaves the laser [ps].
    pub timing_ps: f64,
    /// Standard deviation of its energy, as a part of the mean [1].
    pub energy: f64,
}

impl Variation {
    /// Whether shots are alike.
    pub fn is_none(&self) -> bool {
        self.timing_ps == 0.0 && self.energy == 0.0
    }
}
