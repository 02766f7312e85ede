//! The whole firmware as a scenario runs it, sampled where the bench looks.

use tofsim::error::{Input, Result};
use tofsim::firmware::tof_top::{Pins, TofTop};
use tofsim::firmware::vcsel_driver::Rate;
use tofsim::hierarchy::{self, Entry, IDS, Part};
use tofsim::kernel::Time;
use tofsim::kernel::signals::Signals;
use tofsim::scenario::effects::Method;
use tofsim::signals;
use tofsim::sim::Device;
use tofsim::sim::array_device::ArrayDevice;
use tofsim::sim::device::{Off, SignalProbe};
use tofsim::sim::frames::Frames;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;

use super::lines::Lines;
use super::parameters;
use super::setting::Setting;
use super::spec::{Spec, Vectors};

signals! {
    /// The pins of a line: all but `tdc_stop`, which changes at any time.
    struct Stimulus {
        /// Reset button, until the middle of the cycle.
        rst: bool,
        /// Reset button, from then on.
        rst_late: bool,
        /// SPAD quench mode.
        mode: bool,
        /// Laser repetition rate.
        #[size(RateBits)]
        laser_freq: Rate,
        /// Lets the laser fire.
        laser_en: bool,
        /// Lets the estimator start.
        dsp_en: bool,
        /// Abandons the frame.
        dsp_rst: bool,
    }
}

/// Lines after the PLL has locked in which the resets pass their registers, and reset the rest.
const SETTLES: usize = 8;

/// Sees the firmware just before the edge that takes a line.
pub(super) type EveryCycle<'a> = &'a mut dyn FnMut(&TofTop);

/// The vectors of a run: its frames, or so many cycles. `every_cycle` sees each of them.
pub(super) fn record(
    spec: &'static Spec,
    setting: &Setting,
    every_cycle: EveryCycle,
) -> Result<Vectors> {
    let setup = &setting.setup;
    check(setup)?;
    let entries = hierarchy::entries(&setup.params);
    // Runs that may be long compare what a logic analyser on the board would see.
    let is_own = |entry: &Entry| entry.scope == hierarchy::TOP;
    let wanted = |entry: &Entry| !setting.as_configured || is_own(entry) || entry.signal.view.probe;
    let samples = spec.timing.samples();
    let spacing = Time::from_fs(spec.timing.period(setup.cycle()).fs() / samples as u64);
    let mut sampler = Sampler {
        lines: Lines::new(spec, setting, Stimulus::list(), &entries, wanted),
        current: TofTop::new(Pins::default(), &setup.params),
        sampled: vec![Part::of(0..IDS); samples],
        next: setup.pll().locked_at + spacing,
        spacing,
        early_rst: false,
        stops: Vec::new(),
        column_stops: Vec::new(),
        every_cycle,
    };
    let first_edge = setup.device().next_edge();
    match &setting.array {
        None => run(setting, &mut setup.device(), &mut sampler)?,
        Some(array) => scan(setting, array, &mut sampler)?,
    }
    let Sampler { lines, stops, column_stops, .. } = sampler;
    let parameters = parameters::whole::tof_top(setup);
    let settles = SETTLES;
    Ok(Vectors { parameters, first_edge, stops, column_stops, settles, ..lines.vectors() })
}

/// Runs whole images, or so many cycles.
fn scan(setting: &Setting, array: &ArraySetup, sampler: &mut Sampler) -> Result<()> {
    let mut device = ArrayDevice::new(array, &setting.setup.params)?;
    let [rows, columns] = array.size();
    let mut left = setting.frames as usize * rows * columns;
    device.power_up(sampler);
    let whole_images = setting.cycles.is_none();
    while if whole_images { left > 0 } else { device.cycle() < setting.cycles() as u64 } {
        left = left.saturating_sub(device.step(sampler).map_or(0, |_| 1));
    }
    if whole_images {
        device.step(sampler);
    }
    Ok(())
}

