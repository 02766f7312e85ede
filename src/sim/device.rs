//! The firmware, the detector and the light, stepped together, one cycle of `clk_sys` at a time.
//!
//! Nothing is searched for inside a cycle: an avalanche or a control change is a time to compare
//! with, and asynchronous events go before the clock edges of the same instant.

use crate::firmware::carry_chain::{Taps, Transitions};
use crate::firmware::pll::Pll;
use crate::firmware::tof_top::{Params, Pins, TofTop};
use crate::kernel::Time;
use crate::note::{Note, NoteCode};
use crate::sensor::front_end::FrontEnd;
use crate::sensor::light::Light;
use crate::sensor::spad::Spads;

use super::disturbance::Disturbance;
use super::jitter::Jitter;
use super::oscillator::Oscillator;
use super::timeline::Timeline;

mod detection;

pub use super::probe::{AvalancheListener, Edge, Off, SignalProbe};

/// The state of a run: firmware, detector, light and clocks.
#[derive(Clone, Debug)]
pub struct Device {
    /// The firmware.
    pub top: TofTop,
    /// Transitions of `tdc_stop`, the wire from the detector.
    pub(super) transitions: Transitions,
    disturbance: Option<Box<Disturbance>>,
    /// The light on the SPADs.
    pub light: Light,
    pub(super) spads: Spads,
    /// The shaper or ring oscillator between the diodes and the wire.
    front_end: FrontEnd,
    pub(super) timeline: Timeline,
    pub(super) pll: Pll,
    pub(super) jitter: Option<Jitter>,
    /// Edges of `clk_sys` so far.
    pub(super) cycle: u64,
    /// Time from a rising edge of `clk_laser` to its fall.
    quarter: Time,
    /// The board's oscillator, advanced only while tracing.
    oscillator: Oscillator,
}

impl Device {
    /// A device at power-up.
    pub fn new(
        (pins, p): (Pins, &Params),
        pll: Pll,
        jitter: Option<Jitter>,
        disturbance: Option<Disturbance>,
        mut light: Light,
        (mut spads, front_end): (Spads, FrontEnd),
        timeline: Timeline,
    ) -> Self {
        spads.arm_all(light.next_avalanche(Time::ZERO, 1.0));
        Device {
            top: TofTop::new(pins, p),
            transitions: Transitions::default(),
            disturbance: disturbance.map(Box::new),
            spads,
            front_end,
            light,
            timeline,
            quarter: pll.clk_laser.fall(0) - pll.clk_laser.rise(0),
            oscillator: Oscillator::new(pll.clk_in.clone()),
            pll,
            jitter,
            cycle: 0,
        }
    }

    /// Returns notes on the inputs that have not come due: control changes and given photons.
    pub fn unused(&self) -> Vec<Note> {
        let left = [
            ("control", self.timeline.left(), "the last of the changes of control"),
            (
                "stimulus.photons",
                self.light.left(),
                "the shots of the last rows of the photon list",
            ),
        ];
        let note = |(key, left, what): (&str, usize, &str)| {
            let text = format!("the run ended before {what}");
            let value = format!("{left} left");
            (left > 0)
                .then(|| Note::new(NoteCode::UnusedInput, key, value.as_str(), "none left", text))
        };
        left.into_iter().filter_map(note).collect()
    }

    /// Returns the number of rising edges of `clk_sys` so far.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// Returns number and instant of the last rising edge of `clk_sys`.
    pub fn last_edge(&mut self) -> (u64, Time) {
        let cycle = self.cycle - 1;
        (cycle, self.rise_laser_at(2 * cycle))
    }

    /// Returns begin and end of the next cycle of `clk_sys`.
    pub fn coming_cycle(&mut self) -> (Time, Time) {
        let end = self.rise_laser_at(2 * self.cycle + 2);
        (self.next_edge(), end)
    }

    /// Returns the instant of the next rising edge of `clk_sys`.
    #[inline(always)]
    pub fn next_edge(&mut self) -> Time {
        self.rise_laser_at(2 * self.cycle)
    }

    /// Advances from power-up to just before the first clock edge.
    pub fn power_up<T: SignalProbe, R: AvalancheListener>(
        &mut self,
        probe: &mut T,
        listener: &mut R,
    ) {
        self.settle(self.pll.locked_at, probe, listener);
        self.top.pll.locked = true;
        if T::ON {
            self.sample(self.pll.locked_at, probe);
        }
    }

