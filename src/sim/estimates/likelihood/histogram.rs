//! Counts, the shots that wait at each bin, and the ambient hazard that they show.

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::tables::{log2_64, reciprocal};

use super::arithmetic::shifted;

/// Blocks that the window is divided in to find the ambient hazard.
pub const BLOCKS: usize = 8;
/// A block counts with a 64th of the first one's exposure, in 64ths of powers of two.
const LEAST_EXPOSURE: i64 = 6 * 64;
/// By how many bits hits are shifted up to be divided.
const ENDED_LOG2: u32 = 16;
/// Fraction bits of a chance per bin.
const CHANCE_FRACTION: u32 = 24;
/// Most of a chance that is believed, a half.
const MOST_CHANCE: i64 = 1 << (CHANCE_FRACTION - 1);
/// Initial ratio of ambient light to the echo: a 16th.
const ECHO_LOG2: u32 = 4;
/// Largest word of a signal or an ambient hazard.
pub const MOST: i64 = (1 << 24) - 1;

/// A histogram as shots see it.
#[derive(Clone, Debug)]
pub struct Shots<'a> {
    /// Shots that end in each bin.
    pub ended: &'a [u32],
    /// Shots that wait when each bin begins.
    pub waiting: Vec<i64>,
    /// Sum of the first.
    pub all_ended: i64,
    /// Sum of the second, each times its bin's width [shots units].
    pub exposure: i64,
}

/// A block of bins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// 64 log2 of the hazard that it shows [1 / unit].
    pub level: i64,
    /// Shots that end in it.
    pub ended: i64,
    /// Shots that wait in its bins, each times its bin's width [shots units].
    pub exposure: i64,
}

/// Ambient light found in the blocks of bins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ambient {
    /// All blocks.
    pub blocks: [Block; BLOCKS],
    /// The block that is taken for ambient light alone.
    pub chosen: usize,
    /// `true` if no other block has shots left.
    pub lone: bool,
    /// Hazard of the chosen block [1 / unit, 30 fraction bits].
    pub hazard: i64,
}

impl<'a> Shots<'a> {
    /// Shots of a histogram.
    pub fn new(p: &Params, ended: &'a [u32]) -> Self {
        let mut left = p.shots as i64;
        let waiting: Vec<i64> = ended
            .iter()
            .map(|&count| {
                let before = left.max(0);
                left -= i64::from(count);
                before
            })
            .collect();
        let exposure = (0..ended.len()).map(|bin| waiting[bin] * p.width(bin)).sum();
        Shots { ended, waiting, all_ended: p.shots as i64 - left, exposure }
    }

    /// The hazard of ambient light: of eight blocks of bins, as far as shots are left, the one at 3/8
    /// of the order.
    pub fn ambient(&self, p: &Params) -> Ambient {
        let length_of_block = self.ended.len() / BLOCKS;
        let block = |k: usize| {
            let bins = k * length_of_block..(k + 1) * length_of_block;
            let ended: i64 = self.ended[bins.clone()].iter().map(|&count| i64::from(count)).sum();
            let exposure: i64 = bins.map(|bin| self.waiting[bin] * p.width(bin)).sum();
            Block { level: log2_64(ended) - log2_64(exposure), ended, exposure }
        };
        let blocks: [_; BLOCKS] = std::array::from_fn(block);
        let least = log2_64(blocks[0].exposure) - LEAST_EXPOSURE;
        let lit = |k: &usize| log2_64(blocks[*k].exposure) > least;
        let mut order: Vec<_> = (0..BLOCKS).filter(lit).collect();
        order.sort_by_key(|&k| blocks[k].level);
        let (chosen, lone) = (order[(order.len() - 1) * 3 / 8], order.len() == 1);
        let Block { ended, exposure, .. } = blocks[chosen];
        let ended = ended.min(p.histogram.most_hits() as i64);
        // Where all shots end in one block, the echo is in it.
        let ended = ended << if lone { ENDED_LOG2 - ECHO_LOG2 } else { ENDED_LOG2 };
        let (mantissa, bits) = reciprocal(exposure.max(1));
        // A chance in 64 units has 24 fraction bits where one in a unit has 30.
        let chance = shifted(ended * mantissa, i64::from(bits) + 2);
        Ambient { blocks, chosen, lone, hazard: hazard(chance.clamp(1, MOST_CHANCE)) }
    }
}

/// -log(1 - p) as far as its third power, of a chance with 24 fraction bits.
fn hazard(chance: i64) -> i64 {
    let square = shifted(chance * chance, CHANCE_FRACTION.into());
    let cube = shifted(square * chance, CHANCE_FRACTION.into());
    (chance + shifted(square, 1) + shifted(cube * 341, 10)).clamp(1, MOST)
}
