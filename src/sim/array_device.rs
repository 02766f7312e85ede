//! The firmware of an array, with a detector for each pixel, by the plain step.

use crate::error::Result;
use crate::firmware::carry_chain::Transitions;
use crate::firmware::pll::Pll;
use crate::firmware::tof_top::slot::EstimateWords;
use crate::firmware::tof_top::{Params, TofTop};
use crate::kernel::{Time, U};
use crate::scenario::effects::Method;

use super::device::{Edge, SignalProbe};
use super::oscillator::Oscillator;
use super::photons::{Photons, Shown};
use super::setup::array::ArraySetup;

pub mod trace;

/// A depth of an image, as the firmware outputs it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageDepth {
    /// Row and column of its pixel.
    pub place: [usize; 2],
    /// The estimator's words.
    pub words: EstimateWords,
    /// Number of the edge that raised `algo_done` [cycles of clk_sys].
    pub cycle: u64,
}

/// The state of a run of an array: its firmware and its detectors.
///
/// The outputs of a row reach the firmware a quarter of a cycle after `spad_sel` has changed. Light falls on every
/// pixel all the time; those of other rows are neither reset nor read.
#[derive(Clone, Debug)]
pub struct ArrayDevice {
    /// The firmware.
    pub top: TofTop,
    params: Params,
    pll: Pll,
    /// Detectors by row, then column.
    pixels: Vec<Photons>,
    /// Wires from the selected row.
    wires: Vec<Wire>,
    /// Columns whose wire changes at the coming edge, which comes after that.
    due: Vec<usize>,
    row: usize,
    /// The board's oscillator, advanced for a probe only.
    oscillator: Oscillator,
    /// Edges of `clk_sys` so far.
    cycle: u64,
}

/// The wire from the selected SPAD of a column.
#[derive(Clone, Debug, Default)]
struct Wire {
    level: bool,
    transitions: Transitions,
}

impl ArrayDevice {
    /// A device at power-up, with firmware as [`ArraySetup::firmware`] has it.
    ///
    /// # Errors
    /// When an effect is on that a Verilog bench does not have.
    pub fn new(setup: &ArraySetup, params: &Params) -> Result<Self> {
        let common = setup.common();
        common.require(Method::VerilogBench, "the firmware of an array")?;
        let [rows, columns] = setup.size();
        let places = (0..rows * columns).map(|place| (place / columns, place % columns));
        Ok(ArrayDevice {
            top: TofTop::new(common.pins, params),
            pll: common.pll().clone(),
            oscillator: Oscillator::new(common.pll().clk_in.clone()),
            pixels: places.map(|(row, column)| Photons::new(&setup.pixel(row, column))).collect(),
            wires: vec![Wire::default(); columns],
            due: Vec::new(),
            row: 0,
            cycle: 0,
            params: params.clone(),
        })
    }

    /// Returns the number of rising edges of `clk_sys` so far.
    pub fn cycle(&self) -> u64 {
        self.cycle
    }

    /// Returns begin and end of the coming cycle of `clk_sys`.
    pub fn coming_cycle(&self) -> (Time, Time) {
        (self.pll.clk_sys.rise(self.cycle), self.pll.clk_sys.rise(self.cycle + 1))
    }

    /// Returns the parameters of the firmware.
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// Advances from power-up to just before the first clock edge.
    pub fn power_up<T: SignalProbe>(&mut self, probe: &mut T) {
        let mut changes = self.changes(None);
        changes.sort_by_key(|change| change.0);
        for (at, column) in changes {
            self.change(at, column, probe);
        }
        self.show_oscillator(self.pll.locked_at, probe);
        self.top.pll.locked = true;
        self.sample(self.pll.locked_at, probe);
    }

    /// Takes one cycle of `clk_sys`; returns the depth that its edge makes ready.
    pub fn step<T: SignalProbe>(&mut self, probe: &mut T) -> Option<ImageDepth> {
        let [now, middle, next] =
            [0, 1, 2].map(|half| self.pll.clk_laser.rise(2 * self.cycle + half));
        let quarter = self.pll.clk_laser.fall(0) - self.pll.clk_laser.rise(0);
        let switches = self.rise(now, probe);
        let mut changes = self.changes(switches.then_some(now + quarter));
        changes.sort_by_key(|change| change.0);
        let mut changes = changes.into_iter().peekable();
        for (at, act) in [
            (now + quarter, Some(TofTop::fall_laser as fn(&mut TofTop))),
            (middle, None),
            (middle + quarter, Some(TofTop::fall_laser as fn(&mut TofTop))),
        ] {
            while let Some((when, column)) = changes.next_if(|change| change.0 < at) {
                self.change(when, column, probe);
            }
            if act.is_none() {
                self.before_edge(Edge::Middle, at, probe);
            }
            while let Some((when, column)) = changes.next_if(|change| change.0 == at) {
                self.change(when, column, probe);
            }
            self.show_oscillator(at, probe);
            match act {
                Some(act) => act(&mut self.top),
                None => self.top.rise_laser(&self.params),
            }
            let level = act.is_none();
            (self.top.clocks.clk_sys, self.top.clocks.clk_laser) = (at < middle, level);
            self.sample(at, probe);
        }
        while let Some((when, column)) = changes.next_if(|change| change.0 < next) {
            self.change(when, column, probe);
        }
        debug_assert!(changes.clone().all(|change| change.0 == next));
        self.due.extend(changes.map(|(_, column)| column));
        self.cycle += 1;
        self.top.slot.algo_done.then(|| {
            let ctrl = &self.top.frame_ctrl;
            let place = [ctrl.depth_row, ctrl.depth_column].map(|place| place.index());
            ImageDepth { place, words: self.top.slot.words, cycle: self.cycle - 1 }
        })
    }

