//! Gives a host registers for control, state, the last finished frame and the code density of the TDC.
//!
//! Mirrors `rtl_ref/registers.v`. One bank of the histogram's copy takes what the estimator reads while the host reads
//! the other; they change places when a frame ends, unless the host holds the frame that it reads. The word at an
//! address is there two edges after it.

use crate::firmware::forward2::Depth;
use crate::firmware::histogram_builder::{Bin, Count};
use crate::firmware::tdc_calibration::Place;
use crate::firmware::tof_top::slot::{Sigma, StatusBits};
use crate::firmware::tof_top::status_code::StatusCode;
use crate::firmware::vcsel_driver::Rate;
use crate::kernel::U;
use crate::{module_of_registers, signals};

pub mod map;
mod reading;
mod writing;

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// Address of the host's word [words].
        pub address: U<32>,
        /// `write_data` is to be written.
        pub write_en: bool,
        /// Word of the host's.
        pub write_data: U<32>,
        /// The switch selects the control pins.
        pub pins_selected: bool,
        /// The laser may fire.
        pub armed: bool,
        /// The interlock is open.
        pub interlock_sync: bool,
        /// The laser went off because the host was silent.
        pub host_silent: bool,
        /// Because the PLL was not locked.
        pub unlocked: bool,
        /// Because the interlock was open.
        pub interlocked: bool,
        /// Because a pulse would have been too long.
        pub pulse_too_long: bool,
        /// Because a pulse would have come too soon.
        pub rate_too_high: bool,
        /// A shot begins.
        pub start: bool,
        /// A hit has a code.
        pub tdc_valid: bool,
        /// `n` is that of a new hit.
        pub n_valid: bool,
        /// Number of the decoder for the taps.
        #[size(CountOfTaps)]
        pub n: Place,
        /// A calibration of the TDC is under way.
        pub calibrating: bool,
        /// Shots are taken.
        pub acquire: bool,
        /// A word of the histogram is being read.
        pub hist_valid: bool,
        /// Which word.
        #[size(BinBits)]
        pub hist_bin: Bin,
        /// The word [hits].
        #[size(CountBits)]
        pub hist_count: Count,
        /// The frame has ended.
        pub frame_done: bool,
        /// Its depth [m].
        pub depth: Depth,
        /// Standard deviation of the depth [2^-29 m].
        pub sigma: Sigma,
        /// Reasons to reject the depth.
        pub status: StatusBits,
        /// There are none.
        pub valid: bool,
        /// What a host can rely on.
        pub code: StatusCode,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Registers {
        /// The word at the address.
        pub read_data: U<32>,
        /// Arms the laser; one cycle.
        pub arm: bool,
        /// Disarms it; one cycle.
        pub disarm: bool,
        /// SPAD quench mode.
        pub host_mode: bool,
        /// Laser repetition rate.
        #[size(RateBits)]
        pub host_laser_freq: Rate,
        /// Lets the laser fire.
        pub host_laser_en: bool,
        /// Lets the estimator start.
        pub host_dsp_en: bool,
        /// Abandons the frame.
        pub host_dsp_rst: bool = true,
        /// Hits are to come from the ring oscillator.
        pub host_ring_on: bool,
        /// Keeps what is written.
        pub(crate) scratch: U<32>,
        /// `dsp_en` as the host has it, whatever frames are permitted.
        pub(crate) dsp_en_asked: bool,
        /// Frames do not wait for permission.
        pub(crate) free_running: bool,
        /// Frames that may still be estimated.
        pub(crate) frames_permitted: U<32>,
        /// Frames since the reset.
        pub(crate) frames: U<32>,
        /// Shots since the reset.
        pub(crate) shots: U<32>,
        /// Hits with a code since the reset.
        pub(crate) hits: U<32>,
        /// `calibrating` at the edge before.
        pub(crate) calibrating_last: bool,
        /// A calibration has ended, and none is under way.
        pub(crate) calibrated: bool,
        /// Keeps the last finished frame.
        pub(crate) hold: bool,
        /// Half of the histogram's copy that takes a frame's words.
        pub(crate) bank: bool,
        /// A word of the histogram was being read a cycle ago: its way here is long.
        pub(crate) hist_valid_last: bool,
        /// Which word.
        #[size(BinBits)]
        pub(crate) hist_bin_last: Bin,
        /// The word [hits].
        #[size(CountBits)]
        pub(crate) hist_count_last: Count,
        /// Number of the last finished frame plus one.
        pub(crate) frame: U<32>,
        /// Its depth [m].
        pub(crate) frame_depth: Depth,
        /// Standard deviation of the depth [2^-29 m].
        pub(crate) frame_sigma: Sigma,
        /// Reasons to reject the depth.
        pub(crate) frame_status: StatusBits,
        /// There are none.
        pub(crate) frame_valid: bool,
        /// What a host can rely on.
        pub(crate) frame_code: StatusCode,
        /// Counts are set to zero.
        pub(crate) clearing: bool,
        /// Which one.
        #[size(CountOfTaps)]
        pub(crate) clear_place: Place,
        /// The count of `counted_n` is in `counted`.
        pub(crate) counting: bool,
        /// The last `n`.
        #[size(CountOfTaps)]
        pub(crate) counted_n: Place,
        /// Hits of the last `n`.
        pub(crate) counted: U<32>,
        /// Hits counted.
        pub(crate) density_hits: U<32>,
        /// Word of a register.
        pub(crate) register_word: U<32>,
        /// Word of the histogram.
        #[size(CountBits)]
        pub(crate) histogram_word: Count,
        /// Hits of an `n`.
        pub(crate) density_word: U<32>,
        /// The address is one of a bin.
        pub(crate) in_histogram: bool,
        /// It is one of an `n`.
        pub(crate) in_density: bool,
    }
}

