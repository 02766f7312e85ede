//! Hand-driven firmware for the tests of this folder.

use std::sync::Arc;

use crate::firmware::carry_chain::{Delays, TAPS, Transitions};
use crate::firmware::depth_estimator::datapath::Datapath;
use crate::firmware::forward2::{MOST_NEURONS, NEURONS};
use crate::firmware::tof_top::estimator_params::EstimatorParams;
use crate::firmware::tof_top::{
    CodeSource, FirmwareEstimator, HistogramSource, Params, Pins, TofTop,
};
use crate::firmware::{
    depth_estimator, forward1, forward2, frame_ctrl, histogram_builder, tansig, tdc, vcsel_driver,
};
use crate::kernel::scan::Scan;
use crate::kernel::{S, Time, U};

use super::super::writer::Waves;

/// Shots per frame.
pub const SHOTS: u32 = 12;

/// Parameters with a bubble-free chain, small ROMs and short frames.
pub fn params() -> Params {
    with_delays(&[11_500; TAPS])
}

/// Parameters with a chain of the given delays [fs], small ROMs and short frames.
pub fn with_delays(taps: &[i64]) -> Params {
    let delays = Delays::new(Time::from_fs(2_230_000), taps).unwrap();
    let weight = |row: usize, neuron: usize| {
        if neuron < NEURONS {
            S::new((row * 37 + neuron * 911) as i64 % 4001 - 2000)
        } else {
            S::new(0)
        }
    };
    let histogram = histogram_builder::Params::default();
    let row = |row: usize| std::array::from_fn(|neuron| weight(row, neuron));
    let w1 = (0..histogram.bins).map(row).collect();
    let datapath = Datapath::THESIS;
    let rom = forward1::Rom::new(w1, row(histogram.bins), NEURONS, &datapath, &histogram);
    let entries = (0..4096).map(|address| S::new((address - 2048) * 8)).collect();
    let tansig = tansig::Rom { entries, shift: datapath.shift() };
    let forward2 = forward2::Rom {
        neurons: NEURONS,
        w2: [S::new(9000); MOST_NEURONS],
        b2: S::new(700),
        datapath,
    };
    let (forward1, tansig) = (Arc::new(rom), Arc::new(tansig));
    let mut estimators = EstimatorParams::of(&histogram);
    estimators.depth_estimator = Arc::new(depth_estimator::Params { forward1, tansig, forward2 });
    Params {
        histogram,
        frame_ctrl: frame_ctrl::Params {
            shots_per_frame: SHOTS,
            histogram,
            preloaded: false,
            drain_cycles: frame_ctrl::DRAIN_CYCLES,
            scan: Scan::default(),
        },
        vcsel_driver: vcsel_driver::Params::default(),
        tdc: tdc::Params::of_chain(delays),
        channels: Vec::new(),
        tdc_calibration: None,
        estimators,
        estimator: FirmwareEstimator::Network,
        code_source: CodeSource::Tdc,
        histogram_source: HistogramSource::Builder,
        is_hosted: false,
    }
}

/// Firmware whose SPAD fires a fixed time after each laser pulse.
pub struct Bench {
    /// Current state of the firmware.
    pub top: TofTop,
    params: Params,
    transitions: Transitions,
    cycle: u64,
    shot: u64,
    photon: Time,
}

impl Bench {
    /// Creates the firmware at power-up, with the PLL locked and the highest laser frequency.
    pub fn new(params: Params) -> Self {
        let pins = Pins { laser_freq: U::new(3), laser_en: true, dsp_en: true, ..Pins::default() };
        let mut top = TofTop::new(pins, &params);
        top.pll.locked = true;
        let transitions = Transitions::default();
        Bench { top, params, transitions, cycle: 0, shot: 0, photon: Time::NEVER }
    }

    /// Returns the time of the next cycle's first edge.
    pub fn now(&self) -> Time {
        Time::from_ns(8 * self.cycle)
    }

    /// Runs one cycle of `clk_sys`, and calls `see` at every instant at which a signal may have changed.
    pub fn cycle(&mut self, see: &mut impl FnMut(Time, &TofTop)) {
        let start = self.now();
        for quarter in 0..4 {
            let now = start + Time::from_ns(2 * quarter);
            let held = self.top.pins.tdc_stop;
            self.top.clocks.clk_laser = quarter % 2 == 0;
            self.top.clocks.clk_sys = quarter < 2;
            match quarter {
                0 => {
                    let taps = self.transitions.sample(held, now, &self.params.tdc.delays);
                    self.top.rise(&self.params, taps);
                }
                2 => self.top.rise_laser(&self.params),
                _ => self.top.fall_laser(),
            }
            if quarter == 0 && self.top.spad_control.spad_rst && held {
                self.stop(now);
            }
            see(now, &self.top);
            if quarter == 0 && self.top.nets.laser_on {
                self.shot += 1;
                self.photon = now + Time::from_fs(900_400 + self.shot % 5 * 1_300_000);
            }
            if self.photon < start + Time::from_ns(2 * quarter + 2) {
                let at = std::mem::replace(&mut self.photon, Time::NEVER);
                self.stop(at);
                see(at, &self.top);
            }
        }
        self.cycle += 1;
    }

    fn stop(&mut self, now: Time) {
        self.top.pins.tdc_stop ^= true;
        self.transitions.push(now);
    }

    /// Runs cycles of `clk_sys`, sampled by each of `waves`.
    pub fn run(&mut self, cycles: u64, waves: &mut [Waves]) {
        for _ in 0..cycles {
            self.cycle(&mut |now, top| {
                for waves in &mut *waves {
                    waves.sample(now, top);
                }
            });
        }
    }
}
