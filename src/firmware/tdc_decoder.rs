//! Turns a hit into a code of 25 ps.
//!
//! Mirrors `rtl_ref/tdc_decoder.v`. Two stages, the ones count and the time:
//!
//! ```text
//! edge       e+1        e+2              e+3
//! register   hit_taps   n = ones count   tdc_code = t >> 4
//!                                        t = 5120 (coarse + 1) - cal[n]   [25/16 ps]
//! ```
//!
//! A time outside 0 .. 4095 has no code, and `tdc_code` keeps its value.

use crate::kernel::{Clocked, S, U, asleep_if};
use crate::signals;

pub use super::carry_chain::Calibration;
use super::carry_chain::Taps;

/// One cycle of `clk_125` [25/16 ps].
pub const CYCLE: i64 = 5120;
/// Time codes in a bin of 25 ps, as a shift.
const BIN_SHIFT: u32 = 4;
/// First time past the last bin, 6.4 ns [25/16 ps].
const RANGE: i64 = 256 << BIN_SHIFT;

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// A new hit is kept.
        pub hit: bool,
        /// Its coarse count.
        pub hit_coarse: U<3>,
        /// Its taps.
        pub hit_taps: Taps,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct TdcDecoder {
        /// `tdc_code` is new; one cycle.
        pub tdc_valid: bool,
        /// Time from the laser edge to the hit [25 ps].
        pub tdc_code: U<8>,
        /// `n` is new.
        n_valid: bool,
        /// Taps the hit had run through.
        #[view(heading = "TDC", probe = true)]
        n: U<10>,
        /// Coarse count of `n`.
        n_coarse: U<3>,
    }
}

impl TdcDecoder {
    /// The hit in the second stage: ones count and coarse count.
    pub fn decoding(&self) -> Option<(u64, u64)> {
        self.n_valid.then_some((self.n.get(), self.n_coarse.get()))
    }
}

/// The code of a hit, if its time is in range.
#[inline(always)]
pub fn code(coarse: u64, n: usize, cal: &Calibration) -> Option<U<8>> {
    let t = S::<17>::new(CYCLE * (coarse as i64 + 1) - cal[n].get() as i64).get();
    (0..RANGE).contains(&t).then(|| U::new(t as u64 >> BIN_SHIFT))
}

impl Clocked for TdcDecoder {
    type In = In;
    type Params = Calibration;

    #[inline(always)]
    fn next(&self, i: &In, cal: &Calibration) -> Self {
        let (q, mut d) = (self, *self);
        d.n_valid = i.hit;
        if i.hit {
            (d.n, d.n_coarse) = (U::new(i.hit_taps.ones() as u64), i.hit_coarse);
        }
        d.tdc_valid = false;
        if q.n_valid
            && let Some(code) = code(q.n_coarse.get(), q.n.index(), cal)
        {
            (d.tdc_valid, d.tdc_code) = (true, code);
        }
        if i.rst { Self::default() } else { d }
    }

    #[inline(always)]
    fn quiet(&self, i: &In, _: &Calibration) -> u64 {
        asleep_if(!(i.rst | i.hit | self.n_valid | self.tdc_valid))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::carry_chain::TAPS;

    fn decode(coarse: u64, n: usize, cal: &Calibration) -> (bool, u64) {
        let hit = In {
            rst: false,
            hit: true,
            hit_coarse: U::new(coarse),
            hit_taps: Taps::new(true, [n]),
        };
        let idle = In { hit: false, ..hit };
        let decoded = TdcDecoder::default().next(&hit, cal).next(&idle, cal);
        (decoded.tdc_valid, decoded.tdc_code.get())
    }

    #[test]
    fn the_time_is_the_edge_less_the_calibrated_delay() {
        let mut cal = [U::new(0); TAPS + 1];
        cal[100] = U::new(5120);
        cal[101] = U::new(5119);
        cal[102] = U::new(5121);
        cal[103] = U::new(5120 - 4095);
        cal[104] = U::new(5120 - 4096);
        assert_eq!(decode(0, 100, &cal), (true, 0));
        assert_eq!(decode(0, 101, &cal), (true, 0));
        assert_eq!(decode(0, 102, &cal), (false, 0), "before the laser edge");
        assert_eq!(decode(0, 103, &cal), (true, 255));
        assert_eq!(decode(0, 104, &cal), (false, 0), "past the range");
        assert_eq!(decode(7, 100, &cal), (false, 0), "a late cycle");
    }
}
