//! Counts the cycles of a shot, and closes the TDC's window after eight (64 ns).
//!
//! Mirrors `rtl_ref/coarse_counter.v`. `start` is high in cycle s of the laser edge; `coarse` is 0
//! in cycle s + 1, in step with the taps sampled at that edge.

use crate::kernel::{Clocked, U, asleep_if};
use crate::signals;

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
        #[view(heading = "TDC", probe = true)]
        pub coarse: U<3>,
        /// A hit now belongs to the shot.
        pub window: bool,
    }
}

impl Clocked for CoarseCounter {
    type In = In;
    type Params = ();

    #[inline(always)]
    fn next(&self, i: &In, (): &()) -> Self {
        let (q, mut d) = (self, *self);
        if i.start {
            d = CoarseCounter { coarse: U::new(0), window: true };
        } else if q.window && q.coarse == U::MAX {
            d.window = false;
        } else if q.window {
            d.coarse = q.coarse + 1;
        }
        if i.rst { Self::default() } else { d }
    }

    /// Nobody looks at the count and its end but at a hit.
    #[inline(always)]
    fn quiet(&self, i: &In, (): &()) -> u64 {
        asleep_if(!(i.start || i.rst))
    }

    #[inline(always)]
    fn skip(&mut self, _: &In, (): &(), edges: u64) {
        if self.window {
            let left = U::<3>::MAX.get() - self.coarse.get();
            self.coarse = self.coarse + edges.min(left);
            self.window = edges <= left;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_is_eight_cycles_long() {
        let mut counter = CoarseCounter::default();
        let open: Vec<_> = (0..12)
            .map(|cycle| {
                counter = counter.next(&In { rst: false, start: cycle == 0 }, &());
                counter.window.then_some(counter.coarse.get())
            })
            .collect();
        let expected: Vec<_> = (0..12).map(|coarse| (coarse < 8).then_some(coarse)).collect();
        assert_eq!(open, expected);
    }

    #[test]
    fn a_new_start_reopens_it_at_zero() {
        let running = CoarseCounter { coarse: U::new(5), window: true };
        let restarted = running.next(&In { rst: false, start: true }, &());
        assert_eq!(restarted, CoarseCounter { coarse: U::new(0), window: true });
    }
}
