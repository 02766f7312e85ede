//! Requests that act on the run.

use std::collections::BTreeMap;
use std::sync::Arc;

use tofsim::error::{Input, Result};
use tofsim::kernel::Time;
use tofsim::scenario::Control;
use tofsim::sim::Live;

use super::Session;
use super::clock::Clock;
use super::instrument::Instrument;
use super::request::{ControlRequest, IlaRequest, RunRequest, changed};
use super::scene;
use super::shot::Keyframe;

/// Width of a `dsp_rst` pulse.
const PULSE: Time = Time::from_ns(1000);
/// Largest number of control changes in the scenario of the run so far.
const MOST_CHANGES: usize = 10_000;
/// Latest time in such a scenario [us].
const LAST_US: f64 = 1e9;

impl Session {
    pub(super) fn run(&mut self, request: &RunRequest) -> Result<()> {
        request.check()?;
        self.interrupt_batch();
        if request.power_up {
            self.power_up()?;
        }
        if let Some(running) = request.running {
            self.stop();
            self.running = running && self.fault.is_none();
        }
        if let Some(frames) = request.frames {
            self.stop();
            self.begin_batch(frames)?;
        }
        Ok(())
    }

    pub(super) fn stop(&mut self) {
        self.running = false;
        self.clock.stop();
    }

    fn power_up(&mut self) -> Result<()> {
        let setup = self.setup_now()?;
        let instrument = Arc::new(Instrument::new(Arc::clone(&setup))?);
        self.live = Live::new(Arc::clone(&setup), self.fidelity.stepping());
        (self.now, self.next, self.origin) = (instrument, None, setup);
        (self.changes, self.exact, self.mixed) = (Vec::new(), true, false);
        (self.frame, self.finished, self.fault) = (None, None, None);
        self.pins = self.live.device().top.pins;
        self.keyframe = Keyframe::new(&self.live);
        self.frame_notes.clear();
        self.causes.clear();
        self.strip.clear();
        self.ila.disarm();
        self.clock = Clock::default();
        Ok(())
    }

    pub(super) fn control(&mut self, request: &ControlRequest) -> Result<()> {
        let change = request.change(self.rates.len())?;
        if change.laser_en.is_some() && self.origin.has_pairs() {
            let expected = "firmware.dark_frames switches the laser from frame to frame";
            return Err(Input::new("control", expected).field("laser_en").into());
        }
        let mut pins = changed(&self.pins(), &change);
        if request.pulse_dsp_rst {
            pins.dsp_rst = false;
        }
        let before = std::mem::replace(&mut self.pins, pins);
        if let Err(error) = self.prepare() {
            self.pins = before;
            return Err(error);
        }
        self.make(change, Time::ZERO);
        if request.pulse_dsp_rst {
            self.make(Control { dsp_rst: Some(false), ..Control::default() }, PULSE);
        }
        Ok(())
    }

    fn make(&mut self, change: Control, after: Time) {
        let change = self.live.control(change, after);
        self.keyframe.change(&change);
        // A shot comes long after Clear.
        self.mixed |= !self.live.is_clearing();
        if self.changes.len() < MOST_CHANGES && change.at_us <= LAST_US {
            self.changes.push(change);
        } else {
            self.exact = false;
        }
    }

    pub(super) fn change_scene(&mut self, asked: BTreeMap<String, f64>) -> Result<()> {
        if let Some(why) = self.scene_fixed() {
            return Err(Input::new("scene", why).into());
        }
        let mut scene = self.scene.clone();
        scene::lay_over(&mut scene, asked)?;
        let before = std::mem::replace(&mut self.scene, scene);
        let is_new = self.live.device().cycle() == 0 && self.changes.is_empty();
        let changed = if is_new && !self.ila.is_armed() { self.power_up() } else { self.prepare() };
        match changed {
            Ok(()) => self.exact &= is_new && !self.ila.is_armed(),
            Err(_) => self.scene = before,
        }
        changed
    }

    /// Applies the present scene and control signals to the next frame.
    fn prepare(&mut self) -> Result<()> {
        let setup = self.setup_now()?;
        let instrument = Arc::new(Instrument::new(Arc::clone(&setup))?);
        if self.live.is_clearing() {
            self.keyframe.change_scene(&setup);
        }
        if self.live.change_scene(setup) {
            self.next = Some(instrument);
        }
        Ok(())
    }

    pub(super) fn arm(&mut self, request: &IlaRequest) -> Result<()> {
        self.ila.disarm();
        if request.arm { self.ila.arm(request, &mut self.live) } else { Ok(()) }
    }
}
