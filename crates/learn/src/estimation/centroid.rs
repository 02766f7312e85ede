//! The firmware's other estimator: argmax with centroid correction, bit for bit.

use tofsim::firmware::centroid_estimator::Params;
use tofsim::sim::estimates::centroid::{Found, locate};

use super::estimator::{Estimator, Failure, hits};

/// The estimator, with its window and scale; a histogram in which nothing stands out has no distance.
#[derive(Clone, Copy, Debug)]
pub struct Centroid(pub Params);

impl Estimator for Centroid {
    fn name(&self) -> &'static str {
        "centroid"
    }

    fn estimate(&self, histogram: &[u32]) -> Result<f64, Failure> {
        hits(histogram, u32::MAX)?;
        match locate(&self.0, histogram) {
            Found { best: 0, .. } => Err(Failure::NoPeak),
            found => Ok(found.depth.to_f64()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_peak_has_no_distance() {
        let centroid = Centroid(Params::default());
        assert_eq!(centroid.estimate(&[0; 256]), Err(Failure::NoHits));
        assert_eq!(centroid.estimate(&[100; 256]), Err(Failure::NoPeak));
    }
}
