//! Sampling of a simulation: the values just before each edge of the sampling clock.
//!
//! At the edges of `clk_sys` and `clk_laser` the simulation itself shows these values. For any other clock, and if
//! `clk_in` is a signal, every change of every signal is processed in order of time.

use std::sync::atomic::AtomicBool;

use tofsim::error::Result;
use tofsim::firmware::tof_top::{Params, TofTop};
use tofsim::kernel::Time;
use tofsim::kernel::clock::Clock;
use tofsim::sim::device::{Edge, SignalProbe};
use tofsim::sim::frames::Frames;
use tofsim::sim::setup::Setup;
use tofsim::sim::{Device, Live, Outcome, Progress, Run, WindowedProbe};
use tofsim::{Callback, Shot};

use crate::condition::{Bound, Level};

use super::capture::Capture;
use super::clock::{AnalyserClock, first_edge};
use super::core::Core;
use super::plan::AnalyserPlan;
use super::probe_values::ProbeValues;

pub mod array;

/// A logic analyser in a simulation.
///
/// With input stages, a sample has the values from that many edges earlier, and zero if there was no such edge.
#[derive(Clone, Debug)]
pub struct Analyser {
    plan: AnalyserPlan,
    look: ProbeValues,
    core: Core,
    /// Whether trigger and qualifier are satisfied at the present sample.
    holds: [bool; 2],
    /// Whether an operand changed at the previous sample, so that an edge test may become false.
    operands_changed: bool,
    clock: Clock,
    begun: bool,
    /// Number of the next edge of the sampling clock.
    edge: u64,
    /// Number of the first edge that it samples, without input stages.
    first: u64,
    /// Number of the edge that its first sample represents.
    armed: u64,
}

/// Evaluates a condition; true if there is none.
fn holds(condition: &mut Option<Bound>, look: &ProbeValues) -> bool {
    condition
        .as_mut()
        .is_none_or(|condition| condition.sample(|operand| Level::known(look.operand(operand))))
}

impl Analyser {
    /// Creates an analyser for runs of `setup`.
    pub fn new(plan: &AnalyserPlan, setup: &Setup) -> Self {
        let stride = Capture::new(plan.probes.clone()).stride;
        let encoder = &setup.params.tdc.decoder.encoder;
        let clock = plan.sampling.clock(setup.pll());
        // At power-up itself there is nothing before the edge.
        let armed = first_edge(&clock, plan.arm_at.max(Time::from_fs(1)));
        let mut analyser = Analyser {
            plan: plan.clone(),
            look: ProbeValues::new(&plan.bits, &plan.operands, stride, encoder),
            core: Core::new(plan.shape, stride),
            holds: [true; 2],
            operands_changed: false,
            clock,
            begun: false,
            edge: 0,
            first: armed.saturating_sub(plan.input_stages),
            armed,
        };
        (armed..plan.input_stages).for_each(|_| analyser.take());
        analyser
    }

    /// Returns whether all windows are complete.
    pub fn is_full(&self) -> bool {
        self.core.is_full()
    }

    /// Returns the time of each window's trigger, for a clock without jitter.
    pub fn triggers(&self) -> Vec<Time> {
        let edges = self.core.triggers().iter();
        edges.map(|number| self.clock.rise(self.armed + number)).collect()
    }

    /// Returns the number of samples processed, stored or not.
    pub fn taken(&self) -> u64 {
        self.core.taken()
    }

    /// Returns the stored samples.
    pub fn finish(self) -> Capture {
        self.core.finish(self.plan.probes)
    }

    /// Samples the present values.
    #[inline(always)]
    fn take(&mut self) {
        let changed = self.look.take_operands_changed();
        if changed || self.operands_changed {
            if self.core.looks_for_triggers() {
                self.holds[0] = holds(&mut self.plan.trigger, &self.look);
            }
            self.holds[1] = holds(&mut self.plan.qualifier, &self.look);
        }
        self.operands_changed = changed;
        let [triggers, qualifies] = self.holds;
        self.core.sample(self.look.row(), triggers, qualifies);
    }

    /// Returns whether the analyser samples at this edge of `clk_laser`.
    #[inline]
    fn looks_before(&self, edge: Edge) -> bool {
        edge == Edge::Both || self.plan.sampling != AnalyserClock::System
    }

    /// Processes an edge of `clk_laser`.
    #[inline]
    fn edge(&mut self, edge: Edge, top: &TofTop) {
        if !self.looks_before(edge) {
            return;
        }
        if self.edge >= self.first && !self.is_full() {
            self.look.follow(top);
            self.take();
        }
        self.edge += 1;
    }

