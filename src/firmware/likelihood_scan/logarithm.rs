//! The unit that takes logarithms, four cycles from a number on.

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::pipeline::shift;
use crate::firmware::likelihood_estimator::tables::LOG2;
use crate::kernel::{S, U};

use super::{In, Registers};

/// Bits that are kept of a number whose logarithm is taken, of which the upper 16 have its leading one.
const TOP_BITS: u32 = 22;

impl Registers {
    /// The unit that takes logarithms.
    pub(super) fn log(&self, i: &In, p: &Params, d: &mut Self) {
        let value = match (i.scan, i.block_done, i.phase) {
            (false, true, _) => i.block_ended.get(),
            (false, false, _) => self.held_exposure.get(),
            // That of a negative one is of no use.
            (true, _, false) => {
                let bits = p.histogram.count_bits + p.histogram.bins.ilog2() + 14;
                self.excess[0].get() as u64 & (u64::MAX >> (64 - bits))
            }
            (true, _, true) => self.held_expected.get(),
        };
        d.log_number = U::new(value);
        let number = self.log_number.get();
        let high = number.max(1).ilog2() / 16;
        d.log_value = U::new(number << (48 - 16 * high) >> (u64::BITS - TOP_BITS));
        d.log_high = U::new(high.into());
        let value = self.log_value.get();
        let middle = (value >> (TOP_BITS - 16)).max(1).ilog2() / 4;
        d.log_mantissa = U::new(value << (12 - 4 * middle));
        d.log_middle = U::new(self.log_high.get() * 4 + u64::from(middle));
        shift(&mut d.log_expected, i.scan && i.phase);
        let value = self.log_mantissa.get();
        let low = (value >> (TOP_BITS - 4)).max(1).ilog2();
        let aligned = value << (3 - low) >> (TOP_BITS - 7);
        let log = match value {
            0 if !self.log_expected[2] => -64,
            _ => {
                (self.log_middle.get() as i64 * 4 + i64::from(low)) * 64
                    + LOG2[(aligned & 63) as usize]
            }
        };
        if if i.scan { i.phase } else { self.block[2] } {
            d.upper_log = S::new(log);
        }
        if if i.scan { !i.phase } else { self.block[3] } {
            d.lower_log = S::new(log);
        }
    }
}
