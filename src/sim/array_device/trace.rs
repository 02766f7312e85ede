//! Runs of the firmware of an array for probes of its signals, waveforms among them.

use std::sync::atomic::AtomicBool;

use crate::error::{Error, Input, Result, poll_stop};
use crate::kernel::Time;
use crate::scenario::Firmware;
use crate::scenario::window::Window;
use crate::sim::device::SignalProbe;
use crate::sim::setup::Setup;
use crate::sim::setup::array::ArraySetup;
use crate::sim::wave_tracer::WaveTracer;
use crate::waves::{Marks, Waves};

use super::ArrayDevice;

/// Cycles between two polls of whether to stop, a part of a second.
const POLL_INTERVAL: u64 = 1 << 12;

/// A probe of the firmware of an array, from power-up on.
pub trait ArrayProbe: SignalProbe {
    /// Receives the device at power-up.
    fn begin(&mut self, device: &ArrayDevice);
    /// Receives the device before each cycle, after so many shots of the run.
    ///
    /// # Errors
    /// When the probe has failed.
    fn turn(&mut self, _device: &ArrayDevice, _shots: u64) -> Result<()> {
        Ok(())
    }
    /// Returns whether the run may end before the coming cycle.
    fn is_done(&self, device: &ArrayDevice) -> bool;
}

/// Where a run of an array has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArrayEnd {
    /// When it ended.
    pub end: Time,
    /// Shots begun, those of all rows.
    pub shots: u64,
}

impl ArraySetup {
    /// Simulates the firmware of the array cycle by cycle until so many images are done, or until `probe` is.
    ///
    /// # Errors
    /// When the firmware has no such array, the control signals keep a row from ending, the probe fails, or it is
    /// stopped.
    #[doc(hidden)]
    pub fn traced<T: ArrayProbe>(
        &self,
        images: u64,
        probe: &mut T,
        stop: Option<&AtomicBool>,
    ) -> Result<ArrayEnd> {
        let setup = self.with_firmware()?;
        let mut device = ArrayDevice::new(self, &setup.params)?;
        let pixels = self.size().into_iter().product::<usize>() as u64;
        let (mut left, mut shots) = (images.saturating_mul(pixels), 0);
        // A cycle in which the next depth has come, if one does.
        let mut limit = setup.longest_run(1);
        probe.begin(&device);
        device.power_up(probe);
        while left > 0 && !probe.is_done(&device) {
            if device.cycle().is_multiple_of(POLL_INTERVAL) {
                poll_stop(stop)?;
            }
            if device.cycle() > limit {
                return Err(never_ends(&setup));
            }
            probe.turn(&device, shots)?;
            if device.step(probe).is_some() {
                left -= 1;
                limit = device.cycle() + setup.longest_run(1);
            }
            shots += u64::from(device.top.vcsel_driver.registers.start);
        }
        // The cycle in which `frame_done` is high.
        probe.turn(&device, shots)?;
        device.step(probe);
        Ok(ArrayEnd { end: device.coming_cycle().0, shots })
    }

    /// Simulates the firmware of the array cycle by cycle, and writes the parts of so many images that lie in `windows`.
    /// It ends with the last of the windows.
    ///
    /// # Errors
    /// As [`ArraySetup::traced`], and when a window lies past the end or the waveform cannot be written.
    pub fn trace(
        &self,
        (waves, windows): (Waves, Vec<Window>),
        images: u64,
        stop: Option<&AtomicBool>,
    ) -> Result<Marks> {
        let mut tracer = WaveTracer::new(waves, windows);
        let ArrayEnd { end, shots } = self.traced(images, &mut tracer, stop)?;
        tracer.finish(end, shots)
    }
}

/// Returns the error that a control signal keeps the rows from ending, and which.
fn never_ends(setup: &Setup) -> Error {
    let Firmware { rst, dsp_rst, .. } = setup.scenario.firmware;
    let (key, value) = match (rst, dsp_rst) {
        (true, _) => ("rst", true),
        (_, true) => ("dsp_rst", true),
        _ => ("dsp_en", false),
    };
    let expected = format!("expected {}: no row of the array ends", !value);
    let fault = Input::new(format!("scenario {}", setup.name), expected);
    fault.field(format!("firmware.{key}")).value(value).into()
}

impl ArrayProbe for WaveTracer {
    fn begin(&mut self, device: &ArrayDevice) {
        if self.wants_power_up(device.coming_cycle().0) {
            WaveTracer::begin(self, Time::ZERO, &device.top);
        }
    }

    fn turn(&mut self, device: &ArrayDevice, shots: u64) -> Result<()> {
        let ctrl = &device.params.frame_ctrl;
        WaveTracer::turn(self, device.coming_cycle(), &device.top, shots, ctrl).map(|_| ())
    }

    fn is_done(&self, device: &ArrayDevice) -> bool {
        self.is_over(device.coming_cycle().0)
    }
}
