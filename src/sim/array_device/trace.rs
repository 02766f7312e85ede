//! Waveforms of the firmware of an array.

use std::sync::atomic::AtomicBool;

use crate::error::{Result, poll_stop};
use crate::kernel::Time;
use crate::scenario::window::Window;
use crate::sim::setup::array::ArraySetup;
use crate::sim::wave_tracer::WaveTracer;
use crate::waves::{Marks, Waves};

use super::ArrayDevice;

/// Cycles between two polls of whether to stop, a part of a second.
const POLL_INTERVAL: u64 = 1 << 12;

impl ArraySetup {
    /// Simulates the firmware of the array cycle by cycle, and writes the parts of so many images that lie in `windows`.
    /// It ends with the last of the windows.
    ///
    /// # Errors
    /// When the firmware has no such array, a window lies past the end, the waveform cannot be written, or it is
    /// stopped.
    pub fn trace(
        &self,
        (waves, windows): (Waves, Vec<Window>),
        images: u64,
        stop: Option<&AtomicBool>,
    ) -> Result<Marks> {
        let params = self.firmware()?;
        let mut device = ArrayDevice::new(self, &params)?;
        let mut tracer = WaveTracer::new(waves, windows);
        if tracer.wants_power_up(device.coming_cycle().0) {
            tracer.begin(Time::ZERO, &device.top);
        }
        device.power_up(&mut tracer);
        let (mut left, mut shots) = (images * self.size().into_iter().product::<usize>() as u64, 0);
        while left > 0 && !tracer.is_over(device.coming_cycle().0) {
            if device.cycle().is_multiple_of(POLL_INTERVAL) {
                poll_stop(stop)?;
            }
            tracer.turn(device.coming_cycle(), &device.top, shots, &params.frame_ctrl)?;
            left -= u64::from(device.step(&mut tracer).is_some());
            shots += u64::from(device.top.vcsel_driver.registers.start);
        }
        // The cycle in which `frame_done` is high.
        tracer.turn(device.coming_cycle(), &device.top, shots, &params.frame_ctrl)?;
        device.step(&mut tracer);
        tracer.finish(device.coming_cycle().0, shots)
    }
}
