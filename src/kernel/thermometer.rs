//! The state of a tapped delay line, kept as the ranks of the transitions travelling in it.

use std::ops::Range;

/// Transitions that a [`Thermometer`] can hold.
pub const CAPACITY: usize = 11;

/// Bits of a rank: lines have less than 2048 taps.
const BITS: usize = 11;

/// Bits below the ranks, of which the shape needs five.
const SHAPE_BITS: usize = 128 - CAPACITY * BITS;

/// The taps of a line, in order of arrival, that show the level which has reached them.
///
/// The input of the line alternates, so its taps are a few runs of ones and zeros. The newest
/// level fills the taps before the first rank, the opposite one the taps up to the second, and so
/// on: one word instead of a bit for each tap, and the ones count is an alternating sum. The form is
/// canonical (ranks strictly increasing, from 1 to one less than there are taps, unused ones zero), so
/// that equal taps compare equal. The caller knows the number of taps.
///
/// The lowest bits of the word are the shape: twice the number of transitions inside, and one more if the newest level
/// is high. A rank for each transition stands above it, the newest lowest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Thermometer(u128);

impl Thermometer {
    /// All taps at one level.
    #[inline(always)]
    pub const fn settled(level: bool) -> Self {
        Thermometer(level as u128)
    }

    /// The taps when the line's input is now at `level` and its last transitions, newest first,
    /// have reached `ranks` taps each (0 = none yet), fewer than there are. Transitions beyond
    /// [`CAPACITY`] are not seen; the caller's limits keep them from being there.
    pub fn new(level: bool, ranks: impl IntoIterator<Item = usize>) -> Self {
        let mut taps = Self::settled(level);
        ranks.into_iter().for_each(|rank| taps.push(rank));
        taps
    }

    /// Creates a line of `count` taps, of which a rank may be all or more: such a transition has passed.
    pub fn clipped(count: usize, level: bool, ranks: impl IntoIterator<Item = usize>) -> Self {
        Self::new(level, ranks.into_iter().take_while(|&rank| rank < count))
    }

    /// The taps when the line's input is now at `level` and its last transition has reached `rank`
    /// of them, fewer than there are, and the ones before all.
    #[inline(always)]
    pub const fn single(level: bool, rank: usize) -> Self {
        match rank {
            0 => Self::settled(!level),
            _ => Thermometer(placed(rank, 0) + 2 + level as u128),
        }
    }

    /// Adds an older transition than those inside, which has reached `rank` taps, fewer than
    /// there are.
    #[inline(always)]
    pub fn push(&mut self, rank: usize) {
        let len = self.len();
        if rank == 0 {
            self.0 ^= 1;
        } else if len > 0 && self.rank(len - 1) == rank {
            self.0 -= placed(rank, len - 1) + 2;
        } else if len < CAPACITY {
            self.0 += placed(rank, len) + 2;
        }
    }

    /// Returns whether no transition is inside.
    #[inline(always)]
    pub const fn is_settled(&self) -> bool {
        self.shape() < 2
    }

    /// Returns whether all taps are at that level.
    #[inline(always)]
    pub const fn is_settled_at(&self, level: bool) -> bool {
        self.0 == level as u128
    }

    /// The level of the tap that is `position`-th to be reached, from 0.
    #[inline(always)]
    pub fn tap(&self, position: usize) -> bool {
        if self.is_settled() || self.rank(0) > position {
            return self.level();
        }
        let passed = self.ranks().take_while(|&rank| rank <= position).count();
        self.level() ^ (passed % 2 == 1)
    }

    /// Returns how many of `count` taps are high.
    #[inline]
    pub fn ones(&self, count: usize) -> usize {
        let (mut ones, mut start, mut level) = (0, 0, self.level());
        for rank in self.ranks() {
            if level {
                ones += rank - start;
            }
            (start, level) = (rank, !level);
        }
        if level { ones + count - start } else { ones }
    }

    /// The runs of high ones among `count` taps, in order of arrival.
    pub fn high_runs(&self, count: usize) -> impl Iterator<Item = Range<usize>> {
        let ends = self.ranks().chain([count]);
        let runs = ends.scan((0, self.level()), |(start, level), end| {
            let run = level.then_some(*start..end);
            (*start, *level) = (end, !*level);
            Some(run)
        });
        runs.flatten()
    }

