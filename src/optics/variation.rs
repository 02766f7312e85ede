//! Variation of the laser pulse from shot to shot.

use crate::scenario::Laser;

/// Standard deviations of the laser pulse from shot to shot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variation {
    /// Standard deviation of the time at which the pulse leaves the laser [ps].
    pub timing_ps: f64,
    /// Relative standard deviation of its energy [1].
    pub energy: f64,
}

impl Variation {
    /// Returns the variation of a scenario's laser.
    pub fn of(laser: &Laser) -> Self {
        Variation { timing_ps: laser.timing_jitter_ps, energy: laser.energy_jitter }
    }

    /// Returns whether all shots are equal.
    pub fn is_none(&self) -> bool {
        self.timing_ps == 0.0 && self.energy == 0.0
    }
}
