//! The histogram: 256 words of 16 bits in distributed RAM.
//!
//! Mirrors `rtl_ref/histogram_builder.v`. Asynchronous read, synchronous write, one address:
//! clear goes before hit, hit before read. `count + 1` is written at the edge that ends the
//! `tdc_valid` cycle, so equal codes back to back are safe. There is no other register, and the
//! RAM has no reset.

use crate::kernel::U;
use crate::kernel::module::{Module, Visitor};
use crate::signals;

/// Words of the histogram.
pub const BINS: usize = 256;

signals! {
    /// Input ports.
    pub struct In {
        /// Sets the word at `clear_addr` to zero.
        pub clear: bool,
        /// Word to clear.
        pub clear_addr: U<8>,
        /// Counts a hit.
        pub tdc_valid: bool,
        /// Word of the hit.
        pub tdc_code: U<8>,
        /// Shows a word at `count`.
        pub read_en: bool,
        /// Word to show.
        pub read_addr: U<8>,
    }
}

/// The RAM. Too large to copy at every edge, so it is clocked in place.
#[derive(Clone, Debug, PartialEq)]
pub struct HistogramBuilder {
    /// Counts [hits].
    pub ram: Box<[U<16>; BINS]>,
}

impl Default for HistogramBuilder {
    fn default() -> Self {
        HistogramBuilder { ram: Box::new([U::new(0); BINS]) }
    }
}

impl Module for HistogramBuilder {
    const COUNT: usize = 0;

    /// The words of the RAM come after all registers (see [`crate::hierarchy`]).
    fn visit(&self, _: Option<&mut Self>, _: &mut impl Visitor) {}
}

impl HistogramBuilder {
    /// Output port `count`: the word at the address, zero while `read_en` is low.
    #[inline(always)]
    pub fn count(&self, i: &In) -> U<16> {
        if i.read_en { self.ram[address(i).index()] } else { U::new(0) }
    }

    /// The rising edge of `clk_125`.
    #[inline(always)]
    pub fn tick(&mut self, i: &In) {
        if i.clear || i.tdc_valid {
            let word = &mut self.ram[address(i).index()];
            *word = if i.clear { U::new(0) } else { *word + 1 };
        }
    }
}

#[inline(always)]
fn address(i: &In) -> U<8> {
    match (i.clear, i.tdc_valid) {
        (true, _) => i.clear_addr,
        (false, true) => i.tdc_code,
        (false, false) => i.read_addr,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const READ_9: In = In {
        clear: false,
        clear_addr: U::new(3),
        tdc_valid: false,
        tdc_code: U::new(9),
        read_en: true,
        read_addr: U::new(9),
    };

    #[test]
    fn equal_codes_back_to_back_both_count() {
        let mut histogram = HistogramBuilder::default();
        let hit = In { tdc_valid: true, ..READ_9 };
        histogram.tick(&hit);
        assert_eq!(histogram.count(&READ_9), 1);
        histogram.tick(&hit);
        assert_eq!(histogram.count(&READ_9), 2);
    }

    #[test]
    fn clear_goes_before_hit_and_hit_before_read() {
        let mut histogram = HistogramBuilder::default();
        histogram.ram[3] = U::new(70);
        histogram.ram[9] = U::new(5);
        histogram.tick(&In { clear: true, tdc_valid: true, ..READ_9 });
        assert_eq!((histogram.ram[3].get(), histogram.ram[9].get()), (0, 5));
        let hit_elsewhere = In { tdc_valid: true, tdc_code: U::new(3), ..READ_9 };
        assert_eq!(histogram.count(&hit_elsewhere), 0);
    }
}
