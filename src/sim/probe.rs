//! Observers of a device's signals and avalanches.

use crate::firmware::tof_top::TofTop;
use crate::kernel::Time;
use crate::optics::hazard::Cause;

/// An observer of signals, called after every instant at which one may have changed.
pub trait SignalProbe {
    /// Whether the probe observes signals at all.
    const ON: bool;
    /// Whether the probe also observes signals just before each rising edge of `clk_sys` and `clk_laser`.
    const EDGES: bool = false;
    /// Receives the signals as they are from `now` on.
    fn sample(&mut self, now: Time, top: &TofTop);
    /// Receives the outputs of the row of SPADs for the next samples, a bit each, where diodes are simulated one by
    /// one.
    #[inline(always)]
    fn outputs(&mut self, _outputs: u64) {}
    /// Receives the signals where only levels of clocks have changed since the last sample or tick.
    #[inline(always)]
    fn tick(&mut self, now: Time, top: &TofTop) {
        self.sample(now, top);
    }
    /// Returns whether the probe observes signals before this edge.
    #[inline(always)]
    fn looks_before(&self, _edge: Edge) -> bool {
        Self::EDGES
    }
    /// Receives the signals as the edge at `now` takes them, before asynchronous changes at that instant. Without
    /// [`SignalProbe::ON`], `clk_in` does not move.
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

/// An observer of avalanches.
pub trait AvalancheListener {
    /// Whether the probe observes avalanches at all.
    const ON: bool;
    /// Receives an avalanche at `at`, with its cause if that is known.
    fn avalanche(&mut self, at: Time, cause: Option<Cause>);
}

/// An observer of nothing.
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