    /// Takes the edge at `now` at which both clocks rise; returns whether it selects another row.
    fn rise<T: SignalProbe>(&mut self, now: Time, probe: &mut T) -> bool {
        self.before_edge(Edge::Both, now, probe);
        for column in std::mem::take(&mut self.due) {
            self.change(now, column, probe);
        }
        self.show_oscillator(now, probe);
        let lit = self.top.nets.laser_on;
        let wires = self.wires.iter_mut().enumerate();
        let mut taps = wires.map(|(column, wire)| {
            wire.transitions.sample(wire.level, now, &self.params.tdc_of(column).delays)
        });
        let first = taps.next().unwrap_or_default();
        for (channel, taps) in self.top.channels.iter_mut().zip(taps) {
            channel.sampled = taps;
        }
        self.top.rise(&self.params, first);
        let top = &self.top;
        let shown = Shown {
            start: top.vcsel_driver.registers.start,
            laser: top.nets.laser_on && !lit,
            spad_rst: top.spad_control.spad_rst,
            mode: top.control_sync.mode_sync,
            ring_on: false,
            frame_done: top.frame_ctrl.algo_start && top.frame_ctrl.depth_column == 0,
        };
        let row = top.spad_control.spad_sel.get().trailing_zeros() as usize;
        let switches = row != self.row;
        self.row = row;
        for column in 0..self.wires.len() {
            let pixel = &mut self.selected()[column];
            pixel.edge(now, shown);
            // The edge may have reset the diode.
            let level = pixel.level();
            if !switches && level != self.wires[column].level {
                self.toggle(now, column);
            }
        }
        (self.top.clocks.clk_sys, self.top.clocks.clk_laser) = (true, true);
        self.sample(now, probe);
        switches
    }

    /// Returns the detectors of the selected row.
    fn selected(&mut self) -> &mut [Photons] {
        let columns = self.wires.len();
        &mut self.pixels[self.row * columns..][..columns]
    }

    /// Returns the changes of the wires up to and at the next edge, by column; those of a row that has been selected
    /// show from `switch` on.
    fn changes(&mut self, switch: Option<Time>) -> Vec<(Time, usize)> {
        let mut changes = Vec::new();
        for column in 0..self.wires.len() {
            let before = self.wires[column].level;
            let pixel = &mut self.selected()[column];
            let mut level = pixel.level();
            let mut own: Vec<_> = std::iter::from_fn(|| pixel.next_change()).collect();
            if let Some(switch) = switch {
                let hidden = own.partition_point(|at| *at <= switch);
                level ^= hidden % 2 == 1;
                own.drain(..hidden);
                changes.extend((level != before).then_some((switch, column)));
            }
            changes.extend(own.into_iter().map(|at| (at, column)));
        }
        changes
    }

    /// Shows the signals as the edge at `now` takes them, after all that happens strictly before it.
    fn before_edge<T: SignalProbe>(&mut self, edge: Edge, now: Time, probe: &mut T) {
        if T::EDGES && probe.looks_before(edge) {
            self.show_oscillator(now.since(Time::from_fs(1)), probe);
            probe.before_edge(edge, now, &self.top);
        }
    }

    /// Changes the level of a wire, and shows it.
    fn change<T: SignalProbe>(&mut self, now: Time, column: usize, probe: &mut T) {
        self.show_oscillator(now, probe);
        self.toggle(now, column);
        self.sample(now, probe);
    }

    fn toggle(&mut self, now: Time, column: usize) {
        let wire = &mut self.wires[column];
        wire.level = !wire.level;
        wire.transitions.push(now);
        let pins = &mut self.top.pins;
        match column.checked_sub(1) {
            None => pins.tdc_stop = wire.level,
            Some(bit) => pins.column_stop = U::new(pins.column_stop.get() ^ 1 << bit),
        }
    }

    /// Shows the edges of `clk_in` up to `now`, before anything else changes then.
    fn show_oscillator<T: SignalProbe>(&mut self, now: Time, probe: &mut T) {
        while T::ON && self.oscillator.next_edge() <= now {
            let at = self.oscillator.next_edge();
            self.top.clocks.clk_in = self.oscillator.edge();
            probe.sample(at, &self.top);
        }
    }

    fn sample<T: SignalProbe>(&self, now: Time, probe: &mut T) {
        if T::ON {
            probe.sample(now, &self.top);
        }
    }
}

#[cfg(test)]
mod tests;
