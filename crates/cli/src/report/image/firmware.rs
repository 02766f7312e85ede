//! The image rate of the firmware.

use std::fmt::{self, Display};

use serde::Serialize;

use tofsim::sim::setup::array::ArraySetup;

use crate::text::table::{fixed, grouped};

/// How long rows and images take in the firmware.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct FirmwareTiming {
    /// Banks of histograms.
    banks: u32,
    /// From the begin of a row to that of the next one [cycles of clk_sys].
    row_cycles: u64,
    /// From the begin of an image to that of the next one [cycles of clk_sys].
    image_cycles: u64,
    /// From the end of a row's acquisition to its last depth [cycles of clk_sys].
    depth_latency_cycles: u64,
    /// The same [s].
    depth_latency_s: f64,
    /// Image rate [1/s].
    images_per_s: f64,
}

impl FirmwareTiming {
    /// Returns the timing of the firmware that scans an array, if there is one.
    pub fn of(array: &ArraySetup) -> Option<Self> {
        let (timing, cycle_s) = (array.timing().ok()?, array.common().cycle().seconds());
        Some(FirmwareTiming {
            banks: array.common().scenario.array.banks,
            row_cycles: timing.row,
            image_cycles: timing.image,
            depth_latency_cycles: timing.latency,
            depth_latency_s: timing.latency as f64 * cycle_s,
            images_per_s: 1.0 / (timing.image as f64 * cycle_s),
        })
    }
}

impl Display for FirmwareTiming {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (rate, latency_us) =
            (fixed(self.images_per_s, 2), fixed(1e6 * self.depth_latency_s, 1));
        let (row, banks) =
            (grouped(self.row_cycles), if self.banks > 1 { "banks" } else { "bank" });
        let banks = format!("{} {banks}", self.banks);
        write!(
            f,
            "{rate} images/s: {row} cycles a row, {banks}; a row's last depth {latency_us} us after its acquisition"
        )
    }
}