    /// Samples the present values at all edges up to `now`.
    fn catch_up(&mut self, now: Time) {
        while self.clock.rise(self.edge) <= now && !self.is_full() {
            self.take();
            self.edge += 1;
        }
    }

    /// Returns the number of the sampling clock's first edge in a cycle of `clk_sys`.
    fn first_of(&self, cycle: u64) -> u64 {
        if self.plan.sampling == AnalyserClock::System { cycle } else { 2 * cycle }
    }

    /// Returns whether the run itself shows the edges of the sampling clock.
    fn is_shown(&self) -> bool {
        matches!(self.plan.sampling, AnalyserClock::System | AnalyserClock::Laser)
    }
}

/// Simulates until `count` frames have ended, or until the analyser is full if it is set to end the run.
///
/// # Errors
/// If the control signals prevent a frame from ending, or the run is stopped.
pub fn capture(
    run: Run,
    count: u64,
    analyser: &mut Analyser,
    stop: Option<&AtomicBool>,
) -> Result<Outcome> {
    if analyser.plan.every_change {
        run.traced(count, &mut Tap::<true>(analyser), stop)
    } else {
        run.traced(count, &mut Tap::<false>(analyser), stop)
    }
}

/// Continues a live run with the analyser, as [`Live::advance`] does. The analyser must be armed at a later time, and
/// must see everything from then on.
///
/// # Errors
/// Any error of `shots`.
pub fn capture_live(
    live: &mut Live,
    cycles: u64,
    analyser: &mut Analyser,
    shots: Option<Callback<Shot>>,
) -> Result<Progress> {
    if analyser.plan.every_change {
        live.advance(cycles, &mut Tap::<true>(analyser), shots)
    } else {
        live.advance(cycles, &mut Tap::<false>(analyser), shots)
    }
}

/// Probe of a run that calls the analyser at every change or only at the edges of `clk_sys` and `clk_laser`.
struct Tap<'a, const EVERY: bool>(&'a mut Analyser);

impl<const EVERY: bool> Tap<'_, EVERY> {
    /// Returns whether the first sample is due within two cycles, in which all clocks have an edge.
    fn is_due(&self, device: &mut Device) -> bool {
        let (begin, end) = device.coming_cycle();
        EVERY && self.0.clock.rise(self.0.first) <= end + (end - begin)
    }

    fn begin(&mut self, device: &mut Device, now: Time) {
        let analyser = &mut *self.0;
        device.resume_clocks(now);
        analyser.look.follow(&device.top);
        analyser.begun = true;
        analyser.edge =
            if analyser.is_shown() { analyser.first_of(device.cycle()) } else { analyser.first };
    }
}

impl<const EVERY: bool> SignalProbe for Tap<'_, EVERY> {
    const ON: bool = EVERY;
    const EDGES: bool = true;

    fn sample(&mut self, now: Time, top: &TofTop) {
        if !EVERY {
            return;
        }
        if !self.0.is_shown() {
            self.0.catch_up(now);
        }
        self.0.look.follow(top);
    }

    #[inline(always)]
    fn looks_before(&self, edge: Edge) -> bool {
        EVERY || self.0.looks_before(edge)
    }

    #[inline(always)]
    fn before_edge(&mut self, edge: Edge, now: Time, top: &TofTop) {
        if !EVERY || self.0.is_shown() {
            self.0.edge(edge, top)
        } else {
            self.sample(now.since(Time::from_fs(1)), top)
        }
    }
}

impl<const EVERY: bool> WindowedProbe for Tap<'_, EVERY> {
    fn begins_at_power_up(&mut self, device: &mut Device) -> bool {
        let due = self.is_due(device);
        if due {
            self.begin(device, Time::ZERO);
        }
        due
    }

    #[inline(always)]
    fn is_wanted(&mut self, device: &mut Device, _: &Frames, _: &Params) -> Result<bool> {
        if !self.0.begun && self.is_due(device) {
            let now = device.coming_cycle().0;
            self.begin(device, now);
        } else if !EVERY && !self.0.begun {
            let analyser = &mut *self.0;
            let cycle = device.cycle();
            analyser.begun = analyser.first_of(cycle + 1) > analyser.first;
            analyser.edge = analyser.first_of(cycle);
        }
        Ok(self.0.begun && !self.0.is_full())
    }

    fn is_done(&self) -> bool {
        self.0.plan.stop_when_full && self.0.is_full()
    }
}