/// Parameters that elaboration fixes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Params {
    /// Hash of the firmware's parameters.
    pub parameters_hash: u64,
    /// Frequency of clk_sys [Hz].
    pub system_hz: u32,
    /// Silence of the host after which the laser goes off [cycles of clk_sys].
    pub host_timeout: u32,
    /// Bins of the histogram.
    pub bins: usize,
    /// Taps of the delay chain.
    pub taps: usize,
}

/// Registers and RAMs. Too large to copy at every edge, so they are clocked in place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RegisterFile {
    /// Registers.
    pub registers: Registers,
    /// Two banks of a histogram [hits].
    pub histogram_ram: Box<[Count]>,
    /// Hits of each `n`.
    pub density_ram: Box<[U<32>]>,
}

module_of_registers!(RegisterFile);

impl RegisterFile {
    /// Returns whether the host holds the last finished frame.
    pub fn is_held(&self) -> bool {
        self.registers.hold
    }

    /// Returns the number of frames that may still be estimated.
    pub fn frames_permitted(&self) -> u64 {
        self.registers.frames_permitted.get()
    }

    /// Returns whether the counts of the code density are set to zero.
    pub fn is_clearing(&self) -> bool {
        self.registers.clearing
    }

    /// At power-up.
    pub fn new(p: &Params) -> Self {
        RegisterFile {
            registers: Registers::default(),
            histogram_ram: vec![U::new(0); 2 * p.bins].into(),
            density_ram: vec![U::new(0); p.taps + 1].into(),
        }
    }

    /// The rising edge of `clk_sys`.
    pub fn tick(&mut self, i: &In, p: &Params) {
        let q = self.registers;
        let mut d = q;
        self.read(&mut d, i, p);
        q.follow(&mut d, i, p);
        d.counted = self.density_ram.get(i.n.index()).copied().unwrap_or_default();
        d.counted_n = i.n;
        if q.hist_valid_last {
            let bank = usize::from(q.bank) * p.bins;
            self.histogram_ram[bank + q.hist_bin_last.index()] = q.hist_count_last;
        }
        if q.clearing {
            self.density_ram[q.clear_place.index()] = U::new(0);
        } else if q.counting
            && let Some(count) = self.density_ram.get_mut(q.counted_n.index())
        {
            *count = q.counted + 1;
        }
        if q.writes(i) {
            d.write(i);
        }
        if i.rst {
            d.reset();
        }
        self.registers = d;
    }
}

impl Registers {
    /// Follows the firmware.
    fn follow(&self, d: &mut Self, i: &In, p: &Params) {
        let q = self;
        let is_arm = q.writes(i) && i.address == u64::from(map::ARM.address);
        let is_key = i.write_data == u64::from(map::ARM_KEY);
        (d.arm, d.disarm) = (is_arm && is_key, is_arm && !is_key);
        d.hist_valid_last = i.hist_valid;
        (d.hist_bin_last, d.hist_count_last) = (i.hist_bin, i.hist_count);
        d.calibrating_last = i.calibrating;
        d.calibrated = !i.calibrating && (q.calibrated || q.calibrating_last);
        d.counting = i.n_valid && !q.clearing && q.density_hits != u64::from(u32::MAX);
        d.density_hits = q.density_hits + u64::from(d.counting);
        if q.clearing {
            d.clear_place = q.clear_place + 1;
            d.clearing = q.clear_place != p.taps as u64;
        }
        d.frames = q.frames + u64::from(i.frame_done);
        d.shots = q.shots + u64::from(i.start);
        d.hits = q.hits + u64::from(i.tdc_valid);
        d.host_dsp_en = q.dsp_en_asked && (q.free_running || q.frames_permitted != 0);
        if i.frame_done && q.frames_permitted != 0 {
            d.frames_permitted = q.frames_permitted - 1;
        }
        if i.frame_done && !q.hold {
            (d.bank, d.frame) = (!q.bank, q.frames + 1);
            (d.frame_depth, d.frame_sigma) = (i.depth, i.sigma);
            (d.frame_status, d.frame_valid, d.frame_code) = (i.status, i.valid, i.code);
        }
    }
}

#[cfg(test)]
mod tests;
