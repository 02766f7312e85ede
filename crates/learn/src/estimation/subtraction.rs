//! The thesis's background subtraction (Algorithm 2): H0 = H2 - H1.
//!
//! H1 is a histogram with the laser off, H2 the next one with it on, of half the shots each. H0 is
//! signed, and peak detection looks at it. Right of the echo it is negative on average: a shot that
//! the echo ended can have no ambient hit any more, so that H2 lacks the part 1 - exp(-S_p) of what
//! H1 has there.
//!
//! It does not help the detector: H0 has the noise of both histograms, and an echo of half the shots.
//! The prominence is a part of all shots, dark ones too: as a part of the lit ones it would let noise
//! pass for peaks (`tests/estimators` has both).

use tofsim::error::Input;
use tofsim::optics::Bins;

use super::estimator::{Estimator, Failure, HistogramPair, hits};
use super::peak_detection::PeakDetection;

/// Its name on the command line.
pub const NAME: &str = "subtraction";

/// Shots of each histogram of a pair that has so many.
///
/// # Errors
/// When two histograms cannot have equally many, or none.
pub fn half(shots: u64) -> Result<u64, Input> {
    if shots == 0 || !shots.is_multiple_of(2) {
        let expected = "expected an even number from 2: half of the shots are dark ones";
        return Err(Input::new("subtraction", expected).field("shots").value(shots));
    }
    Ok(shots / 2)
}

/// Peak detection on the difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Subtraction {
    /// Peak detection for the difference.
    pub detection: PeakDetection,
}

impl Subtraction {
    /// For pairs of so many shots in all, on the bins of a chain.
    ///
    /// # Errors
    /// As [`half`].
    pub fn of_bins(shots: u64, bins: &Bins) -> Result<Self, Input> {
        half(shots)?;
        Ok(Subtraction { detection: PeakDetection::of_bins(shots, bins) })
    }
}

impl Estimator for Subtraction {
    fn name(&self) -> &'static str {
        NAME
    }

    fn needs_dark(&self) -> bool {
        true
    }

    fn estimate(&self, _: &[u32]) -> Result<f64, Failure> {
        Err(Failure::NoDarkFrame)
    }

    fn estimate_pair(&self, pair: &HistogramPair) -> Result<f64, Failure> {
        hits(&pair.lit, u32::MAX)?;
        let difference: Vec<_> = pair.difference().into_iter().map(f64::from).collect();
        self.detection.detect(&difference)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_signed() {
        let (mut lit, mut dark) = (vec![10; 256], vec![10; 256]);
        (lit[3], dark[3], lit[4], dark[5]) = (0, 65_535, 65_535, 11);
        assert_eq!(HistogramPair { dark, lit }.difference()[2..6], [0, -65_535, 65_525, -1]);
    }

    #[test]
    fn a_slope_with_an_echo_becomes_the_echo_alone() {
        let dark: Vec<u32> = (0..256).map(|bin| 1000 - 3 * bin).collect();
        let mut lit = dark.clone();
        (150..170).for_each(|bin| lit[bin] += 40 * (10 - bin.abs_diff(160) as u32));
        let subtraction = Subtraction { detection: PeakDetection::new(30_000) };
        let pair = HistogramPair { dark: dark.clone(), lit: lit.clone() };
        let found = subtraction.estimate_pair(&pair).unwrap();
        assert!((found - subtraction.detection.distance_m(160.5 * 25.0)).abs() < 0.005);
        let failure = |dark: &[u32], lit: &[u32]| {
            let pair = HistogramPair { dark: dark.to_vec(), lit: lit.to_vec() };
            subtraction.estimate_pair(&pair).unwrap_err()
        };
        assert_eq!(failure(&lit, &dark), Failure::NoPeak, "dark and lit are not the same");
        assert_eq!(failure(&dark, &dark), Failure::NoPeak);
        assert_eq!(failure(&dark, &[0; 256]), Failure::NoHits);
        assert_eq!(subtraction.estimate(&lit), Err(Failure::NoDarkFrame));
    }

    #[test]
    fn shots_that_have_no_half_are_refused() {
        assert_eq!(half(30_000), Ok(15_000));
        for shots in [0, 1, 30_001] {
            let fault = half(shots).unwrap_err().to_string();
            assert!(fault.starts_with(&format!("subtraction: shots = {shots}: expected an even")));
        }
    }
}
