//! What a pixel has measured in an image, and what it can expect.

use crate::firmware::tof_top::status::StatusSet;
use crate::sim::estimates::EchoDepth;
use crate::sim::frames::Frame;
use crate::sim::setup::Setup;

/// What the frames of a pixel can be expected to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// Mean distance of what returns the pixel's light, along the line of sight; `None` if nothing does [m].
    pub radial_m: Option<f64>,
    /// Hits of laser photons in the histogram; `None` where shots depend on each other [1].
    pub signal_hits: Option<f64>,
    /// Other hits in the histogram; `None` where shots depend on each other [1].
    pub ambient_hits: Option<f64>,
}

/// Result of a pixel in one image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelFrame {
    /// Estimated distance along the line of sight [m].
    pub radial_m: f64,
    /// Its standard deviation, from an estimator that states one [m].
    pub sigma_m: Option<f64>,
    /// Whether the status has no reason to reject the distance.
    pub valid: bool,
    /// Reasons to reject it.
    pub status: StatusSet,
    /// The second target, where the firmware looks for one and has found it, if both distances are valid.
    pub second: Option<EchoDepth>,
    /// Hits in the histogram.
    pub hits: u64,
}

impl PixelFrame {
    /// Extracts the result of a frame.
    pub(super) fn of(frame: &Frame) -> Self {
        let estimate = frame.estimate();
        PixelFrame {
            radial_m: frame.depth_m(),
            sigma_m: estimate.sigma_m,
            valid: estimate.valid,
            status: estimate.status,
            second: estimate.second.filter(|second| estimate.valid && second.valid == Some(true)),
            hits: frame.hits(),
        }
    }
}

impl Expected {
    /// Computes what the frames of a setup can be expected to hold.
    pub(super) fn of(setup: &Setup) -> Self {
        let radial_m = setup.mean_radial_m();
        let (chances, shots) = (setup.chances(), setup.shots(1) as f64);
        let signal = chances.map(|chances| chances.counted_signal);
        let ambient = chances.map(|chances| (chances.counted - chances.counted_signal).max(0.0));
        let [signal_hits, ambient_hits] = [signal, ambient].map(|hits| Some(hits? * shots));
        Expected { radial_m, signal_hits, ambient_hits }
    }
}
