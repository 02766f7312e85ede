//! The depths of the last frames.

use std::collections::VecDeque;

use serde::Serialize;

use super::instrument::Depth;

/// Frames that are kept.
const KEPT: usize = 240;

/// The depths of a frame.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    /// Frame, from 0.
    pub frame: u64,
    /// Where the target is, if a depth can be the target's [m].
    pub true_m: Option<f64>,
    /// What each estimator says [m].
    pub depths_m: Vec<Option<f64>>,
    /// The Cramer-Rao bound, two standard deviations [mm].
    pub bound_two_sd_mm: Option<f64>,
}

/// The depths of the last frames, the oldest first.
#[derive(Clone, Debug, Default)]
pub struct Strip(VecDeque<Point>);

impl Strip {
    /// Adds a frame, and lets the oldest go.
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
        let depths_m = depths.iter().map(|depth| depth.depth_m.map(rounded)).collect();
        let bound_two_sd_mm = bound_two_sd_mm.map(rounded);
        self.0.push_back(Point { frame, true_m, depths_m, bound_two_sd_mm });
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// The frames.
    pub fn points(&self) -> &VecDeque<Point> {
        &self.0
    }
}

/// To a micrometre.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}
