//! What a browser is told.

use serde::Serialize;

use super::analyser::{IlaView, SetUpView};
use super::causes::Layer;
use super::instrument::Depth;
use super::scene::Slider;
use super::strip::Point;

/// Version of the object.
pub const SCHEMA: &str = "tofsim.page/1";

/// All of the state.
#[derive(Clone, Debug, Serialize)]
pub struct View<'a> {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// Grows with each state.
    pub version: u64,
    /// The scenario's name.
    pub scenario: &'a str,
    /// Seed of every random stream.
    pub seed: u64,
    /// Way through time.
    pub fidelity: &'static str,
    /// Hash of the scenario as it is now.
    pub hash: &'a str,
    /// Whether frames follow each other.
    pub running: bool,
    /// What went wrong in the run, which has stopped it.
    pub fault: Option<&'a str>,
    /// What keeps a frame from ending.
    pub held: Option<&'static str>,
    /// The acquisition computer's signals.
    pub control: ControlView,
    /// The laser's rates, by code.
    pub rates: &'a [RateView],
    /// Why the laser cannot be switched, if it cannot.
    pub laser_fixed: Option<&'static str>,
    /// The scene.
    pub scene: Vec<Slider>,
    /// Whether it has changed, and no frame of the new one has ended yet.
    pub scene_coming: bool,
    /// Why the scene cannot be changed, if it cannot.
    pub scene_fixed: Option<&'static str>,
    /// The last frame.
    pub frame: Option<&'a FrameView>,
    /// The present frame.
    pub progress: ProgressView,
    /// The depths of the last frames.
    pub strip: &'a std::collections::VecDeque<Point>,
    /// What results lie outside of.
    pub notes: Vec<String>,
    /// Time here and on the board.
    pub time: TimeView,
    /// The histogram's bins.
    pub bins: BinsView,
    /// The logic analyser.
    pub ila: IlaView,
    /// Set-ups of captures that are built in.
    pub set_ups: &'a [SetUpView],
    /// Whether the run's scenario says all that has been done to it.
    pub exact: bool,
}

/// The acquisition computer's signals.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ControlView {
    /// Which of the rates.
    pub laser_freq: u64,
    /// SPAD quench mode.
    pub mode: u64,
    /// Lets the laser fire.
    pub laser_en: bool,
    /// Lets the estimator start.
    pub dsp_en: bool,
    /// Abandons the frame.
    pub dsp_rst: bool,
}

/// A rate of the laser.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RateView {
    /// Period [cycles of clk_sys].
    pub cycles: u64,
    /// Rate [MHz].
    pub mhz: f64,
}

/// A frame.
#[derive(Clone, Debug, Serialize)]
pub struct FrameView {
    /// From 0.
    pub index: u64,
    /// Whether the laser could fire, as it ended.
    pub laser_en: bool,
    /// Whether a control signal changed within it.
    pub mixed: bool,
    /// Shots counted.
    pub shots: u64,
    /// Hits that the TDC kept.
    pub tdc_hits: u64,
    /// Hits in the histogram.
    pub hits: u64,
    /// The histogram, the lowest layer first.
    pub layers: Vec<Layer>,
    /// Whether causes were seen, or are what is to be expected.
    pub causes_seen: bool,
    /// What each estimator says.
    pub depths: Vec<Depth>,
    /// The depth word in hexadecimal.
    pub depth_raw: String,
    /// Distance of the target, if a depth can be that [m].
    pub true_m: Option<f64>,
    /// The Cramer-Rao bound, two standard deviations [mm].
    pub bound_two_sd_mm: Option<f64>,
    /// Its parts [cycles of clk_sys].
    pub phases: [PhaseView; 4],
    /// Length [cycles of clk_sys].
    pub frame_cycles: u64,
    /// Length on the board [us].
    pub board_us: f64,
}

/// A part of a frame.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PhaseView {
    /// State of `frame_ctrl`.
    pub name: &'static str,
    /// Length [cycles of clk_sys].
    pub cycles: u64,
}

/// The present frame.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ProgressView {
    /// From 0.
    pub frame: u64,
    /// State of `frame_ctrl`.
    pub phase: &'static str,
    /// Shots begun.
    pub shots: u64,
    /// Shots of a whole frame.
    pub of: u64,
    /// Frames abandoned since power-up.
    pub abandoned: u64,
}

/// Time here and on the board.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TimeView {
    /// Since power-up, on the board [s].
    pub board_s: f64,
    /// Spent on simulating it, here [s].
    pub here_s: f64,
    /// Frames a second on the board.
    pub board_frames_per_s: f64,
    /// Frames a second here, of the last ones.
    pub frames_per_s: Option<f64>,
    /// Frames done since power-up.
    pub frames: u64,
    /// Shots since power-up.
    pub shots: u64,
}

/// The histogram's bins.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BinsView {
    /// How many.
    pub count: usize,
    /// Distance that a bin stands for [m].
    pub bin_m: f64,
    /// Distance at which the first begins [m].
    pub first_m: f64,
}
