//! A run that its owner steps edge by edge, reading signals and driving pins in between.

use std::sync::Arc;

use crate::error::{Input, Result};
use crate::firmware::tof_top::TofTop;
use crate::hierarchy::{Entry, Part};
use crate::kernel::Time;
use crate::scenario::{Control, QuenchMode};

use super::clockwork::Clockwork;
use super::cycles::{Cycle, Shown, Values, entries, find};
use super::device::{Device, Edge, Off, SignalProbe};
use super::frames::Frame;
use super::setup::Setup;
use super::stepping::Stepping;
use super::timeline::drive;

/// A run stepped edge by edge. Signals have the values that the last edge took, as a logic analyser sees them.
#[derive(Clone, Debug)]
pub struct SteppedRun {
    setup: Arc<Setup>,
    clockwork: Clockwork,
    entries: Vec<Entry>,
    seen: Seen,
    /// Instants at which `tdc_stop` changed.
    stops: Vec<Time>,
    keeps_stops: bool,
}

/// The signals as the last edge took them.
#[derive(Clone, Debug)]
struct Seen {
    part: Part,
    values: Values,
    begin: Time,
}

impl SignalProbe for Seen {
    const ON: bool = false;
    const EDGES: bool = true;

    fn sample(&mut self, _: Time, _: &TofTop) {}

    fn looks_before(&self, edge: Edge) -> bool {
        edge == Edge::Both
    }

    fn before_edge(&mut self, _: Edge, now: Time, top: &TofTop) {
        self.part.follow(top, &mut self.values);
        self.begin = now;
    }
}

impl SteppedRun {
    /// A run just before its first edge.
    pub fn new(setup: Arc<Setup>) -> Self {
        let mut device = setup.device();
        let stops = power_up(&mut device);
        let entries = entries(&setup.params);
        let mut seen = Seen {
            part: Part::of(entries.iter().map(|entry| entry.id)).of_whole_edges(),
            values: Values::new(setup.params.tdc.delays.taps()),
            begin: Time::ZERO,
        };
        seen.part.show(&device.top, &mut seen.values);
        SteppedRun {
            setup,
            clockwork: Clockwork::new(device, Stepping::EveryCycle),
            entries,
            seen,
            stops,
            keeps_stops: false,
        }
    }

    /// Records from now on when `tdc_stop` changes, for [`SteppedRun::take_stops`]; to be called before the first step.
    pub fn keeping_stops(self) -> Self {
        SteppedRun { keeps_stops: true, ..self }
    }

    /// Returns the instants at which `tdc_stop` changed since the last call, in order, if they are recorded. The first
    /// of all is a rise. A step covers three quarters of a cycle after its edge, and the changes in that time.
    pub fn take_stops(&mut self) -> Option<Vec<Time>> {
        self.keeps_stops.then(|| std::mem::take(&mut self.stops))
    }

    /// Takes an edge of `clk_sys`; returns the frame whose depth it made ready, if it did.
    pub fn step(&mut self) -> Option<Frame> {
        let SteppedRun { setup, clockwork, seen, stops, .. } = self;
        let last = |clockwork: &Clockwork| clockwork.device.transitions.since(Time::ZERO).next();
        let past = last(clockwork).unwrap_or(Time::ZERO);
        clockwork.edge(&setup.params, seen, &mut Off);
        if self.keeps_stops {
            let begin = stops.len();
            stops.extend(clockwork.device.transitions.since(past));
            stops[begin..].reverse();
        }
        clockwork.ready().cloned()
    }

    /// Returns number and instant of the last edge, if there was one.
    pub fn cycle(&self) -> Option<Cycle> {
        let number = self.clockwork.cycle().checked_sub(1)?;
        Some(Cycle { number, begin: self.seen.begin })
    }

    /// Returns every signal.
    pub fn signals(&self) -> &[Entry] {
        &self.entries
    }

    /// Finds a signal by name or path, as [`Run::step_cycles`](crate::Run::step_cycles) does.
    ///
    /// # Errors
    /// When there is no such signal.
    pub fn find(&self, name: &str) -> Result<SignalHandle> {
        find(&self.entries, name).map(|entry| SignalHandle(Shown::new(entry)))
    }

    /// Returns a signal's value as the last edge took it.
    pub fn value(&self, signal: SignalHandle) -> i64 {
        signal.0.value(&self.seen.values)
    }

    /// Drives pins of the acquisition computer from now on, as a `[[control]]` of the scenario does; its time is
    /// ignored.
    pub fn drive(&mut self, control: &Control) {
        drive(control, &mut self.clockwork.device.top.pins);
    }

    /// Returns the change of one pin of the acquisition computer to `value`, for [`SteppedRun::drive`].
    ///
    /// # Errors
    /// When there is no such pin, or it has no such value.
    pub fn pin(&self, name: &str, value: i64) -> Result<Control> {
        let mut control = Control::default();
        let periods = self.setup.params.vcsel_driver.periods.len();
        let fault = |expected: &str| Input::new("pin", expected).field(name).value(value);
        let level = || match value {
            0 | 1 => Ok(Some(value == 1)),
            _ => Err(fault("expected 0 or 1")),
        };
        match name {
            "rst" => control.rst = level()?,
            "laser_en" => control.laser_en = level()?,
            "dsp_en" => control.dsp_en = level()?,
            "dsp_rst" => control.dsp_rst = level()?,
            "mode" if level()? == Some(true) => control.mode = Some(QuenchMode::FreeRunning),
            "mode" => control.mode = Some(QuenchMode::EachShot),
            "laser_freq" => match usize::try_from(value) {
                Ok(place) if place < periods => control.laser_freq = Some(value as _),
                _ => return Err(fault(&format!("expected 0 to {}", periods - 1)).into()),
            },
            _ => {
                let known = "expected one of rst, mode, laser_freq, laser_en, dsp_en, dsp_rst";
                return Err(Input::new("pin", known).value(name).into());
            }
        }
        Ok(control)
    }
}

