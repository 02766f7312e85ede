//! Follows the firmware's frames: when they begin and end, and what they gave.

use crate::firmware::tof_top::slot::{DepthM, EstimateWords};
use crate::firmware::tof_top::{FirmwareEstimator, HistogramSource, Params, TofTop};
use crate::network::Histogram;

use super::estimates::Estimate;

/// One finished frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// From 0.
    pub index: u64,
    /// Whether the laser could fire, as the frame ended.
    pub laser_en: bool,
    /// The estimator of the firmware.
    pub estimator: FirmwareEstimator,
    /// The estimator's words.
    pub words: EstimateWords,
    /// Shots counted.
    pub shots: u64,
    /// Hits that the TDC kept, with a code or without.
    pub tdc_hits: u64,
    /// The estimator's histogram [hits].
    pub histogram: Histogram,
    /// From the edge that takes `algo_start` to the one that raises `algo_done` [cycles of clk_sys].
    pub estimator_cycles: u64,
    /// From the edge that begins Clear to the one that raises `algo_done` [cycles of clk_sys].
    pub frame_cycles: u64,
}

impl Frame {
    /// Depth word [m].
    pub fn depth(&self) -> DepthM {
        self.words.depth_m()
    }

    /// Estimated distance [m].
    pub fn depth_m(&self) -> f64 {
        self.depth().to_num()
    }

    /// Returns the estimate: depth, sigma, status.
    pub fn estimate(&self) -> Estimate {
        Estimate::of_words(self.estimator, &self.words)
    }

    /// Hits in the histogram.
    pub fn hits(&self) -> u64 {
        self.histogram.iter().map(|&count| count as u64).sum()
    }
}

/// Counters of a running frame.
#[derive(Clone, Debug, Default)]
pub struct Frames {
    pub(super) done: u64,
    /// Shots begun since power-up.
    pub(super) shots: u64,
    pub(super) tdc_hits: u64,
    pub(super) clear_at: u64,
    start_at: u64,
}

impl Frames {
    /// Shots begun since power-up.
    pub fn shots(&self) -> u64 {
        self.shots
    }

    /// Frames finished since power-up.
    pub fn done(&self) -> u64 {
        self.done
    }

    /// Looks at the registers after edge `cycle`; returns the frame that it finished.
    #[inline(always)]
    pub fn edge(&mut self, cycle: u64, top: &TofTop, p: &Params) -> Option<Frame> {
        let ctrl = &top.frame_ctrl;
        self.count_shot(top);
        self.count_hit(top);
        if ctrl.clear | ctrl.algo_start | top.slot.algo_done {
            return self.turn(cycle, top, p);
        }
        None
    }

    /// Counts the shot that begins in this cycle.
    #[inline(always)]
    pub fn count_shot(&mut self, top: &TofTop) {
        self.shots += top.vcsel_driver.registers.start as u64;
    }

    /// Counts the hit that the TDC keeps in this cycle.
    #[inline(always)]
    pub fn count_hit(&mut self, top: &TofTop) {
        if top.tdc.tdc_latch.hit && !top.tdc_calibration.registers.calibrating {
            self.tdc_hits += 1;
        }
    }

    fn turn(&mut self, cycle: u64, top: &TofTop, p: &Params) -> Option<Frame> {
        let ctrl = &top.frame_ctrl;
        if ctrl.clear && ctrl.clear_addr == 0 {
            (self.clear_at, self.tdc_hits) = (cycle, 0);
        }
        if ctrl.algo_start {
            self.start_at = cycle + 1;
        }
        if !top.slot.algo_done {
            return None;
        }
        let histogram = match &p.histogram_source {
            HistogramSource::Builder => &top.histogram_builder.ram,
            HistogramSource::Preload(rom) => rom,
        };
        self.done += 1;
        Some(Frame {
            index: self.done - 1,
            laser_en: top.control_sync.laser_en_sync,
            estimator: p.estimator,
            words: top.slot.words,
            shots: ctrl.shots(),
            tdc_hits: self.tdc_hits,
            histogram: histogram.iter().map(|word| word.get() as u32).collect(),
            estimator_cycles: cycle - self.start_at,
            frame_cycles: cycle - self.clear_at,
        })
    }
}
