//! Cycles of a row and of an image.

use super::Params;

/// How long rows and images take [cycles of clk_sys].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowTiming {
    /// Clear, Acquire and Drain: what the histograms of a row are filled in.
    pub acquisition: u64,
    /// From the start of the first estimate of a row to `algo_done` of the last one, that cycle included.
    pub estimation: u64,
    /// From the begin of Clear to that of the next row.
    pub row: u64,
    /// From the begin of Clear of row 0 to that of the next image.
    pub image: u64,
    /// From the fall of `acquire` to `algo_done` of the row's last depth.
    pub latency: u64,
}

impl Params {
    /// Returns the cycles of rows and images, for a laser period and an estimator of so many cycles, from the edge that
    /// takes `algo_start` to the one that raises `algo_done`, and with `dsp_en` high.
    pub fn timing(&self, laser_period: u64, estimator_cycles: u64) -> RowTiming {
        let shots = u64::from(self.shots_per_frame);
        let acquisition = self.histogram.bins as u64 + shots * laser_period + 1 + self.drain_cycles;
        let estimation = u64::from(self.scan.columns) * (estimator_cycles + 2);
        let row = match self.scan.is_banked() {
            true => acquisition.max(estimation + 1),
            false => acquisition + estimation,
        };
        let waits = if self.scan.is_banked() { row - acquisition } else { 0 };
        let latency = self.drain_cycles + waits + estimation - 1;
        RowTiming { acquisition, estimation, row, image: row * u64::from(self.scan.rows), latency }
    }
}
