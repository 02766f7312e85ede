//! Sampling of the firmware of an array.

use std::sync::atomic::AtomicBool;

use tofsim::error::Result;
use tofsim::kernel::Time;
use tofsim::sim::array_device::ArrayDevice;
use tofsim::sim::array_device::trace::ArrayProbe;
use tofsim::sim::setup::array::ArraySetup;

use super::{Analyser, Tap};

/// Simulates the firmware of an array until `count` images have ended, or until the analyser is full if it is set to
/// end the run. Returns when the run ended.
///
/// # Errors
/// If the firmware has no such array, the control signals prevent a row from ending, or the run is stopped.
pub fn capture_array(
    array: &ArraySetup,
    count: u64,
    analyser: &mut Analyser,
    stop: Option<&AtomicBool>,
) -> Result<Time> {
    let end = if analyser.plan.every_change {
        array.traced(count, &mut Tap::<true>(analyser), stop)
    } else {
        array.traced(count, &mut Tap::<false>(analyser), stop)
    };
    Ok(end?.end)
}

impl<const EVERY: bool> ArrayProbe for Tap<'_, EVERY> {
    fn begin(&mut self, device: &ArrayDevice) {
        let analyser = &mut *self.0;
        if EVERY {
            analyser.look.follow(&device.top);
        }
        analyser.edge = if analyser.is_shown() { 0 } else { analyser.first };
    }

    fn is_done(&self, _: &ArrayDevice) -> bool {
        self.0.plan.stop_when_full && self.0.is_full()
    }
}