/// Advances from power-up to just before the first edge; returns when `tdc_stop` changes in that time.
fn power_up(device: &mut Device) -> Vec<Time> {
    let (until, mut changes) = (device.pll.locked_at, Vec::new());
    while device.next_event() <= until {
        let (now, level) = (device.next_event(), device.top.pins.tdc_stop);
        device.settle(now, &mut Off, &mut Off);
        changes.extend((device.top.pins.tdc_stop != level).then_some(now));
    }
    device.power_up(&mut Off, &mut Off);
    changes
}

/// A signal found by its name.
#[derive(Clone, Copy, Debug)]
pub struct SignalHandle(Shown);

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::sim::Run;

    fn setup(set: &[&str]) -> Arc<Setup> {
        Arc::new(Setup::load("kc705", &[&["firmware.shots_per_frame=40"], set].concat()).unwrap())
    }

    #[test]
    fn an_owner_s_steps_show_what_a_run_s_do() {
        let setup = setup(&[]);
        let signals = ["tdc_stop", "tdc.tdc_code", "frame_ctrl.state"];
        let (mut run, mut frames) = (SteppedRun::new(Arc::clone(&setup)), Vec::new());
        let handles = signals.map(|name| run.find(name).unwrap());
        let outcome = Run::new(&setup).step_cycles(3, signals, |cycle, values| {
            frames.extend(run.step());
            assert_eq!(run.cycle(), Some(cycle));
            assert_eq!(handles.map(|signal| run.value(signal)), values, "{}", cycle.number);
            Ok(ControlFlow::Continue(()))
        });
        while frames.len() < 3 {
            frames.extend(run.step());
        }
        outcome.unwrap();
        assert_eq!(frames, Run::new(&setup).frames(3).unwrap());
    }

    /// Keeps when the wire changes, as every sample of a run shows it.
    #[derive(Default)]
    struct Wire {
        level: bool,
        changes: Vec<Time>,
    }

    impl SignalProbe for Wire {
        const ON: bool = true;

        fn sample(&mut self, now: Time, top: &TofTop) {
            if top.pins.tdc_stop != self.level {
                self.level = top.pins.tdc_stop;
                self.changes.push(now);
            }
        }
    }

    #[test]
    fn the_stops_that_are_kept_are_a_run_s() {
        for set in [&[][..], &["firmware.mode=1", "spad.dead_time_ns=30"]] {
            let setup = setup(set);
            let mut run = SteppedRun::new(Arc::clone(&setup));
            assert_eq!(run.take_stops(), None);
            run = run.keeping_stops();
            let (mut device, mut wire) = (setup.device(), Wire::default());
            device.power_up(&mut wire, &mut Off);
            let mut stops = Vec::new();
            for edge in 0..600 {
                run.step();
                device.step(&setup.params, &mut wire, &mut Off);
                if edge % 7 == 0 {
                    stops.extend(run.take_stops().unwrap());
                }
            }
            stops.extend(run.take_stops().unwrap());
            assert!(stops.len() > 60, "{}", stops.len());
            assert_eq!(stops, wire.changes, "{set:?}");
        }
    }

    #[test]
    fn a_pin_that_is_driven_does_what_it_does_at_power_up() {
        let pulses = |drives: &[(&str, i64)]| {
            let mut run = SteppedRun::new(setup(&[]));
            for (name, value) in drives {
                let control = run.pin(name, *value).unwrap();
                run.drive(&control);
            }
            let pulse = run.find("vcsel_driver.laser_pulse").unwrap();
            let mut pulses = 0;
            for _ in 0..600 {
                run.step();
                pulses += run.value(pulse);
            }
            pulses
        };
        assert!(pulses(&[]) > 20, "{}", pulses(&[]));
        assert_eq!(pulses(&[("laser_en", 0)]), 0);
        assert!(pulses(&[("laser_freq", 0)]) < pulses(&[("laser_freq", 3)]));
    }

    #[test]
    fn no_pin_takes_what_it_cannot_be() {
        let run = SteppedRun::new(setup(&[]));
        let said = |name, value| run.pin(name, value).unwrap_err().to_string();
        assert_eq!(said("laser_en", 2), "pin: laser_en = 2: expected 0 or 1");
        assert_eq!(said("laser_freq", 4), "pin: laser_freq = 4: expected 0 to 3");
        let two =
            SteppedRun::new(setup(&["firmware.laser_periods=[25, 13]", "firmware.laser_freq=1"]));
        assert!(two.pin("laser_freq", 1).is_ok());
        let error = two.pin("laser_freq", 2).unwrap_err().to_string();
        assert_eq!(error, "pin: laser_freq = 2: expected 0 to 1");
        assert!(said("laser", 1).contains("expected one of rst, mode"), "{}", said("laser", 1));
    }
}
