//! Reciprocals and roots, a bit in each cycle.

use crate::kernel::U;

use super::Registers;

/// Bits of a reciprocal, and of a root.
const RECIPROCAL_BITS: u64 = 17;
/// Bits of a root.
const ROOT_BITS: u64 = 25;

impl Registers {
    /// A bit of a reciprocal or of a root, which takes two bits of the product each time.
    pub(super) fn divide(&self, d: &mut Self) {
        let last = self.digit == if self.roots { ROOT_BITS } else { RECIPROCAL_BITS };
        d.dividing = self.at[6] && self.divides || self.dividing && !last;
        d.divided = self.dividing && last;
        if self.divided && self.roots {
            d.bits = U::new((10 + self.bits.get() + self.exponent.get() + self.odd()) / 2);
        }
        let pairs = (self.product.get() as u64 & ((1 << 34) - 1)) << self.odd();
        d.pair = U::new(pairs.checked_shl(2 * self.digit.get() as u32).unwrap_or(0) >> 32);
        d.digit = U::new(match (self.at[6], self.dividing) {
            (true, _) => 1,
            (_, true) => self.digit.get() + 1,
            _ => 0,
        });
        if self.at[6] {
            d.remainder = U::new(if self.roots { 0 } else { (1 << 16) - 1 });
            d.quotient = U::new(0);
            return;
        }
        if !self.dividing {
            return;
        }
        let (left, against) = match self.roots {
            true => (self.remainder.get() << 2 | self.pair.get(), self.quotient.get() << 2 | 1),
            false => {
                let divisor = self.shifted.get() as u64 & U::<28>::MAX.get();
                (self.remainder.get() << 1 | 1, divisor)
            }
        };
        let left = U::<28>::new(left).get();
        let fits = left >= against;
        d.remainder = U::new(if fits { left - against } else { left });
        d.quotient = U::new(self.quotient.get() << 1 | u64::from(fits));
    }

    /// Whether a variance's exponent is odd.
    fn odd(&self) -> u64 {
        (self.bits.get() + self.exponent.get()) & 1
    }
}
