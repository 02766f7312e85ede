//! Counts the cycles of a shot, and closes the TDC's window after all that it can count.
//!
//! Mirrors `rtl_ref/coarse_counter.v`. `start` is high in cycle s of the laser edge; `coarse` is 0
//! in cycle s + 1, in step with the taps sampled at that edge.

use crate::kernel::{Clocked, U, asleep_if};
use crate::signals;

/// A count of the cycles of a shot, with room for the widest.
pub type Coarse = U<12>;
/// Narrowest and widest count [bits].
pub const COARSE_BITS: std::ops::RangeInclusive<u32> = 1..=12;

/// Width of the KC705's coarse count [bits].
pub const DEFAULT_COARSE_BITS: u32 = 3;

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// A shot begins.
        pub start: bool,
    }
}

signals! {
    /// Registers, all output ports.
    pub struct CoarseCounter {
        /// Whole cycles from the laser edge to the edge before the last.
        #[size(CoarseBits)]
        #[view(heading = "TDC", probe = true)]
        pub coarse: Coarse,
        /// A hit now belongs to the shot.
        pub window: bool,
    }
}

/// Verilog parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Params {
    /// Width of the count: the window has as many cycles as it can count [bits].
    pub coarse_bits: u32,
}

impl Params {
    /// Cycles of the window, two to the width.
    pub const fn window(self) -> u64 {
        1 << self.coarse_bits
    }
}

impl Clocked for CoarseCounter {
    type In = In;
    type Params = Params;

    #[inline(always)]
    fn tick(&mut self, i: &In, p: &Params) {
        let (q, d) = (*self, self);
        if i.start {
            *d = CoarseCounter { coarse: U::new(0), window: true };
        } else if q.window && q.coarse == p.window() - 1 {
            d.window = false;
        } else if q.window {
            d.coarse = q.coarse + 1;
        }
        if i.rst {
            *d = Self::default();
        }
    }

    /// Nobody looks at the count and its end but at a hit.
    #[inline(always)]
    fn quiet(&self, i: &In, _: &Params) -> u64 {
        asleep_if(!(i.start || i.rst))
    }

    #[inline(always)]
    fn skip(&mut self, _: &In, p: &Params, edges: u64) {
        if self.window {
            let left = p.window() - 1 - self.coarse.get();
            self.coarse = self.coarse + edges.min(left);
            self.window = edges <= left;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_is_as_long_as_the_count_can_tell() {
        for (coarse_bits, cycles) in [(1, 2), (3, 8), (12, 4096)] {
            let mut counter = CoarseCounter::default();
            for cycle in 0..cycles + 4 {
                let i = In { rst: false, start: cycle == 0 };
                counter = counter.next(&i, &Params { coarse_bits });
                let expected = (cycle < cycles).then_some(cycle);
                assert_eq!(counter.window.then_some(counter.coarse.get()), expected);
            }
        }
    }

    #[test]
    fn a_new_start_reopens_it_at_zero() {
        let running = CoarseCounter { coarse: U::new(5), window: true };
        let restarted = running.next(&In { rst: false, start: true }, &Params { coarse_bits: 3 });
        assert_eq!(restarted, CoarseCounter { coarse: U::new(0), window: true });
    }
}
