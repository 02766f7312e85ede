//! Depths of the last frames.

use std::collections::VecDeque;

use serde::Serialize;

use super::instrument::Depth;

/// Number of frames that are kept.
const KEPT: usize = 240;

/// Depths of a frame.
#[derive(Clone, Debug, Serialize)]
pub struct StripPoint {
    /// Number of the frame, from 0.
    pub frame: u64,
    /// Distance of the target, if a depth can be the target's [m].
    pub true_m: Option<f64>,
    /// Depth of each estimator [m].
    pub depths_m: Vec<Option<f64>>,
    /// Cramer-Rao bound, two standard deviations [mm].
    pub bound_two_sd_mm: Option<f64>,
}

/// Depths of the last frames, oldest first.
#[derive(Clone, Debug, Default)]
pub struct Strip(VecDeque<StripPoint>);

impl Strip {
    /// Adds a frame, and drops the oldest if there are too many.
    pub fn push(
        &mut self,
        frame: u64,
        true_m: Option<f64>,
        depths: &[Depth],
        bound_two_sd_mm: Option<f64>,
    ) {
        if self.0.len() == KEPT {
            self.0.pop_front();
        }
        let depths_m = depths.iter().map(|depth| depth.estimate.depth_m.map(rounded)).collect();
        let bound_two_sd_mm = bound_two_sd_mm.map(rounded);
        self.0.push_back(StripPoint { frame, true_m, depths_m, bound_two_sd_mm });
    }

    /// Removes all frames.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Returns the frames.
    pub fn points(&self) -> &VecDeque<StripPoint> {
        &self.0
    }
}

/// Rounds to a micrometre.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
