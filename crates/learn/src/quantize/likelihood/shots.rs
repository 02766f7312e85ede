//! Shots that wait, what a bin says, and the ambient light, in double precision.

use super::model::Model;

/// Blocks that the window is divided in.
const BLOCKS: usize = 8;
/// Hits and shots that a block without any has: half of one, over the 64th of a bin.
const NONE: f64 = 0.5;
const NO_EXPOSURE: f64 = 0.5 / 64.0;
/// The part of the first block's exposure that a block needs.
const LEAST_EXPOSURE: f64 = 1.0 / 64.0;
/// Smallest and largest chance of a bin that is believed.
const CHANCES: [f64; 2] = [1.0 / 16_777_216.0, 0.5];
/// Smallest and largest hazard of a bin.
const HAZARDS: [f64; 2] = [1.0 / 1_048_576.0, 16.0];

/// Terms of a bin at a point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Terms {
    /// R lambda [counts].
    pub expected: f64,
    /// v = n k - R lambda [counts].
    pub residual: f64,
    /// w = R lambda (k - lambda) [counts].
    pub weight: f64,
    /// The signal's share in lambda [1].
    pub share: f64,
}

impl Terms {
    /// Of a bin in which `ended` of the shots that wait end, with the hazards of signal and ambient light.
    pub fn new(ended: f64, waiting: f64, signal: f64, ambient: f64) -> Self {
        let hazard = (signal + ambient).clamp(HAZARDS[0], HAZARDS[1]);
        let k = hazard / -(-hazard).exp_m1();
        let expected = waiting * hazard;
        Terms {
            expected,
            residual: ended * k - expected,
            weight: expected * (k - hazard),
            share: (signal / hazard).min(1.0),
        }
    }
}

/// A histogram as shots see it.
#[derive(Clone, Debug)]
pub struct Shots {
    /// Shots that end in each bin.
    pub ended: Vec<f64>,
    /// Shots that wait when each bin begins.
    pub waiting: Vec<f64>,
    /// Waiting shots times the width of their bin [shots bins].
    pub exposed: Vec<f64>,
}

/// Ambient light found in the blocks of bins.
#[derive(Clone, Debug)]
pub struct Ambient {
    /// Hazard of each block; half a hit where there is none [1 / bin].
    pub blocks: Vec<f64>,
    /// The block that is believed.
    pub chosen: usize,
    /// Its hazard, from the chance that a shot ends [1 / bin].
    pub hazard: f64,
}

impl Shots {
    /// Of a histogram.
    pub fn new(model: &Model, histogram: &[u32]) -> Self {
        let ended: Vec<f64> = histogram.iter().map(|&count| count.into()).collect();
        let mut left = model.words.shots as f64;
        let mut waiting = Vec::with_capacity(ended.len());
        for count in &ended {
            waiting.push(left.max(0.0));
            left -= count;
        }
        let exposed = waiting.iter().enumerate().map(|(bin, shots)| shots * model.width(bin));
        Shots { exposed: exposed.collect(), ended, waiting }
    }

    /// The hazard of ambient light: of eight blocks, as far as shots are left, the one at 3/8 of the order.
    pub fn ambient(&self, model: &Model) -> Ambient {
        let length = self.ended.len() / BLOCKS;
        let sum = |of: &[f64], block: usize| -> f64 {
            of[block * length..(block + 1) * length].iter().sum()
        };
        let exposure = |block: usize| sum(&self.exposed, block);
        let hits = |block: usize| sum(&self.ended, block);
        let level = |block: usize| hits(block).max(NONE) / exposure(block).max(NO_EXPOSURE);
        let blocks: Vec<f64> = (0..BLOCKS).map(level).collect();
        let lit = |block: &usize| exposure(*block) > LEAST_EXPOSURE * exposure(0);
        let mut order: Vec<usize> = (0..BLOCKS).filter(lit).collect();
        order.sort_by(|&a, &b| blocks[a].total_cmp(&blocks[b]));
        let chosen = order.get(order.len().saturating_sub(1) * 3 / 8).copied().unwrap_or(0);
        // Where all shots end in one block, the echo is in it, and a 16th is ambient light.
        let part = if order.len() > 1 { 1.0 } else { 1.0 / 16.0 };
        let believed = hits(chosen).min(model.words.histogram.most_hits() as f64);
        let chance = part * believed / exposure(chosen).max(NO_EXPOSURE);
        let hazard = -(-chance.clamp(CHANCES[0], CHANCES[1])).ln_1p();
        Ambient { blocks, chosen, hazard }
    }
}
