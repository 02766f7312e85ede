//! Ring oscillator and schedule of the firmware's TDC calibration.

use crate::firmware::tdc_calibration::{BEATS, Params};
use crate::firmware::{tdc, tdc_calibration};
use crate::kernel::Time;
use crate::scenario::Tdc;
use crate::sensor::ring;

/// The parameters of the block, and the converter with ages from it.
pub(super) fn of(keys: &Tdc, tdc: tdc::Params) -> (tdc::Params, Option<Params>) {
    let (frames, hits_log2) = (keys.recalibrate_frames, keys.calibration_hits_log2);
    if frames == 0 {
        return (tdc, None);
    }
    let own = tdc_calibration::Params::new(&tdc.delays, &tdc.decoder.scale, hits_log2, frames);
    (tdc.calibrated(hits_log2), Some(own))
}

/// The ring oscillator.
pub(super) fn ring(keys: &Tdc) -> ring::Params {
    let half = Time::from_ps_f64(keys.ring_ns * 1e3 / 2.0);
    ring::Params { half, jitter_fs: keys.ring_jitter_ps * 1e3 }
}

/// Cycles that no calibration reaches, or 0 without any, where a clock period is `cycle` [cycles of clk_sys].
pub(super) fn longest(keys: &Tdc, block: Option<&Params>, cycle: Time) -> u64 {
    block.map_or(0, |p| {
        let (words, halves) = (p.taps as u64 + 1, 2 * (p.hits() + 2));
        // Twice as long, for what jitter adds.
        let half = 2 * ring(keys).half.fs() / cycle.fs() + 1;
        halves * half + (1 + BEATS) * words + 16
    })
}
