//! Counts, the shots that wait at each bin, and the ambient hazard that they show.

use std::cmp::Ordering;
use std::ops::Range;

use crate::firmware::likelihood_estimator::words::{
    BLOCKS, LEAST_EXPOSURE, MOST_CHANCE, MOST_LEVEL,
};

use super::instrument::Instrument;
use super::number::Number;

/// By how many bits hits are shifted up to be divided.
const ENDED_LOG2: i64 = 16;
/// Initial ratio of ambient light to the echo: a 16th.
const ECHO_LOG2: i64 = 4;

/// A histogram as shots see it.
#[derive(Clone, Debug)]
pub struct Shots<'a, N> {
    /// Shots that end in each bin.
    ended: &'a [u32],
    /// Shots that wait when each bin begins.
    waiting: Vec<N>,
    /// Sum of the first.
    pub all_ended: N,
    /// Sum of the second, each times its bin's width [shots units].
    pub exposure: N,
}

/// A block of bins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block<N> {
    /// 64 log2 of the hazard that it shows [1 / unit].
    pub level: N,
    /// Shots that end in it.
    pub ended: N,
    /// Shots that wait in its bins, each times its bin's width [shots units].
    pub exposure: N,
}

/// Ambient light found in the blocks of bins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ambient<N> {
    /// All blocks.
    pub blocks: [Block<N>; BLOCKS],
    /// The block that is taken for ambient light alone.
    pub chosen: usize,
    /// `true` if no other block has shots left.
    pub lone: bool,
    /// Hazard of the chosen block [1 / unit, 30 fraction bits].
    pub hazard: N,
}

impl<'a, N: Number> Shots<'a, N> {
    /// Shots of a histogram.
    pub fn new(p: &impl Instrument<Number = N>, ended: &'a [u32]) -> Self {
        let shots = p.words().shots as i64;
        let mut left = shots;
        let mut wait = |&count: &u32| {
            let before = left.max(0);
            left -= i64::from(count);
            N::whole(before)
        };
        let waiting = ended.iter().map(&mut wait).collect();
        let all_ended = N::whole(shots - left);
        let mut shots = Shots { ended, waiting, all_ended, exposure: N::default() };
        shots.exposure = shots.exposure_of(p, 0..ended.len());
        shots
    }

    /// Shots that end in a bin.
    pub fn ended(&self, bin: usize) -> N {
        N::whole(self.ended[bin].into())
    }

    /// Shots that wait when a bin begins.
    pub fn waiting(&self, bin: usize) -> N {
        self.waiting[bin]
    }

    /// Shots that are left at the end of the window.
    pub fn left(&self) -> N {
        match (self.waiting.last(), self.ended.last()) {
            (Some(&waiting), Some(&ended)) if waiting > N::whole(ended.into()) => {
                waiting - N::whole(ended.into())
            }
            _ => N::default(),
        }
    }

    /// Number of bins.
    pub fn bins(&self) -> usize {
        self.ended.len()
    }

    /// Shots that wait in some bins, each times its bin's width [shots units].
    fn exposure_of(&self, p: &impl Instrument<Number = N>, bins: Range<usize>) -> N {
        bins.fold(N::default(), |sum, bin| sum + self.waiting[bin] * p.width(bin))
    }

    /// The hazard of ambient light: of eight blocks of bins, as far as shots are left, the one at 3/8
    /// of the order.
    pub fn ambient(&self, p: &impl Instrument<Number = N>) -> Ambient<N> {
        let length_of_block = self.bins() / BLOCKS;
        let block = |k: usize| {
            let bins = k * length_of_block..(k + 1) * length_of_block;
            let ended: i64 = self.ended[bins.clone()].iter().map(|&count| i64::from(count)).sum();
            let (ended, exposure) = (N::whole(ended), self.exposure_of(p, bins));
            Block { level: ended.log2_64() - exposure.log2_64(), ended, exposure }
        };
        let blocks: [_; BLOCKS] = std::array::from_fn(block);
        let least = blocks[0].exposure.log2_64() - N::whole(LEAST_EXPOSURE);
        let mut order: Vec<_> =
            (0..BLOCKS).filter(|&k| blocks[k].exposure.log2_64() > least).collect();
        order.sort_by(|&a, &b| {
            blocks[a].level.partial_cmp(&blocks[b].level).unwrap_or(Ordering::Equal)
        });
        let (chosen, lone) = (order[(order.len() - 1) * 3 / 8], order.len() == 1);
        let Block { ended, exposure, .. } = blocks[chosen];
        let most_hits = p.words().histogram.most_hits() as i64;
        let ended = ended.at_most(N::whole(most_hits));
        // Where all shots end in one block, the echo is in it.
        let ended = ended.floored(if lone { ECHO_LOG2 - ENDED_LOG2 } else { -ENDED_LOG2 });
        let (mantissa, bits) = exposure.at_least(N::whole(1)).reciprocal();
        // A chance in 64 units has 24 fraction bits where one in a unit has 30.
        let chance = (ended * mantissa).shifted(bits + 2);
        let hazard = N::hazard(chance.within([1, MOST_CHANCE].map(N::whole)));
        let hazard = hazard.within([1, MOST_LEVEL].map(N::whole));
        Ambient { blocks, chosen, lone, hazard }
    }
}
