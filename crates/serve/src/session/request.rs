//! Requests of a browser.

use std::collections::BTreeMap;

use serde::Deserialize;

use tofsim::WaveFormat;
use tofsim::error::{Error, Input, Result};
use tofsim::firmware::tof_top::Pins;
use tofsim::kernel::U;
use tofsim::scenario::{Control, QuenchMode};
use tofsim_captures::ila::export::CaptureFormat;

/// Largest number of frames in one request.
const MOST_FRAMES: u32 = 1000;

/// A request of a browser.
#[derive(Clone, Debug)]
pub enum Request {
    /// Start, stop, run a number of frames, or restart at power-up.
    Run(RunRequest),
    /// Change control signals.
    Control(ControlRequest),
    /// Change the scene.
    Scene(BTreeMap<String, f64>),
    /// Arm or disarm the logic analyser.
    Ila(IlaRequest),
    /// Return a file of the capture.
    IlaFile(CaptureFormat),
    /// Return the waveform of a shot of the last frame.
    Shot {
        /// Number of the shot in the frame; the last shot by default.
        shot: Option<u64>,
        /// Format of the file.
        format: WaveFormat,
        /// Globs of the signals; all signals if empty.
        signals: Vec<String>,
    },
    /// Return the run so far as a scenario.
    Scenario,
    /// Return the last image with its pixels.
    Image,
    /// Return the state.
    State,
}

/// Request to start, stop, run a number of frames, or restart at power-up.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RunRequest {
    /// Whether to run.
    pub running: Option<bool>,
    /// Number of frames to run, after which the run stops.
    pub frames: Option<u32>,
    /// Whether to restart at power-up, with the present control signals and scene.
    pub power_up: bool,
}

impl RunRequest {
    /// Checks the request.
    ///
    /// # Errors
    /// If it requests nothing, or too many frames.
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

/// Request to change control signals.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ControlRequest {
    /// Laser repetition rate: index of the laser period.
    pub laser_freq: Option<u64>,
    /// SPAD quench mode, 0 or 1.
    pub mode: Option<u64>,
    /// Enable the laser.
    pub laser_en: Option<bool>,
    /// Enable the estimator.
    pub dsp_en: Option<bool>,
    /// Abandon the frame.
    pub dsp_rst: Option<bool>,
    /// Pulse `dsp_rst` for one microsecond.
    pub pulse_dsp_rst: bool,
}

impl ControlRequest {
    /// Converts the request to a change, for a laser with `periods` periods.
    ///
    /// # Errors
    /// If a code is out of range, or nothing changes.
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

/// Returns the pins after a change.
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

/// Returns the error that a single pixel has no image.
pub fn no_image() -> Error {
    let expected = "expected a scenario with several pixels (array.rows, array.columns)";
    Input::new("image", expected).into()
}

/// Request to the logic analyser.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct IlaRequest {
    /// Whether to arm it; false disarms it.
    pub arm: bool,
    /// Name of a built-in probe configuration.
    pub set_up: Option<String>,
    /// Text of a custom probe configuration, instead of a built-in one.
    pub text: Option<String>,
    /// Override of the key `clock`.
    pub clock: Option<String>,
    /// Override of the key `depth`.
    pub depth: Option<u64>,
    /// Override of the key `windows`.
    pub windows: Option<u64>,
    /// Override of the key `position`.
    pub position: Option<u64>,
    /// Override of the key `trigger`.
    pub trigger: Option<String>,
    /// Override of the key `capture`.
    pub capture: Option<String>,
}
