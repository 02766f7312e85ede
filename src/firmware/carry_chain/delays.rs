//! When a transition reaches each tap.

use std::ops::RangeInclusive;

use crate::kernel::{Thermometer, Time};

/// Length of the KC705's chain: 200 CARRY4 [taps].
pub const TAPS: usize = 800;
/// Shortest and longest chain [taps].
pub const LENGTHS: RangeInclusive<usize> = 16..=2000;

/// The taps, as registers.
pub type Taps = Thermometer;

/// The delays of a chain: what its placement decides.
#[derive(Clone, Debug, PartialEq)]
pub struct Delays {
    /// When each tap is reached, in order of arrival, from the transition of `tdc_stop`.
    arrivals: Vec<Time>,
    /// Physical tap at each place of that order.
    order: Vec<u16>,
    /// Age at which a transition has reached every tap.
    longest: Time,
    /// When the transition leaves the last tap.
    end: Time,
    /// For each [`CELL`] of age, how many taps are reached at its begin.
    guide: Vec<u16>,
}

/// Ages that share an entry of the guide, as a power of two: about a tap [fs].
const CELL: u32 = 13;

impl Delays {
    /// From the delay before the first tap and the delay of each tap [fs]. A negative
    /// delay is legal as long as every tap is reached after `tdc_stop` changes: real chains are
    /// not monotonic, because of carry look-ahead and clock skew.
    ///
    /// Returns `None` if there are not as many taps as a chain can have ([`LENGTHS`]), or if one is reached
    /// at time 0 or before.
    pub fn new(offset: Time, tap_delays_fs: &[i64]) -> Option<Self> {
        let mut at = i64::try_from(offset.fs()).ok()?;
        if !LENGTHS.contains(&tap_delays_fs.len()) {
            return None;
        }
        let mut reached = Vec::with_capacity(tap_delays_fs.len());
        for (tap, delay) in tap_delays_fs.iter().enumerate() {
            reached.push((at, tap as u16));
            at = at.checked_add(*delay)?;
        }
        reached.sort();
        let longest = reached.last()?.0;
        let end = at.max(longest);
        if reached[0].0 <= 0 {
            return None;
        }
        let arrivals: Vec<_> = reached.iter().map(|&(at, _)| Time::from_fs(at as u64)).collect();
        let longest = Time::from_fs(longest as u64);
        let cells = 0..=longest.fs() >> CELL;
        let begins = cells.map(|cell| Time::from_fs(cell << CELL));
        Some(Delays {
            guide: begins.map(|age| arrivals.partition_point(|&at| at < age) as u16).collect(),
            longest,
            arrivals,
            order: reached.iter().map(|&(_, tap)| tap).collect(),
            end: Time::from_fs(end as u64),
        })
    }

    /// A chain of as many taps, all alike and in order, that begins and ends when this one does.
    pub fn evened(&self) -> Self {
        let (taps, begin, end) = (self.taps() as u64, self.arrivals[0].fs(), self.end.fs());
        let at = |tap: u64| begin + ((end - begin) * tap + taps / 2) / taps;
        let delays: Vec<_> = (0..taps).map(|tap| (at(tap + 1) - at(tap)) as i64).collect();
        Delays::new(Time::from_fs(begin), &delays).unwrap_or_else(|| self.clone())
    }

    /// Returns the chain with every delay so many times as long; `None` if a tap would be reached at time 0.
    pub fn stretched(&self, factor: f64) -> Option<Self> {
        let stretched = |at: Time| (at.fs() as f64 * factor).round() as i64;
        let mut reached = vec![stretched(self.end); self.taps() + 1];
        for (&tap, &at) in self.order.iter().zip(&self.arrivals) {
            reached[tap as usize] = stretched(at);
        }
        let delays: Vec<_> = reached.windows(2).map(|pair| pair[1] - pair[0]).collect();
        Delays::new(Time::from_fs(u64::try_from(reached[0]).ok()?), &delays)
    }

    /// Length of the chain [taps].
    #[inline]
    pub fn taps(&self) -> usize {
        self.arrivals.len()
    }

    /// Returns how many taps a transition of that age has reached.
    #[inline]
    pub fn rank(&self, age: Time) -> usize {
        if age >= self.longest { self.taps() } else { self.rank_inside(age) }
    }

    /// Returns the rank of a transition that has not reached every tap.
    #[inline(always)]
    pub(super) fn rank_inside(&self, age: Time) -> usize {
        let mut rank = self.guide[(age.fs() >> CELL) as usize] as usize;
        // Most cells hold one arrival or none.
        rank += (self.arrivals[rank] <= age) as usize;
        while self.arrivals[rank] <= age {
            rank += 1;
        }
        rank
    }

