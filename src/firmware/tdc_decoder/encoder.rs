//! Encoder of the decoder: the number `n` that it makes of the taps.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::firmware::carry_chain::{Delays, Taps};

/// Rule by which a decoder converts taps to `n`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Decoder {
    /// Counts the ones, wherever they are.
    #[default]
    Ones,
    /// Finds the highest tap that is one, and leaves zeros below it aside.
    Leading,
    /// Puts the taps in the order in which a transition reaches them, and finds the highest that is one.
    Reordered,
}

impl Decoder {
    /// All of them, in the order of their numbers in Verilog.
    pub const ALL: [Decoder; 3] = [Decoder::Ones, Decoder::Leading, Decoder::Reordered];

    /// As a scenario has it.
    pub fn name(self) -> &'static str {
        match self {
            Decoder::Ones => "ones",
            Decoder::Leading => "leading",
            Decoder::Reordered => "reordered",
        }
    }
}

/// A decoder of the taps of one chain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Encoder {
    decoder: Decoder,
    /// Physical tap at each place in the order of arrival.
    order: Vec<u16>,
    /// For each number of taps that a single transition has reached, one more than the highest of them.
    highest: Vec<u16>,
}

impl Encoder {
    /// Of a chain with such delays.
    pub fn new(decoder: Decoder, delays: &Delays) -> Self {
        Encoder::of_order(decoder, delays.order())
    }

    /// Of a chain whose taps are reached in that order.
    pub fn of_order(decoder: Decoder, order: &[u16]) -> Self {
        let rising = order.iter().scan(0, |highest, tap| {
            *highest = tap.saturating_add(1).max(*highest);
            Some(*highest)
        });
        let highest = std::iter::once(0).chain(rising).collect();
        Encoder { decoder, order: order.to_vec(), highest }
    }

    /// Returns its decoder.
    #[inline(always)]
    pub fn decoder(&self) -> Decoder {
        self.decoder
    }

    /// Physical tap at each place in the order of arrival.
    pub fn order(&self) -> &[u16] {
        &self.order
    }

    /// `n` where a single transition has reached so many taps; it never falls as they become more.
    #[inline(always)]
    pub fn of_rank(&self, rank: usize) -> usize {
        match self.decoder {
            Decoder::Leading => self.highest[rank].into(),
            Decoder::Ones | Decoder::Reordered => rank,
        }
    }

    /// `n` of any of `count` taps, with pulses travelling in them or not.
    #[inline(always)]
    pub fn of_taps(&self, taps: &Taps, count: usize) -> usize {
        match self.decoder {
            Decoder::Ones => taps.ones(count),
            Decoder::Leading | Decoder::Reordered => self.highest_of(taps, count),
        }
    }

    /// One more than the highest tap that is one, in the decoder's order.
    #[inline(never)]
    fn highest_of(&self, taps: &Taps, count: usize) -> usize {
        if self.decoder == Decoder::Reordered {
            return taps.high_runs(count).last().map_or(0, |run| run.end);
        }
        let highest = |run: std::ops::Range<usize>| match run.start {
            // What a transition is known to have reached.
            0 => self.highest[run.end],
            _ => self.order[run].iter().max().map_or(0, |tap| tap + 1),
        };
        taps.high_runs(count).map(highest).max().unwrap_or(0).into()
    }

    /// Returns whether a single transition can have that `n`: with `leading` a tap that is reached before the
    /// one below it hides that one.
    pub fn occurs(&self, n: usize) -> bool {
        self.decoder != Decoder::Leading || self.highest.binary_search(&(n as u16)).is_ok()
    }

    /// The least number of taps at which a single transition has that `n` or more; one more than there are
    /// taps, if none has.
    pub fn least_rank(&self, n: usize) -> usize {
        match self.decoder {
            Decoder::Leading => self.highest.partition_point(|&highest| usize::from(highest) < n),
            Decoder::Ones | Decoder::Reordered => n,
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::seq::SliceRandom;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// By the levels one by one.
    fn naive(decoder: Decoder, order: &[u16], taps: &Taps) -> usize {
        let mut physical = vec![false; order.len()];
        for (place, &tap) in order.iter().enumerate() {
            physical[usize::from(tap)] = taps.tap(place);
        }
        let arrived: Vec<_> = order.iter().map(|&tap| physical[usize::from(tap)]).collect();
        let highest =
            |levels: &[bool]| levels.iter().rposition(|&level| level).map_or(0, |at| at + 1);
        match decoder {
            Decoder::Ones => physical.iter().filter(|&&level| level).count(),
            Decoder::Leading => highest(&physical),
            Decoder::Reordered => highest(&arrived),
        }
    }

    /// Orders of 40 taps: physical, by CARRY4, and any.
    fn orders(random: &mut ChaCha8Rng) -> [Vec<u16>; 3] {
        let physical: Vec<u16> = (0..40).collect();
        let by_four = physical.iter().map(|tap| tap / 4 * 4 + [3, 1, 2, 0][usize::from(tap % 4)]);
        let mut any = physical.clone();
        any.shuffle(random);
        [physical.clone(), by_four.collect(), any]
    }

    #[test]
    fn a_decoder_makes_of_pulses_what_the_levels_one_by_one_say() {
        let (mut random, mut shuffles) =
            (ChaCha8Rng::seed_from_u64(1), ChaCha8Rng::seed_from_u64(3));
        for order in [0; 20].into_iter().flat_map(|_: u8| orders(&mut shuffles)) {
            for decoder in Decoder::ALL {
                let encoder = Encoder::of_order(decoder, &order);
                for _ in 0..40 {
                    let mut ranks: Vec<_> = (0..random.random_range(0..6))
                        .map(|_| random.random_range(0..40))
                        .collect();
                    ranks.sort();
                    let taps = Taps::new(random.random(), ranks);
                    assert_eq!(
                        encoder.of_taps(&taps, 40),
                        naive(decoder, &order, &taps),
                        "{taps:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_single_transition_s_number_never_falls_and_the_least_rank_leads_back() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        for order in orders(&mut random) {
            for decoder in Decoder::ALL {
                let encoder = Encoder::of_order(decoder, &order);
                let numbers: Vec<_> = (0..=40).map(|rank| encoder.of_rank(rank)).collect();
                assert!(numbers.is_sorted(), "{numbers:?}");
                for (rank, &n) in numbers.iter().enumerate().take(40) {
                    assert_eq!(n, naive(decoder, &order, &Taps::single(true, rank)));
                }
                for n in 0..=40 {
                    let least = numbers.iter().position(|&own| own >= n);
                    assert_eq!(Some(encoder.least_rank(n)), least);
                    assert_eq!(encoder.occurs(n), numbers.contains(&n));
                }
                assert_eq!(encoder.of_rank(40), 40);
            }
        }
    }
}
