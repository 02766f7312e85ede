//! When a bench moves the clocks of a block and when it looks.

/// One part of a clock cycle: a wait, a look just before its end, and what changes then.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Its length [ps].
    pub length_ps: u64,
    /// Whether the outputs are looked at 1 ps before its end.
    pub sample: bool,
    /// Clock ports that change at its end, and to what.
    pub edges: &'static [(&'static str, bool)],
    /// An input that changes within the cycle, to the value of another column, at its end.
    pub late: Option<(&'static str, &'static str)>,
}

/// A cycle of the clock that the lines of the vectors count. It ends with the edge that takes the
/// line's input; the first cycle has no edge before that one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// The clock that is counted, or what stands for one.
    pub clock: &'static str,
    /// Parts of the cycle.
    pub steps: &'static [Step],
    /// Whether the bench makes a 200 MHz clock beside it, for a block with a PLL.
    pub oscillator: bool,
}

impl Timing {
    /// Period of the clock [ps].
    pub const fn period_ps(&self) -> u64 {
        let (mut sum, mut k) = (0, 0);
        while k < self.steps.len() {
            sum += self.steps[k].length_ps;
            k += 1;
        }
        sum
    }

    /// Samples in a cycle.
    pub fn samples(&self) -> usize {
        self.steps.iter().filter(|step| step.sample).count()
    }

    /// How long before the end of the cycle sample `n` is taken, but for the 1 ps [ps].
    pub fn before_edge_ps(&self, n: usize) -> u64 {
        let mut ends = self.steps.iter().scan(0, |end, step| {
            *end += step.length_ps;
            Some((*end, step.sample))
        });
        let end = ends.by_ref().filter(|(_, sample)| *sample).nth(n).map_or(0, |(end, _)| end);
        self.period_ps() - end
    }
}

const fn step(length_ps: u64, sample: bool, edges: &'static [(&'static str, bool)]) -> Step {
    Step { length_ps, sample, edges, late: None }
}

/// A cycle of a clock that the bench makes.
const fn cycle(clock: &'static str, steps: &'static [Step]) -> Timing {
    Timing { clock, steps, oscillator: false }
}

/// One clock of 125 MHz.
pub const CLK_SYS: Timing = cycle(
    "clk_sys",
    &[step(4000, false, &[("clk_sys", false)]), step(4000, true, &[("clk_sys", true)])],
);

/// One clock of 125 MHz in a module that serves any domain.
pub const CLK: Timing =
    cycle("clk", &[step(4000, false, &[("clk", false)]), step(4000, true, &[("clk", true)])]);

/// One clock of 250 MHz, looked at in both halves.
pub const CLK_LASER: Timing = cycle(
    "clk_laser",
    &[step(2000, true, &[("clk_laser", false)]), step(2000, true, &[("clk_laser", true)])],
);

/// Both clocks, looked at in each half of `clk_laser`.
pub const BOTH: Timing = cycle(
    "clk_sys",
    &[
        step(2000, true, &[("clk_laser", false)]),
        step(2000, true, &[("clk_sys", false), ("clk_laser", true)]),
        step(2000, true, &[("clk_laser", false)]),
        step(2000, true, &[("clk_sys", true), ("clk_laser", true)]),
    ],
);

/// The same cycle, with the clocks made by the block's own PLL.
pub const OWN: Timing =
    Timing { oscillator: true, ..cycle("clk_sys", &[step(2000, true, &[]); 4]) };

/// The same with a reset that the edge in the middle of the cycle sees too: it may change after it.
pub const OWN_WITH_RESET: Timing = Timing {
    steps: &[
        step(2000, true, &[]),
        step(2000, true, &[]),
        Step { late: Some(("rst", "rst_late")), ..step(1, false, &[]) },
        step(1999, true, &[]),
        step(2000, true, &[]),
    ],
    ..OWN
};

/// No clock: a look every 8 ns.
pub const NONE: Timing = cycle("none", &[step(8000, true, &[])]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_counted_from_the_begin_of_the_cycle() {
        assert_eq!((BOTH.period_ps(), BOTH.samples()), (8000, 4));
        assert_eq!(BOTH.before_edge_ps(0), 6000);
        assert_eq!(BOTH.before_edge_ps(3), 0);
        assert_eq!((OWN_WITH_RESET.period_ps(), OWN_WITH_RESET.before_edge_ps(2)), (8000, 2000));
        assert_eq!((CLK_SYS.samples(), CLK_SYS.before_edge_ps(0)), (1, 0));
    }
}
