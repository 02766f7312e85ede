//! State of the session, as sent to browsers.

use std::sync::Arc;

use tofsim::error::Result;
use tofsim::firmware::frame_ctrl::State;
use tofsim::firmware::tof_top::Pins;
use tofsim::optics::budget::LIGHT_M_S;
use tofsim::sim::estimates::digits;
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;

use super::Session;
use super::scene;
use super::view::{
    BinsView, ControlView, FrameView, PhaseView, ProgressView, SCHEMA, TimeView, View,
};

impl Session {
    /// Returns the state as JSON, with an increased version.
    pub(super) fn show(&mut self) -> Arc<str> {
        self.version += 1;
        self.pins = self.pins();
        let now = self.live.now();
        let instrument = Arc::clone(self.next.as_ref().unwrap_or(&self.now));
        let setup = &instrument.setup;
        let period = setup.params.vcsel_driver.period(self.pins.laser_freq);
        let cycle_s = setup.cycle().seconds();
        let notes = instrument.notes.iter().map(ToString::to_string);
        let bin_s = setup.scenario.tdc.bin_ps * 1e-12;
        let view = View {
            schema: SCHEMA,
            version: self.version,
            scenario: &self.origin.name,
            seed: self.origin.scenario.seed,
            fidelity: self.fidelity.name(),
            board: None,
            hash: &setup.hash(),
            running: self.running,
            fault: self.fault.as_deref(),
            held: self.held(),
            control: ControlView::of(&self.pins),
            rates: &self.rates,
            laser_fixed: self
                .origin
                .has_pairs()
                .then_some("firmware.dark_frames switches the laser from frame to frame"),
            scene: scene::sliders(setup, &setup.scenario),
            scene_coming: scene::differ(setup, &self.now.setup),
            scene_fixed: self.scene_fixed(),
            frame: self.frame.as_ref(),
            progress: self.progress(setup),
            strip: self.strip.points(),
            notes: notes.chain(self.frame_notes.iter().cloned()).collect(),
            time: TimeView {
                board_s: now.seconds(),
                here_s: self.clock.busy.as_secs_f64(),
                board_frames_per_s: 1.0 / (setup.frame_cycles(period) as f64 * cycle_s),
                frames_per_s: self.clock.frames_per_second(),
                frames: self.live.done(),
                shots: self.live.shots(),
            },
            bins: BinsView {
                count: setup.params.histogram.bins,
                bin_m: bin_s * LIGHT_M_S / 2.0,
                first_m: setup.scenario.tdc.first_bin_ps * 1e-12 * LIGHT_M_S / 2.0,
            },
            ila: self.ila.view(),
            set_ups: &self.set_ups,
            exact: self.exact,
        };
        serde_json::to_string(&view).unwrap_or_default().into()
    }

    fn progress(&self, setup: &Setup) -> ProgressView {
        ProgressView {
            frame: self.live.done(),
            phase: match self.live.device().top.frame_ctrl.state() {
                State::Clear => "Clear",
                State::Acquire => "Acquire",
                State::Drain => "Drain",
                State::Estimate => "Estimate",
            },
            shots: self.live.shots_of_frame(),
            of: setup.shots(1),
            abandoned: self.live.abandoned(),
        }
    }

    /// Returns the control signals, which the scenario may change too.
    pub(super) fn pins(&self) -> Pins {
        if self.live.is_changing() { self.pins } else { self.live.device().top.pins }
    }

    /// Returns the reason why the control signals prevent a frame from ending, if they do.
    pub(super) fn held(&self) -> Option<&'static str> {
        let top = &self.live.device().top;
        if self.pins.rst {
            Some("rst is high")
        } else if self.pins.dsp_rst {
            Some("dsp_rst is high: Clear begins again and again")
        } else if !self.pins.dsp_en && top.frame_ctrl.state() == State::Drain {
            Some("dsp_en is low: the histogram waits for the estimator")
        } else {
            None
        }
    }

    pub(super) fn scene_fixed(&self) -> Option<&'static str> {
        let can_change = self.live.device().light.can_change();
        (!can_change).then_some("the scenario's stimulus replaces the photon source")
    }

    /// Returns the setup with the present scene and control signals.
    pub(super) fn setup_now(&self) -> Result<Arc<Setup>> {
        let (base, pins) = (&self.base.scenario.firmware, &self.pins);
        let mut further = scene::overrides(&self.scene);
        let mut switch = |key: &str, value: u64, base: u64, is_flag: bool| {
            if value == base {
                return;
            }
            let value = if is_flag { (value == 1).to_string() } else { value.to_string() };
            further.push(format!("firmware.{key}={value}"));
        };
        switch("laser_freq", pins.laser_freq.get(), base.laser_freq, false);
        switch("mode", pins.mode.into(), base.mode.into(), false);
        if !base.dark_frames {
            switch("laser_en", pins.laser_en.into(), base.laser_en.into(), true);
        }
        switch("dsp_en", pins.dsp_en.into(), base.dsp_en.into(), true);
        switch("dsp_rst", pins.dsp_rst.into(), base.dsp_rst.into(), true);
        Ok(Arc::new(Setup::new(self.options.reload(&self.base, &further)?)?))
    }
}

impl ControlView {
    pub(super) fn of(pins: &Pins) -> Self {
        ControlView {
            laser_freq: pins.laser_freq.get(),
            mode: pins.mode.into(),
            laser_en: pins.laser_en,
            dsp_en: pins.dsp_en,
            dsp_rst: pins.dsp_rst,
        }
    }
}

impl FrameView {
    /// Extracts the information of a frame.
    pub(super) fn of(frame: &Frame, setup: &Setup, mixed: bool) -> Self {
        let clear = setup.params.histogram.bins as u64;
        let (drain, estimate) = (setup.params.frame_ctrl.drain_cycles, frame.estimator_cycles);
        let acquire = frame.frame_cycles.saturating_sub(clear + drain + estimate);
        let phase = |name, cycles| PhaseView { name, cycles };
        FrameView {
            index: frame.index,
            laser_en: frame.laser_en,
            mixed,
            shots: frame.shots,
            tdc_hits: frame.tdc_hits,
            hits: frame.hits(),
            layers: Vec::new(),
            causes_seen: false,
            depths: Vec::new(),
            depth_raw: digits(frame.depth()),
            true_m: None,
            bound_two_sd_mm: None,
            phases: [
                phase("Clear", clear),
                phase("Acquire", acquire),
                phase("Drain", drain),
                phase("Estimate", estimate),
            ],
            frame_cycles: frame.frame_cycles,
            board_us: frame.frame_cycles as f64 * setup.cycle().seconds() * 1e6,
        }
    }
}