    /// Writes `count` taps as bits, in order of arrival, into words that have as many bits or a few more: least
    /// significant first, with zeros past the last tap.
    pub fn expand(&self, count: usize, words: &mut [u64]) {
        words.fill(if self.level() { u64::MAX } else { 0 });
        for rank in self.ranks() {
            words[rank / 64] ^= u64::MAX << (rank % 64);
            words[rank / 64 + 1..].iter_mut().for_each(|word| *word = !*word);
        }
        if let Some(last) = words.last_mut() {
            *last &= u64::MAX >> (count.wrapping_neg() % 64);
        }
    }

    #[inline(always)]
    fn level(&self) -> bool {
        self.0 % 2 == 1
    }

    /// Returns how many transitions are inside.
    #[inline(always)]
    const fn len(&self) -> usize {
        self.shape() / 2
    }

    #[inline(always)]
    const fn shape(&self) -> usize {
        self.0 as usize & ((1 << SHAPE_BITS) - 1)
    }

    /// The rank of the `nth` newest transition.
    #[inline(always)]
    const fn rank(&self, nth: usize) -> usize {
        (self.0 >> (SHAPE_BITS + BITS * nth)) as usize & ((1 << BITS) - 1)
    }

    #[inline(always)]
    fn ranks(&self) -> impl Iterator<Item = usize> + use<> {
        let mut above = self.0 >> SHAPE_BITS;
        (0..self.len()).map(move |_| {
            let rank = above as usize & ((1 << BITS) - 1);
            above >>= BITS;
            rank
        })
    }
}

/// A rank where that of the `nth` newest transition stands.
#[inline(always)]
const fn placed(rank: usize, nth: usize) -> u128 {
    (rank as u128) << (SHAPE_BITS + BITS * nth)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits(taps: &Thermometer) -> String {
        let mut words = [0];
        taps.expand(12, &mut words);
        (0..64).map(|tap| if words[0] >> tap & 1 == 1 { '1' } else { '0' }).take(12).collect()
    }

    #[test]
    fn a_pulse_travels_as_two_ranks() {
        let taps = Thermometer::new(false, [3, 8]);
        assert_eq!(bits(&taps), "000111110000");
        assert_eq!(taps.ones(12), 5);
        assert!(!taps.tap(2) && taps.tap(3) && taps.tap(7) && !taps.tap(8));
    }

    #[test]
    fn a_transition_that_has_reached_no_tap_is_not_seen() {
        assert_eq!(Thermometer::new(true, [0, 4]), Thermometer::new(false, [4]));
        assert_eq!(Thermometer::new(true, [0]), Thermometer::settled(false));
    }

    #[test]
    fn a_transition_past_the_end_leaves_the_line_settled() {
        assert_eq!(Thermometer::clipped(12, true, [12]), Thermometer::settled(true));
        assert_eq!(Thermometer::clipped(12, false, [5, 12, 14]), Thermometer::new(false, [5]));
    }

    #[test]
    fn a_settled_line_is_all_ones_or_none() {
        assert_eq!(Thermometer::settled(true).ones(12), 12);
        assert_eq!(Thermometer::settled(false).ones(12), 0);
    }

    #[test]
    fn two_transitions_between_the_same_taps_cancel() {
        assert_eq!(Thermometer::new(true, [4, 4, 9]), Thermometer::new(true, [9]));
        assert_eq!(bits(&Thermometer::new(true, [4, 4])), "111111111111");
    }

    #[test]
    fn ones_agree_with_the_bits() {
        for code in 0..12usize.pow(3) {
            let ranks = [code % 12, code / 12 % 12, code / 144];
            if ranks.is_sorted() {
                let taps = Thermometer::new(code % 5 > 2, ranks);
                assert_eq!(taps.ones(12), bits(&taps).matches('1').count(), "{ranks:?}");
                let mut high = ['0'; 12];
                taps.high_runs(12).for_each(|run| high[run].fill('1'));
                assert_eq!(String::from_iter(high), bits(&taps));
            }
        }
    }
}
