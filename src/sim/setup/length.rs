//! Lengths of a setup's frames and runs.

use crate::kernel::{Time, U};

use super::{Setup, recalibration};

/// Hand-overs of a frame with a preloaded histogram [cycles of clk_sys].
const HAND_OVERS_PRELOADED: u64 = 1;

/// 2.4 hours, well within what [`Time`] can count.
const LONGEST: Time = Time::from_ns(8 << 40);

impl Setup {
    /// Period of the laser at power-up [cycles of clk_sys].
    pub fn laser_period(&self) -> u64 {
        self.params.vcsel_driver.period(U::new(self.scenario.firmware.laser_freq))
    }

    /// Length of an undisturbed frame with such a laser period: from the edge that begins Clear to the one
    /// that raises `algo_done` [cycles of clk_sys].
    pub fn frame_cycles(&self, laser_period: u64) -> u64 {
        let (ctrl, estimator) = (&self.params.frame_ctrl, self.params.estimator_cycles());
        if ctrl.preloaded {
            return self.params.histogram.bins as u64 + HAND_OVERS_PRELOADED + estimator;
        }
        let timing = ctrl.timing(laser_period, estimator);
        // The estimation ends one cycle after that edge.
        timing.acquisition + timing.estimation - 1
    }

    /// Returns whether frames come in pairs, the first of each a dark one.
    pub fn has_pairs(&self) -> bool {
        self.scenario.firmware.dark_frames
    }

    /// Frames that belong together: one, or a dark and a lit one.
    pub fn frames_together(&self) -> u64 {
        if self.has_pairs() { 2 } else { 1 }
    }

    /// Shots of a run.
    pub fn shots(&self, frames: u64) -> u64 {
        let ctrl = &self.params.frame_ctrl;
        if ctrl.preloaded { 0 } else { frames.saturating_mul(ctrl.shots_per_frame as u64) }
    }

    /// When a run ends, if no control signal changes on the way: with the cycle after `frame_done`
    /// of the last frame. Jitter may move it by less than a nanosecond. Not said of runs that nobody
    /// could wait for.
    pub fn end(&self, frames: u64) -> Option<Time> {
        let firmware = &self.scenario.firmware;
        let held = firmware.rst || firmware.dsp_rst || !firmware.dsp_en;
        // A ring's edges come when they come.
        let calibrates = self.params.tdc_calibration.is_some();
        if held || calibrates || !self.scenario.control.is_empty() {
            return None;
        }
        let frame = self.frame_cycles(self.laser_period()) + 1;
        let longest = LONGEST.fs() / self.cycle().fs();
        let edge = frames.checked_mul(frame).filter(|edge| *edge < longest)? + 2;
        Some(self.pll.clk_sys.rise(edge))
    }

    /// A number of cycles that no run of `frames` frames reaches unless its control signals keep
    /// it from ending: each change of theirs may begin a frame again.
    pub fn longest_run(&self, frames: u64) -> u64 {
        let changes = &self.scenario.control;
        let last_us = changes.last().map_or(0.0, |change| change.at_us);
        let block = self.params.tdc_calibration.as_ref();
        let longest_frame = self.frame_cycles(self.params.vcsel_driver.longest_period())
            + recalibration::longest(&self.scenario.tdc, block, self.cycle())
            + 16;
        let begun = frames.saturating_add(changes.len() as u64 + 1);
        let last = Time::from_ps_f64(last_us * 1e6).fs() / self.cycle().fs();
        begun.saturating_mul(longest_frame).saturating_add(last)
    }
}
