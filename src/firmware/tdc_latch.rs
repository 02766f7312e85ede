//! Says which taps are a shot's first hit.
//!
//! Mirrors `rtl_ref/tdc_latch.v`. A hit is tap 0 high now and low at the edge before, inside the
//! window, and only the first of a shot; a level held from before is none. Taps sampled at edge e
//! are here after e + 1, whether they are a hit or not: an enable that comes from tap 0 and has as
//! many loads as there are taps would be the slowest path of the device. While `free` is high every rise is a hit. At the edge that takes `start`, a hit of the shot
//! before may still be one (it is too late to have a code), and the new shot is unused.

use crate::kernel::{Clocked, asleep_if};
use crate::signals;

use super::carry_chain::Taps;
use super::coarse_counter::Coarse;

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// A shot begins.
        pub start: bool,
        /// A hit now belongs to the shot.
        pub window: bool,
        /// Every hit counts, whatever the shot.
        #[only_if(Calibrated)]
        pub free: bool,
        /// Coarse count, in step with the taps.
        #[size(CoarseBits)]
        pub coarse: Coarse,
        /// Taps sampled at the last edge.
        #[size(Taps)]
        pub taps: Taps,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct TdcLatch {
        /// `hit_taps` are a new hit; one cycle.
        #[view(heading = "TDC", probe = true)]
        pub hit: bool,
        /// Coarse count of the last hit.
        #[size(CoarseBits)]
        pub hit_coarse: Coarse,
        /// Taps sampled at the edge before.
        #[size(Taps)]
        pub hit_taps: Taps,
        /// The shot has had its hit.
        used: bool,
        /// Tap 0 at the edge before.
        tap_0_last: bool,
    }
}

impl TdcLatch {
    /// Returns whether the shot has had its hit, and tap 0 at the edge before.
    pub fn before(&self) -> (bool, bool) {
        (self.used, self.tap_0_last)
    }
}

impl Clocked for TdcLatch {
    type In = In;
    /// Place of physical tap 0 in the order of arrival.
    type Params = usize;

    #[inline(always)]
    fn tick(&mut self, i: &In, tap_0: &usize) {
        let tap_0 = i.taps.tap(*tap_0);
        let hit = tap_0 && !self.tap_0_last && (i.free || i.window && !self.used);
        let used = (self.used || hit) && !i.start;
        if hit {
            self.hit_coarse = i.coarse;
        }
        (self.hit, self.used, self.tap_0_last) = (hit, used, tap_0);
        if i.rst {
            *self = Self::default();
        }
        self.hit_taps = i.taps;
    }

    /// A hit is over with the next edge, and nobody looks at the taps of no hit.
    #[inline(always)]
    fn quiet(&self, i: &In, tap_0: &usize) -> u64 {
        let idle = i.taps.tap(*tap_0) == self.tap_0_last;
        asleep_if(idle && !(i.rst | (i.start & self.used)))
    }

    #[inline(always)]
    fn skip(&mut self, i: &In, _: &usize, edges: u64) {
        if edges > 0 {
            (self.hit, self.hit_taps) = (false, i.taps);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::carry_chain::TAPS;
    use super::*;

    const OPEN: In = In {
        rst: false,
        start: false,
        window: true,
        free: false,
        coarse: Coarse::new(2),
        taps: Taps::settled(false),
    };

    fn high(rank: usize) -> In {
        In { taps: Taps::new(true, [rank]), ..OPEN }
    }

    #[test]
    fn the_first_hit_of_a_shot_is_kept_and_the_second_is_not() {
        let first = TdcLatch::default().next(&high(40), &0);
        assert!(first.hit);
        assert_eq!((first.hit_coarse.get(), first.hit_taps.ones(TAPS)), (2, 40));
        let second = first.next(&OPEN, &0).next(&high(7), &0);
        assert!(!second.hit);
        assert_eq!(second.hit_taps.ones(TAPS), 7);
    }

    #[test]
    fn a_level_held_from_before_the_window_is_no_hit() {
        let high = In { taps: Taps::settled(true), ..OPEN };
        let held = TdcLatch::default().next(&In { window: false, ..high }, &0);
        assert!(!held.next(&high, &0).hit);
    }

    #[test]
    fn a_free_hit_needs_no_shot() {
        let free = |i: In| In { free: true, window: false, ..i };
        let first = TdcLatch::default().next(&free(high(40)), &0);
        let second = first.next(&free(OPEN), &0).next(&free(high(7)), &0);
        assert!(first.hit && second.hit);
        assert!(!second.next(&free(high(9)), &0).hit, "the same rise");
    }

    #[test]
    fn a_hit_at_the_edge_of_start_leaves_the_new_shot_unused() {
        let late = TdcLatch::default().next(&In { start: true, ..high(5) }, &0);
        assert!(late.hit);
        assert!(late.next(&OPEN, &0).next(&high(9), &0).hit);
    }
}
