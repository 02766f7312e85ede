//! Light of a cover glass as the estimator knows it: the pedestal of a histogram without a target.

use std::sync::Arc;

/// All of the pedestal, as the pulse's ROM counts parts.
const ALL: f64 = 131_071.0;
/// Photons per shot as a word has them, 14 fraction bits.
const ONE: f64 = 16_384.0;
/// Largest pedestal [photons a shot].
pub const MOST_LIGHT: f64 = 256.0;

/// Part of a pedestal, late in its tail, whose bins a fit of another window leaves out [1].
const LATE: f64 = 1.0 / 1024.0;

/// Shape and strength of a pedestal; without bins, there is none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Glass {
    /// Part of the pedestal in each bin, of 131,071; bins after the last have none.
    parts: Arc<[u32]>,
    /// Bins that each fit goes over, from bin 0 on: all but a thousandth of the pedestal is in them.
    bins: usize,
    /// Photons per shot, with 14 fraction bits, when it was calibrated.
    pub light: i64,
}

impl Glass {
    /// Returns the words of a pedestal with these hazards.
    pub fn of(hazards: &[f64]) -> Self {
        let light: f64 = hazards.iter().sum();
        if light <= 0.0 {
            return Glass::default();
        }
        let mut until = 0.0;
        let early = hazards.iter().take_while(|&&hazard| {
            until += hazard;
            until < (1.0 - LATE) * light
        });
        let bins = (early.count() + 1).min(hazards.len());
        let part = |&hazard: &f64| libm::round(hazard / light * ALL) as u32;
        let parts = hazards.iter().map(part).collect();
        Glass { parts, bins, light: libm::round(light * ONE) as i64 }
    }

    /// Returns the number of bins that each fit goes over; 0 without a pedestal.
    pub fn bins(&self) -> usize {
        self.bins
    }

    /// Returns the part of the pedestal in a bin, of 131,071.
    pub fn part(&self, bin: usize) -> i64 {
        self.parts.get(bin).copied().unwrap_or(0).into()
    }

    /// Returns the least and the most light of a pedestal for which the calibration holds, half of it and twice as
    /// much: a fit is sure to settle from there.
    pub fn limits(&self) -> [i64; 2] {
        [self.light / 2, 2 * self.light]
    }
}
