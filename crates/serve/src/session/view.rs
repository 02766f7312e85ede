//! JSON objects for browsers.

use serde::Serialize;

use super::analyser::{IlaView, SetUpView};
use super::causes::Layer;
use super::instrument::Depth;
use super::scene::Slider;
use super::strip::StripPoint;

/// Schema version of the object.
pub const SCHEMA: &str = "tofsim.page/1";

/// Complete state.
#[derive(Clone, Debug, Serialize)]
pub struct View<'a> {
    /// Schema version, [`SCHEMA`].
    pub schema: &'static str,
    /// Number of the state, which increases.
    pub version: u64,
    /// Name of the scenario.
    pub scenario: &'a str,
    /// Seed of all random streams.
    pub seed: u64,
    /// Simulation fidelity.
    pub fidelity: &'static str,
    /// Port of the board whose frames are shown, if they are not simulated.
    pub board: Option<&'a str>,
    /// Hash of the present scenario.
    pub hash: &'a str,
    /// Whether the run is running.
    pub running: bool,
    /// Error that stopped the run.
    pub fault: Option<&'a str>,
    /// Reason why no frame ends.
    pub held: Option<&'static str>,
    /// Control signals.
    pub control: ControlView,
    /// Laser repetition rates, by code.
    pub rates: &'a [RateView],
    /// Reason why the laser cannot be switched.
    pub laser_fixed: Option<&'static str>,
    /// Sliders of the scene.
    pub scene: Vec<Slider>,
    /// Whether the scene has changed, and no frame of the new scene has ended yet.
    pub scene_coming: bool,
    /// Reason why the scene cannot be changed.
    pub scene_fixed: Option<&'static str>,
    /// Last complete frame.
    pub frame: Option<&'a FrameView>,
    /// Progress of the present frame.
    pub progress: ProgressView,
    /// Depths of the last frames.
    pub strip: &'a std::collections::VecDeque<StripPoint>,
    /// Notes on the results.
    pub notes: Vec<String>,
    /// Simulation speed.
    pub time: TimeView,
    /// Bins of the histogram.
    pub bins: BinsView,
    /// State of the logic analyser.
    pub ila: IlaView,
    /// Built-in probe configurations.
    pub set_ups: &'a [SetUpView],
    /// Whether the run's scenario contains everything that was done to the run.
    pub exact: bool,
}

/// Control signals.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ControlView {
    /// Laser repetition rate: index of the laser period.
    pub laser_freq: u64,
    /// SPAD quench mode.
    pub mode: u64,
    /// Laser enable.
    pub laser_en: bool,
    /// Estimator enable.
    pub dsp_en: bool,
    /// Frame reset.
    pub dsp_rst: bool,
}

/// A laser repetition rate.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RateView {
    /// Period [cycles of clk_sys].
    pub cycles: u64,
    /// Rate [MHz].
    pub mhz: f64,
}

/// A complete frame.
#[derive(Clone, Debug, Serialize)]
pub struct FrameView {
    /// Number of the frame, from 0.
    pub index: u64,
    /// Whether the laser was enabled at the end of the frame.
    pub laser_en: bool,
    /// Whether a control signal changed during the frame.
    pub mixed: bool,
    /// Number of shots.
    pub shots: u64,
    /// Number of hits that the TDC registered.
    pub tdc_hits: u64,
    /// Number of hits in the histogram.
    pub hits: u64,
    /// Histogram by cause, lowest layer first.
    pub layers: Vec<Layer>,
    /// Whether causes were observed rather than expected.
    pub causes_seen: bool,
    /// Depth of each estimator.
    pub depths: Vec<Depth>,
    /// Depth word in hexadecimal.
    pub depth_raw: String,
    /// Distance of the target, if a depth can be the target's [m].
    pub true_m: Option<f64>,
    /// Cramer-Rao bound, two standard deviations [mm].
    pub bound_two_sd_mm: Option<f64>,
    /// Phases of the frame [cycles of clk_sys].
    pub phases: [PhaseView; 4],
    /// Length [cycles of clk_sys].
    pub frame_cycles: u64,
    /// Duration on the board [us].
    pub board_us: f64,
}

/// A phase of a frame.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PhaseView {
    /// State of `frame_ctrl`.
    pub name: &'static str,
    /// Length [cycles of clk_sys].
    pub cycles: u64,
}

/// Progress of the present frame.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ProgressView {
    /// Number of the frame, from 0.
    pub frame: u64,
    /// State of `frame_ctrl`.
    pub phase: &'static str,
    /// Number of shots begun.
    pub shots: u64,
    /// Number of shots per frame.
    pub of: u64,
    /// Number of frames abandoned since power-up.
    pub abandoned: u64,
}

/// Simulation speed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TimeView {
    /// Time since power-up on the board [s].
    pub board_s: f64,
    /// Time spent on its simulation [s].
    pub here_s: f64,
    /// Frames per second on the board.
    pub board_frames_per_s: f64,
    /// Frames per second in the simulation, recently.
    pub frames_per_s: Option<f64>,
    /// Number of frames since power-up.
    pub frames: u64,
    /// Number of shots since power-up.
    pub shots: u64,
}

/// Bins of the histogram.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BinsView {
    /// Number of bins.
    pub count: usize,
    /// Distance per bin [m].
    pub bin_m: f64,
    /// Distance at which the first bin begins [m].
    pub first_m: f64,
}
