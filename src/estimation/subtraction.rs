//! The thesis's background subtraction (Algorithm 2): H0 = H2 - H1.
//!
//! H1 is a histogram with the laser off, H2 the next one with it on, of equally many shots. H0 is
//! signed. Right of the echo it is negative on average: a shot that the echo ended can have no
//! ambient hit any more, so that H2 lacks the part 1 - exp(-S_p) of what H1 has there.
//!
//! It does not help the detector: H0 has the noise of both histograms, and the echo is not higher.

use crate::network::Histogram;

use super::Failure;
use super::peak_detection::PeakDetection;

/// H0 = H2 - H1, bin by bin [hits].
pub fn subtract(laser_on: &Histogram, laser_off: &Histogram) -> [i32; 256] {
    std::array::from_fn(|bin| i32::from(laser_on[bin]) - i32::from(laser_off[bin]))
}

/// Distance of the only peak of H0 [m]; `detection.shots` are those of one histogram or of both,
/// as the prominence is to be taken.
///
/// # Errors
/// When nothing was counted with the laser on, or there is not exactly one peak.
pub fn detect(
    detection: &PeakDetection,
    laser_on: &Histogram,
    laser_off: &Histogram,
) -> Result<f64, Failure> {
    super::hits(laser_on, u32::MAX)?;
    detection.detect(&subtract(laser_on, laser_off).map(f64::from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimation::Estimator;

    #[test]
    fn counts_are_signed() {
        let (mut on, mut off) = ([10; 256], [10; 256]);
        (on[3], off[3], on[4], off[5]) = (0, u16::MAX, u16::MAX, 11);
        let difference = subtract(&on, &off);
        assert_eq!(difference[2..6], [0, -65_535, 65_525, -1]);
    }

    #[test]
    fn a_slope_with_an_echo_becomes_the_echo_alone() {
        let slope: Histogram = std::array::from_fn(|bin| 1000 - 3 * bin as u16);
        let mut on = slope;
        (150..170).for_each(|bin| on[bin] += 40 * (10 - bin.abs_diff(160) as u16));
        let detection = PeakDetection::new(30_000);
        let found = detect(&detection, &on, &slope).unwrap();
        assert!((found - detection.distance_m(160.5 * 25.0)).abs() < 0.005);
        assert_eq!(detection.estimate(&slope), Err(Failure::NoPeak));
        assert_eq!(detect(&detection, &slope, &slope), Err(Failure::NoPeak));
        assert_eq!(detect(&detection, &[0; 256], &slope), Err(Failure::NoHits));
    }
}
