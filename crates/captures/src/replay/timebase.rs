//! When the samples of a capture are.

use tofsim::error::{Input, Result};
use tofsim::kernel::Time;

use crate::compare::{SampleClock, SignalMap};

/// When the samples of a capture are.
#[derive(Clone, Debug)]
pub(super) struct Timebase {
    /// The analyser's clock.
    pub(super) clock: SampleClock,
    /// Samples in a cycle of `clk_sys`.
    pub(super) per_cycle: u64,
    /// Whether every edge of the clock has a sample.
    pub(super) steady: bool,
    /// Period of `clk_sys`.
    cycle: Time,
}

impl Timebase {
    /// Of a clock or else the map's or `clk_sys`, whether or not all samples were stored, where `clk_sys` has
    /// the period `cycle`.
    ///
    /// # Errors
    /// When it is neither `clk_sys` nor `clk_laser`.
    pub(super) fn new(
        clock: Option<&SampleClock>,
        map: &SignalMap,
        qualified: bool,
        cycle: Time,
    ) -> Result<Self> {
        let text = map.clock.as_deref().unwrap_or("clk_sys");
        let fault = |expected: String| Input::new("clock", expected).value(text);
        let clock = clock.map_or_else(|| text.parse().map_err(fault), |clock| Ok(clock.clone()))?;
        let is_called = |name: &str| match &clock {
            SampleClock::Signal(signal) => signal.ends_with(name),
            SampleClock::Free { .. } => false,
        };
        let per_cycle = if is_called("clk_sys") {
            1
        } else if is_called("clk_laser") {
            2
        } else {
            let expected =
                "expected clk_sys or clk_laser for a replay: others do not see each cycle";
            return Err(Input::new("--clock", expected).value(format!("{clock:?}")).into());
        };
        let steady = !qualified && map.qualified_by.is_none();
        if !steady && per_cycle != 1 {
            let expected = "expected clk_sys where not all samples were stored";
            return Err(Input::new("--clock", expected).into());
        }
        Ok(Timebase { clock, per_cycle, steady, cycle })
    }

    /// Time between two samples of a steady capture.
    pub(super) fn step(&self) -> Time {
        Time::from_fs(self.cycle.fs() / self.per_cycle)
    }
}