    /// When each tap is reached, in order of arrival, from the transition of `tdc_stop`.
    pub fn arrivals(&self) -> &[Time] {
        &self.arrivals
    }

    /// Physical tap at each place in the order of arrival.
    pub fn order(&self) -> &[u16] {
        &self.order
    }

    /// Age at which a transition has reached every tap.
    #[inline]
    pub fn longest(&self) -> Time {
        self.longest
    }

    /// From physical tap 0 until a transition has left the last tap: the ages that the ranks tell apart.
    pub fn span(&self) -> Time {
        self.end.since(self.tap_0())
    }

    /// Age at which a transition reaches physical tap 0, where hits are detected.
    pub fn tap_0(&self) -> Time {
        self.arrivals[self.tap_0_position()]
    }

    /// Place of physical tap 0 in the order of arrival.
    pub fn tap_0_position(&self) -> usize {
        self.order.iter().position(|&tap| tap == 0).unwrap_or(0)
    }

    /// Age at which `n` taps have been reached; past the last, that at which the hit has left the chain.
    pub fn boundary(&self, n: usize) -> Time {
        *self.arrivals.get(n).unwrap_or(&self.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniform(tap_fs: i64, offset_ps: u64) -> Delays {
        Delays::new(Time::from_fs(offset_ps * 1000), &[tap_fs; TAPS]).unwrap()
    }

    #[test]
    fn an_arrival_at_the_edge_counts() {
        let delays = uniform(11_500, 2_230);
        assert_eq!(delays.rank(Time::from_fs(2_229_999)), 0);
        assert_eq!(delays.rank(Time::from_fs(2_230_000)), 1);
        assert_eq!(delays.rank(Time::from_fs(2_241_499)), 1);
        assert_eq!(delays.rank(Time::from_fs(2_241_500)), 2);
    }

    #[test]
    fn the_rank_is_the_number_of_arrivals_at_every_boundary() {
        let uneven: Vec<_> = (0..TAPS as i64).map(|tap| (tap * 7919 % 41 - 9) * 1_000).collect();
        for delays in [uniform(11_500, 2_230), Delays::new(Time::from_ns(3), &uneven).unwrap()] {
            for age in delays.arrivals.iter().flat_map(|at| [at.fs() - 1, at.fs(), at.fs() + 1]) {
                let counted = delays.arrivals.iter().filter(|at| at.fs() <= age).count();
                assert_eq!(delays.rank(Time::from_fs(age)), counted);
            }
            assert_eq!(delays.rank(Time::from_ns(1_000_000)), TAPS);
        }
    }

    #[test]
    fn taps_may_be_reached_out_of_order() {
        let mut tap_delays = [10_000; TAPS];
        tap_delays[0] = 25_000;
        tap_delays[1] = -5_000;
        let delays = Delays::new(Time::from_ns(2), &tap_delays).unwrap();
        assert_eq!(delays.order()[..4], [0, 2, 1, 3]);
        assert_eq!(delays.rank(Time::from_fs(2_020_000)), 2);
    }

    #[test]
    fn a_stretched_chain_is_reached_in_the_same_order_so_many_times_as_late() {
        let uneven: Vec<_> = (0..TAPS as i64).map(|tap| (tap * 7919 % 41 - 9) * 1_000).collect();
        let delays = Delays::new(Time::from_ns(3), &uneven).unwrap();
        assert_eq!(delays.stretched(1.0).as_ref(), Some(&delays));
        let twice = delays.stretched(2.0).unwrap();
        assert_eq!(twice.order(), delays.order());
        for n in 0..=TAPS {
            assert_eq!(twice.boundary(n).fs(), 2 * delays.boundary(n).fs());
        }
        assert_eq!(delays.stretched(0.0), None);
    }

    #[test]
    fn a_tap_before_the_transition_is_refused() {
        assert_eq!(Delays::new(Time::ZERO, &[10_000; TAPS]), None);
        assert_eq!(Delays::new(Time::from_ns(2), &[10_000; 15]), None);
        assert_eq!(Delays::new(Time::from_ns(2), &[10_000; 2001]), None);
        let mut tap_delays = [10_000; TAPS];
        tap_delays[5] = -3_000_000;
        assert_eq!(Delays::new(Time::from_ns(2), &tap_delays), None);
    }
}
