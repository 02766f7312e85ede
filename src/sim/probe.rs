//! Observers of a device's signals and avalanches.

use crate::firmware::tof_top::TofTop;
use crate::kernel::Time;
use crate::optics::hazard::Cause;

/// Sees the signals after every instant at which one may have changed.
pub trait SignalProbe {
    /// Whether the probe observes signals at all.
    const ON: bool;
    /// Whether the probe also observes signals just before each rising edge of `clk_sys` and `clk_laser`.
    const EDGES: bool = false;
    /// The signals as they are from `now` on.
    fn sample(&mut self, now: Time, top: &TofTop);
    /// The outputs of the row of SPADs as they are in the samples to come, a bit each, where the diodes are told apart.
    #[inline(always)]
    fn outputs(&mut self, _outputs: u64) {}
    /// The same where only levels of clocks have changed since the last sample or tick.
    #[inline(always)]
    fn tick(&mut self, now: Time, top: &TofTop) {
        self.sample(now, top);
    }
    /// Returns whether the probe observes signals before this edge.
    #[inline(always)]
    fn looks_before(&self, _edge: Edge) -> bool {
        Self::EDGES
    }
    /// The signals as the edge at `now` takes them: an asynchronous change at that very instant is
    /// not there yet. Without [`SignalProbe::ON`], `clk_in` stands still.
    #[inline(always)]
    fn before_edge(&mut self, _edge: Edge, _now: Time, _top: &TofTop) {}
}

/// A rising edge of `clk_laser`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// `clk_sys` rises too.
    Both,
    /// `clk_sys` falls.
    Middle,
}

/// Hears of every avalanche.
pub trait AvalancheListener {
    /// Whether the probe observes avalanches at all.
    const ON: bool;
    /// An avalanche at `at`, `None` of a known cause.
    fn avalanche(&mut self, at: Time, cause: Option<Cause>);
}

/// Neither looks nor listens.
#[derive(Clone, Copy, Debug)]
pub struct Off;

impl SignalProbe for Off {
    const ON: bool = false;
    fn sample(&mut self, _: Time, _: &TofTop) {}
}

impl AvalancheListener for Off {
    const ON: bool = false;
    fn avalanche(&mut self, _: Time, _: Option<Cause>) {}
}
