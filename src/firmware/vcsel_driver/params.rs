//! Verilog parameters of the laser driver: periods and pulse.

use crate::kernel::U;

/// Laser period for each `laser_freq` of the KC705 (Table 6.1) [cycles of clk_sys].
pub const PERIODS: [u64; 4] = [25, 13, 8, 6];
/// Most rates to choose from.
pub const MOST_RATES: usize = 8;
/// Longest pulse [half cycles of clk_laser].
pub const LONGEST_PULSE: u32 = 8;
/// Shortest and longest period: `pre_start` comes two cycles before the laser edge, and the edge before is
/// that of a shot [cycles of clk_sys].
pub const PERIOD_RANGE: std::ops::RangeInclusive<u64> = 4..=65_535;

/// Code of the period in force, with room for all.
pub type Rate = U<3>;

/// Verilog parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Params {
    /// Laser period for each `laser_freq`, one to eight of them; a `laser_freq` past the last has the last
    /// [cycles of clk_sys].
    pub periods: Vec<u64>,
    /// Length of the pulse, one to eight [half cycles of clk_laser].
    pub pulse_half_cycles: u32,
}

impl Default for Params {
    /// The KC705's.
    fn default() -> Self {
        Params { periods: PERIODS.to_vec(), pulse_half_cycles: 1 }
    }
}

impl Params {
    /// The period that a `laser_freq` stands for [cycles of clk_sys].
    #[inline(always)]
    pub fn period(&self, laser_freq: Rate) -> u64 {
        self.periods[laser_freq.index().min(self.periods.len() - 1)]
    }

    /// The period for each value that `laser_freq` can have [cycles of clk_sys].
    pub fn every_period(&self) -> [u64; MOST_RATES] {
        std::array::from_fn(|code| self.period(Rate::new(code as u64)))
    }

    /// The longest period [cycles of clk_sys].
    pub fn longest_period(&self) -> u64 {
        self.periods.iter().copied().max().unwrap_or_default()
    }

    /// Cycles of clk_laser after the first in which the pulse is high at its begin.
    pub(super) fn stretched(&self) -> u32 {
        self.pulse_half_cycles.div_ceil(2) - 1
    }
}
