//! Registers that the host writes, and the reset.

use crate::firmware::vcsel_driver::Rate;
use crate::kernel::U;

use super::{In, Registers, map};

impl Registers {
    /// Returns whether the host writes a word.
    pub(super) fn writes(&self, i: &In) -> bool {
        i.write_en && i.address.get() >> map::ADDRESS_BITS == 0
    }

    /// Takes the word that the host writes.
    pub(super) fn write(&mut self, i: &In) {
        let (word, set) = (i.write_data.get() as u32, i.write_data);
        let bit = |bit: map::RegisterBit| bit.of(word) != 0;
        match i.address.get() as u32 {
            at if at == map::SCRATCH.address => self.scratch = set,
            at if at == map::CONTROL.address => {
                (self.host_laser_en, self.dsp_en_asked) = (bit(map::LASER_EN), bit(map::DSP_EN));
                (self.host_dsp_rst, self.host_mode) = (bit(map::DSP_RST), bit(map::MODE));
                self.host_laser_freq = Rate::new(map::LASER_FREQ.of(word).into());
                (self.host_ring_on, self.free_running) =
                    (bit(map::RING_ON), bit(map::FREE_RUNNING));
            }
            at if at == map::FRAMES_PERMITTED.address => self.frames_permitted = set,
            at if at == map::HOLD.address => self.hold = word & 1 == 1,
            at if at == map::DENSITY_CLEAR.address && word & 1 == 1 => {
                (self.clearing, self.clear_place, self.density_hits) = (true, U::new(0), U::new(0));
            }
            _ => {}
        }
    }

    /// The synchronous reset.
    pub(super) fn reset(&mut self) {
        let d = *self;
        *self = Registers {
            read_data: d.read_data,
            bank: d.bank,
            hist_bin_last: d.hist_bin_last,
            hist_count_last: d.hist_count_last,
            frame_depth: d.frame_depth,
            frame_sigma: d.frame_sigma,
            frame_status: d.frame_status,
            frame_valid: d.frame_valid,
            clear_place: d.clear_place,
            counted_n: d.counted_n,
            counted: d.counted,
            register_word: d.register_word,
            histogram_word: d.histogram_word,
            density_word: d.density_word,
            in_histogram: d.in_histogram,
            in_density: d.in_density,
            ..Registers::default()
        };
    }
}
