//! Times of the samples of a capture.

use tofsim::error::{Input, Result};
use tofsim::kernel::Time;

use crate::compare::{SampleClock, SignalMap};

/// Times of the samples of a capture.
#[derive(Clone, Debug)]
pub(super) struct Timebase {
    /// Clock of the analyser.
    pub(super) clock: SampleClock,
    /// Samples per cycle of `clk_sys`.
    pub(super) per_cycle: u64,
    /// Whether every clock edge has a sample.
    pub(super) steady: bool,
    /// Period of `clk_sys`.
    cycle: Time,
}

impl Timebase {
    /// Determines the times from the given clock, or else the map's or `clk_sys`, where `clk_sys` has the period
    /// `cycle` and samples may have been stored conditionally.
    ///
    /// # Errors
    /// If the clock is neither `clk_sys` nor `clk_laser`.
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

    /// Returns the time between two consecutive samples.
    pub(super) fn step(&self) -> Time {
        Time::from_fs(self.cycle.fs() / self.per_cycle)
    }
}
