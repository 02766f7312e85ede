//! Light of a cover glass as the estimator knows it: the pedestal of a histogram without a target.

use std::sync::Arc;

/// All of the pedestal, as the pulse's ROM counts parts.
const ALL: f64 = 131_071.0;
/// Photons per shot as a word has them, 14 fraction bits.
const ONE: f64 = 16_384.0;
/// Largest pedestal [photons a shot].
pub const MOST_LIGHT: f64 = 256.0;

/// Shape and strength of a pedestal; without bins, there is none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Glass {
    /// Part of the pedestal in each of the first bins, of 131,071; later bins have none.
    pub parts: Arc<[u32]>,
    /// Photons per shot, with 14 fraction bits, when it was calibrated.
    pub light: i64,
}

impl Glass {
    /// Returns the words of a pedestal with these hazards, of which the last that is not zero ends it.
    pub fn of(hazards: &[f64]) -> Self {
        let light: f64 = hazards.iter().sum();
        let part = |&hazard: &f64| libm::round(hazard / light * ALL) as u32;
        let bins = hazards.iter().rposition(|hazard| part(hazard) > 0).map_or(0, |last| last + 1);
        let parts = hazards[..bins].iter().map(part).collect();
        Glass { parts, light: libm::round(light * ONE) as i64 }
    }

    /// Returns the number of bins with light of the pedestal; 0 without one.
    pub fn bins(&self) -> usize {
        self.parts.len()
    }

    /// Returns the part of the pedestal in a bin.
    pub fn part(&self, bin: usize) -> i64 {
        self.parts.get(bin).copied().unwrap_or(0).into()
    }
}