fn run(setting: &Setting, device: &mut Device, sampler: &mut Sampler) -> Result<()> {
    let (setup, mut frames) = (&setting.setup, Frames::default());
    let whole_frames = setting.as_configured && setting.cycles.is_none();
    let limit =
        if whole_frames { setup.longest_run(setting.frames) } else { setting.cycles() as u64 };
    device.power_up(sampler, &mut Off);
    while device.cycle() < limit {
        device.step(&setup.params, sampler, &mut Off);
        frames.edge(device.cycle() - 1, &device.top, &setup.params);
        // A frame of a scenario has the photons that it has in a run.
        if setting.as_configured && device.top.frame_ctrl.frame_done {
            device.begin_frame(frames.done());
        }
        if whole_frames && frames.done() == setting.frames && device.top.frame_ctrl.frame_done {
            device.step(&setup.params, sampler, &mut Off);
            return Ok(());
        }
    }
    if whole_frames {
        let source = format!("scenario {}", setup.name);
        return Err(Input::new(source, "the frame never ends").into());
    }
    Ok(())
}

/// Refuses what the Verilog's PLL and the bench's clocks cannot do.
pub(crate) fn check(setup: &Setup) -> Result<()> {
    setup.require(Method::VerilogBench, "a Verilog bench")?;
    if setup.pll().locked_at.fs().is_multiple_of(1000) {
        return Ok(());
    }
    let expected = "expected whole picoseconds, as pll.v counts them";
    let fault = Input::new(format!("scenario {}", setup.name), expected);
    Err(fault.field("pll.lock_time_us").value(setup.scenario.pll.lock_time_us).into())
}

/// Keeps what the bench would see.
struct Sampler<'a> {
    lines: Lines<'a>,
    /// The firmware since the last instant at which something changed.
    current: TofTop,
    /// Values that the samples of each kind have shown.
    sampled: Vec<Part>,
    /// Instant of the next sample.
    next: Time,
    spacing: Time,
    /// The reset at the edge in the middle of the cycle.
    early_rst: bool,
    stops: Vec<Time>,
    column_stops: Vec<(Time, u32)>,
    every_cycle: EveryCycle<'a>,
}

impl Sampler<'_> {
    /// Takes the sample that falls due.
    fn take(&mut self, pins: &Pins) {
        let (sample, samples) = (self.lines.sample, self.sampled.len());
        if 2 * (sample + 1) == samples {
            self.early_rst = pins.rst;
        }
        if sample + 1 == samples {
            (self.every_cycle)(&self.current);
            let rst = self.early_rst;
            let Pins { rst: rst_late, mode, laser_freq, laser_en, dsp_en, dsp_rst, .. } = *pins;
            let line = Stimulus { rst, rst_late, mode, laser_freq, laser_en, dsp_en, dsp_rst };
            self.lines.input(&line);
        }
        self.lines.sample(|sink| self.sampled[sample].follow(&self.current, sink));
        self.next += self.spacing;
    }
}

impl SignalProbe for Sampler<'_> {
    const ON: bool = true;

    fn sample(&mut self, now: Time, top: &TofTop) {
        while self.next <= now {
            self.take(&top.pins);
        }
        if top.pins.tdc_stop != self.current.pins.tdc_stop {
            self.stops.push(now);
        }
        let mut changed = top.pins.column_stop.get() ^ self.current.pins.column_stop.get();
        while changed != 0 {
            self.column_stops.push((now, changed.trailing_zeros()));
            changed &= changed - 1;
        }
        hierarchy::copy(top, &mut self.current);
    }
}

#[cfg(test)]
mod tests {
    use tofsim::Run;
    use tofsim::firmware::tof_top::slot::SlotEstimator;

    use crate::golden::blocks::BLOCKS;

    use super::*;

    #[test]
    fn the_frames_of_a_scenario_are_those_of_a_run() {
        let setup = Setup::load("bright", &["firmware.shots_per_frame=60"]).unwrap();
        let run = Run::new(&setup).frames(3).unwrap();
        let spec = BLOCKS.iter().find(|spec| spec.name == hierarchy::TOP).unwrap();
        let setting = Setting { as_configured: true, frames: 3, ..Setting::new(setup) };
        let mut depths = Vec::new();
        let see = &mut |top: &TofTop| {
            let out = top.depth_estimator.outputs();
            depths.extend(out.algo_done.then_some(out.words.depth));
        };
        record(spec, &setting, see).unwrap();
        assert_eq!(depths, run.iter().map(|frame| frame.words.depth).collect::<Vec<_>>());
    }
}