    /// Takes one cycle: the edge at which both clocks rise, and the one in its middle.
    #[inline(always)]
    pub fn step<T: SignalProbe, R: AvalancheListener>(
        &mut self,
        p: &Params,
        probe: &mut T,
        listener: &mut R,
    ) {
        let [now, middle] = self.rises_laser();
        self.before_edge(Edge::Both, now, probe, listener);
        self.settle(now, probe, listener);
        let lit = self.top.nets.laser_on;
        let taps = self.sample_taps(p, now);
        self.top.rise(p, taps);
        if self.top.slot.algo_done {
            self.timeline.take_depth(self.pll.clk_sys.rise(self.cycle));
        }
        self.react(now, self.top.nets.laser_on && !lit);
        if T::ON {
            self.clocks(true, true);
            self.sample(now, probe);
        }
        let quarter = self.quarter;
        self.fall_laser(now + quarter, probe, listener);
        self.before_edge(Edge::Middle, middle, probe, listener);
        let unseen = self.settle(middle, probe, listener);
        let before = self.top.registers_laser();
        self.top.rise_laser(p);
        if T::ON {
            self.clocks(false, true);
            if unseen || self.top.registers_laser() != before {
                self.sample(middle, probe);
            } else {
                probe.tick(middle, &self.top);
            }
        }
        self.fall_laser(middle + quarter, probe, listener);
        self.cycle += 1;
    }

    /// Handles what comes before the last fall of `clk_laser` of the step before, as a step with a probe does.
    pub(super) fn finish_step<R: AvalancheListener>(&mut self, listener: &mut R) {
        let middle = self.rise_laser_at(2 * self.cycle - 1);
        self.settle(middle + self.quarter, &mut Off, listener);
    }

    /// Samples the taps of the delay line at the edge at `now`.
    #[inline(always)]
    fn sample_taps(&mut self, p: &Params, now: Time) -> Taps {
        let (level, delays) = (self.top.pins.tdc_stop, &p.tdc.delays);
        match &mut self.disturbance {
            None => self.transitions.sample(level, now, delays),
            Some(disturbance) => disturbance.sample(level, &self.transitions, now, delays),
        }
    }

    /// Updates the levels of the clocks where tracing begins, before the next edge.
    pub fn resume_clocks(&mut self, now: Time) {
        self.top.clocks.clk_in = self.oscillator.seek(now);
        self.clocks(false, false);
    }

    /// Shows `probe` the signals as an edge takes them, after all that happens strictly before it.
    #[inline(always)]
    fn before_edge<T: SignalProbe, R: AvalancheListener>(
        &mut self,
        edge: Edge,
        now: Time,
        probe: &mut T,
        listener: &mut R,
    ) {
        if T::EDGES && probe.looks_before(edge) {
            self.settle(now.since(Time::from_fs(1)), probe, listener);
            self.clocks(edge == Edge::Middle, false);
            probe.before_edge(edge, now, &self.top);
        }
    }

    #[inline(always)]
    fn fall_laser<T: SignalProbe, R: AvalancheListener>(
        &mut self,
        at: Time,
        probe: &mut T,
        listener: &mut R,
    ) {
        let only_clocks = T::ON && !self.settle(at, probe, listener) && !self.top.nets.laser_on;
        self.top.fall_laser();
        if T::ON {
            self.top.clocks.clk_laser = false;
            if only_clocks {
                probe.tick(at, &self.top);
            } else {
                self.sample(at, probe);
            }
        }
    }

    /// Shows the signals, and the outputs of the row.
    #[inline(always)]
    fn sample<T: SignalProbe>(&self, now: Time, probe: &mut T) {
        probe.outputs(self.spads.outputs());
        probe.sample(now, &self.top);
    }

    fn clocks(&mut self, clk_sys: bool, clk_laser: bool) {
        (self.top.clocks.clk_sys, self.top.clocks.clk_laser) = (clk_sys, clk_laser);
    }

    /// Returns the instants of both rising edges of `clk_laser` in the coming cycle of `clk_sys`.
    #[inline(always)]
    fn rises_laser(&mut self) -> [Time; 2] {
        let n = 2 * self.cycle;
        let (clock, [first, second]) = (&self.pll.clk_laser, [n, n + 1]);
        let [now, middle] = [clock.rise(first), clock.rise(second)];
        match &mut self.jitter {
            None => [now, middle],
            Some(jitter) => [jitter.shift(now, first), jitter.shift(middle, second)],
        }
    }

    /// Returns the instant of rising edge `n` of `clk_laser`.
    #[inline(always)]
    fn rise_laser_at(&mut self, n: u64) -> Time {
        let ideal = self.pll.clk_laser.rise(n);
        match &mut self.jitter {
            None => ideal,
            Some(jitter) => jitter.shift(ideal, n),
        }
    }
}
