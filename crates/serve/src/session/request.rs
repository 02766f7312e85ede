//! What a browser may ask for.

use std::collections::BTreeMap;

use serde::Deserialize;

use tofsim::WaveFormat;
use tofsim::error::{Input, Result};
use tofsim::firmware::tof_top::Pins;
use tofsim::kernel::U;
use tofsim::scenario::{Control, QuenchMode};
use tofsim_captures::ila::export::CaptureFormat;

/// Frames that one request may ask for.
const MOST_FRAMES: u32 = 1000;

/// One request.
#[derive(Clone, Debug)]
pub enum Request {
    /// Start, stop, go on for some frames, or power up again.
    Run(RunRequest),
    /// Change signals of the acquisition computer.
    Control(ControlRequest),
    /// Change the scene.
    Scene(BTreeMap<String, f64>),
    /// Arm the logic analyser, or let it be.
    Ila(IlaRequest),
    /// A file of the capture.
    IlaFile(CaptureFormat),
    /// The waveform of a shot of the last frame.
    Shot {
        /// Its number in the frame, or else the last one.
        shot: Option<u64>,
        /// Of the file.
        format: WaveFormat,
        /// Globs of the signals; none asks for all.
        signals: Vec<String>,
    },
    /// The run so far as a scenario.
    Scenario,
    /// The state alone.
    State,
}

/// Start, stop, go on for some frames, or power up again.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RunRequest {
    /// Whether it runs.
    pub running: Option<bool>,
    /// Frames to go on for, stopped.
    pub frames: Option<u32>,
    /// Begins again at power-up, with switches and scene as they are.
    pub power_up: bool,
}

impl RunRequest {
    /// # Errors
    /// When it asks for nothing, or for too many frames.
    pub fn check(&self) -> Result<()> {
        if self.running.is_none() && self.frames.is_none() && !self.power_up {
            let expected = "expected running, frames or power_up";
            return Err(Input::new("run", expected).into());
        }
        match self.frames {
            Some(frames) if !(1..=MOST_FRAMES).contains(&frames) => {
                let expected = format!("expected 1 to {MOST_FRAMES}");
                Err(Input::new("run", expected).field("frames").value(frames).into())
            }
            _ => Ok(()),
        }
    }
}

/// Signals of the acquisition computer.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ControlRequest {
    /// Which of the laser's periods.
    pub laser_freq: Option<u64>,
    /// SPAD quench mode, 0 or 1.
    pub mode: Option<u64>,
    /// Lets the laser fire.
    pub laser_en: Option<bool>,
    /// Lets the estimator start.
    pub dsp_en: Option<bool>,
    /// Abandons the frame.
    pub dsp_rst: Option<bool>,
    /// `dsp_rst` high for a microsecond.
    pub pulse_dsp_rst: bool,
}

impl ControlRequest {
    /// The change, for a laser with so many periods.
    ///
    /// # Errors
    /// When a code is none, or nothing changes.
    pub fn change(&self, periods: usize) -> Result<Control> {
        let fault = |field: &str, value: u64, expected: String| {
            Err(Input::new("control", expected).field(field).value(value).into())
        };
        match (self.laser_freq, self.mode) {
            (Some(code), _) if code >= periods as u64 => {
                return fault("laser_freq", code, format!("expected 0 to {}", periods - 1));
            }
            (_, Some(mode)) if mode > 1 => return fault("mode", mode, "expected 0 or 1".into()),
            _ => {}
        }
        let mode = self.mode.map(|mode| match mode {
            0 => QuenchMode::EachShot,
            _ => QuenchMode::FreeRunning,
        });
        let change = Control {
            at_us: 0.0,
            laser_freq: self.laser_freq,
            mode,
            laser_en: self.laser_en,
            dsp_en: self.dsp_en,
            dsp_rst: if self.pulse_dsp_rst { Some(true) } else { self.dsp_rst },
            rst: None,
        };
        if change == Control::default() {
            let expected = "expected laser_freq, mode, laser_en, dsp_en, dsp_rst or pulse_dsp_rst";
            return Err(Input::new("control", expected).into());
        }
        Ok(change)
    }
}

/// The pins after a change.
pub fn changed(pins: &Pins, change: &Control) -> Pins {
    Pins {
        laser_freq: change.laser_freq.map_or(pins.laser_freq, U::new),
        mode: change.mode.map_or(pins.mode, |mode| mode == QuenchMode::FreeRunning),
        laser_en: change.laser_en.unwrap_or(pins.laser_en),
        dsp_en: change.dsp_en.unwrap_or(pins.dsp_en),
        dsp_rst: change.dsp_rst.unwrap_or(pins.dsp_rst),
        ..*pins
    }
}

/// What the logic analyser is to do.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct IlaRequest {
    /// Whether to arm it; false lets it be.
    pub arm: bool,
    /// Name of a built-in set-up.
    pub set_up: Option<String>,
    /// A set-up file of one's own, instead.
    pub text: Option<String>,
    /// In place of the set-up's key.
    pub clock: Option<String>,
    /// In place of the set-up's key.
    pub depth: Option<u64>,
    /// In place of the set-up's key.
    pub windows: Option<u64>,
    /// In place of the set-up's key.
    pub position: Option<u64>,
    /// In place of the set-up's key.
    pub trigger: Option<String>,
    /// In place of the set-up's key.
    pub capture: Option<String>,
}
