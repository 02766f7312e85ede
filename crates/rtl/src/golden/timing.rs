//! When a bench moves the clocks of a block and when it looks.

use tofsim::kernel::Time;

/// Before the edge that ends a part of a cycle, when the outputs are looked at; and after the edge that
/// begins it, when inputs change.
pub const ASIDE: Time = Time::from_fs(1000);

/// One part of a clock cycle: a wait, a look just before its end, and what changes then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BenchStep {
    /// Its length [quarters of a period of clk_sys].
    pub quarters: u64,
    /// True if the outputs are sampled, [`ASIDE`] before its end.
    pub sample: bool,
    /// Clock ports that change at its end, and to what.
    pub edges: &'static [(&'static str, bool)],
    /// An input that changes within the cycle, to the value of another column, [`ASIDE`] its begin.
    pub late: Option<(&'static str, &'static str)>,
}

/// A cycle of the clock that the lines of the vectors count. It ends with the edge that takes the
/// line's input; the first cycle has no edge before that one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// The clock that is counted, or what stands for one.
    pub clock: &'static str,
    /// Parts of the cycle.
    pub steps: &'static [BenchStep],
    /// True if the bench makes the board's oscillator beside it, for a block with a PLL.
    pub oscillator: bool,
}

impl Timing {
    /// Period of the clock, where `cycle` is that of `clk_sys`.
    pub fn period(&self, cycle: Time) -> Time {
        of_quarters(self.steps.iter().map(|step| step.quarters).sum(), cycle)
    }

    /// Samples in a cycle.
    pub fn samples(&self) -> usize {
        self.steps.iter().filter(|step| step.sample).count()
    }

    /// Returns how long before the end of the cycle sample `n` is taken, but for [`ASIDE`], where `cycle` is
    /// the period of `clk_sys`.
    pub fn before_edge(&self, n: usize, cycle: Time) -> Time {
        let places = self.steps.iter().enumerate().filter(|(_, step)| step.sample);
        let after = places.map(|(place, _)| &self.steps[place + 1..]).nth(n);
        let quarters = after.into_iter().flatten().map(|step| step.quarters).sum();
        of_quarters(quarters, cycle)
    }
}

/// Returns a number of quarters of a period of `clk_sys`.
pub fn of_quarters(quarters: u64, cycle: Time) -> Time {
    Time::from_fs(quarters * cycle.fs() / 4)
}

const fn step(quarters: u64, sample: bool, edges: &'static [(&'static str, bool)]) -> BenchStep {
    BenchStep { quarters, sample, edges, late: None }
}

/// A cycle of a clock that the bench makes.
const fn cycle(clock: &'static str, steps: &'static [BenchStep]) -> Timing {
    Timing { clock, steps, oscillator: false }
}

/// One clock, `clk_sys`.
pub const CLK_SYS: Timing =
    cycle("clk_sys", &[step(2, false, &[("clk_sys", false)]), step(2, true, &[("clk_sys", true)])]);

/// Plain cycle of a module that serves any domain.
pub const CLK: Timing =
    cycle("clk", &[step(2, false, &[("clk", false)]), step(2, true, &[("clk", true)])]);

/// One clock twice as fast, looked at in both halves.
pub const CLK_LASER: Timing = cycle(
    "clk_laser",
    &[step(1, true, &[("clk_laser", false)]), step(1, true, &[("clk_laser", true)])],
);

/// Both clocks, looked at in each half of `clk_laser`, whose reset may change after its edge in the middle.
pub const BOTH: Timing = cycle(
    "clk_sys",
    &[
        step(1, true, &[("clk_laser", false)]),
        step(1, true, &[("clk_sys", false), ("clk_laser", true)]),
        BenchStep {
            late: Some(("rst_laser", "rst_laser_late")),
            ..step(1, true, &[("clk_laser", false)])
        },
        step(1, true, &[("clk_sys", true), ("clk_laser", true)]),
    ],
);

/// Both clocks, where the laser's enables may change with the edge of `clk_laser` in the middle.
pub const BOTH_WITH_PULSE: Timing = cycle(
    "clk_sys",
    &[
        step(1, true, &[("clk_laser", false)]),
        step(1, true, &[("clk_sys", false), ("clk_laser", true)]),
        BenchStep {
            late: Some(("laser_pulse", "laser_pulse_late")),
            ..step(1, true, &[("clk_laser", false)])
        },
        step(1, true, &[("clk_sys", true), ("clk_laser", true)]),
    ],
);

/// Cycle whose clocks are made by the block's own PLL.
pub const OWN: Timing = Timing { oscillator: true, ..cycle("clk_sys", &[step(1, true, &[]); 4]) };

/// Cycle with a PLL of its own and a reset that the edge in the middle sees too: it may change after it.
pub const OWN_WITH_RESET: Timing = Timing {
    steps: &[
        step(1, true, &[]),
        step(1, true, &[]),
        BenchStep { late: Some(("rst", "rst_late")), ..step(1, true, &[]) },
        step(1, true, &[]),
    ],
    ..OWN
};

/// No clock: a look once a period of `clk_sys`.
pub const NONE: Timing = cycle("none", &[step(4, true, &[])]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_counted_from_the_begin_of_the_cycle() {
        let cycle = Time::from_fs(8_888_888);
        let before = |timing: &Timing, n| timing.before_edge(n, cycle).fs();
        assert_eq!((BOTH.period(cycle), BOTH.samples()), (cycle, 4));
        assert_eq!(before(&BOTH, 0), 3 * 2_222_222);
        assert_eq!(before(&BOTH, 3), 0);
        assert_eq!((OWN_WITH_RESET.period(cycle), before(&OWN_WITH_RESET, 2)), (cycle, 2_222_222));
        assert_eq!((CLK_SYS.samples(), before(&CLK_SYS, 0)), (1, 0));
        assert_eq!(CLK_LASER.period(cycle).fs(), 4_444_444);
    }
}
