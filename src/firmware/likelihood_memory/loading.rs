//! Reads the histogram, and sums it up in blocks of bins.

use crate::firmware::likelihood_estimator::params::Params;
use crate::kernel::U;

use super::{In, Registers};

impl Registers {
    /// Reads the histogram.
    pub(super) fn load(&self, i: &In, p: &Params, d: &mut Self) {
        let last = self.read_addr == p.histogram.last_bin();
        if i.load {
            (d.read_en, d.read_addr) = (true, U::new(0));
            d.left = U::new(p.shots);
        } else if self.read_en {
            d.read_en = !last;
            d.read_addr = U::new(if last { 0 } else { self.read_addr.get() + 1 });
            d.left = U::new(self.left.get().saturating_sub(i.count.get()));
        }
        d.taken = self.read_en;
        (d.taken_bin, d.taken_ended, d.taken_waiting) = (self.read_addr, i.count, self.left);
        d.begun = self.taken;
        (d.begun_bin, d.begun_ended) = (self.taken_bin, self.taken_ended);
        (d.begun_waiting, d.begun_three) =
            (self.taken_waiting, U::new(3 * self.taken_waiting.get()));
        let width = self.fetched_width.get();
        d.begun_width = U::new(width >> 4);
        d.begun_exposure = U::new(self.taken_waiting.get() * (width & 15));
        d.written = self.begun;
        (d.written_bin, d.written_ended) = (self.begun_bin, self.begun_ended);
        d.written_waiting = self.begun_waiting;
        let exposure = (self.begun_waiting.get() * self.begun_width.get()) << 4;
        d.written_exposure = U::new(exposure + self.begun_exposure.get());
    }

    /// Sums over a block.
    pub(super) fn sum(&self, p: &Params, d: &mut Self) {
        let block = p.histogram.bins as u64 / 8;
        let place = self.written_bin.get() % block;
        d.block_done = self.written && place == block - 1;
        if self.written {
            let (ended, exposure) = (self.written_ended.get(), self.written_exposure.get());
            let first = place == 0;
            d.block_ended = U::new(if first { ended } else { self.block_ended.get() + ended });
            d.block_exposure =
                U::new(if first { exposure } else { self.block_exposure.get() + exposure });
        }
    }
}
