//! Histograms with their true distances: what a network is trained and judged on.

use tofsim::error::{Input, Result};
use tofsim::network::Histogram;

/// Histograms and distances, one of each a sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// Counts by bin [hits].
    pub counts: Vec<Histogram>,
    /// True distance [m].
    pub distances_m: Vec<f64>,
}

impl Samples {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.counts.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty()
    }

    /// That there is something to train on.
    ///
    /// # Errors
    /// When there are no samples, more or fewer distances than histograms, or a distance is no
    /// finite number.
    pub fn check(&self) -> Result<()> {
        let fault = |field: &str, expected: &str| Input::new("samples", expected).field(field);
        let (counts, distances) = (self.counts.len(), self.distances_m.len());
        if counts == 0 {
            return Err(fault("counts", "expected one histogram at least").value(0).into());
        }
        if counts != distances {
            let expected = format!("expected one a histogram: {counts}");
            return Err(fault("distances_m", &expected).value(distances).into());
        }
        let finite = self.distances_m.iter().position(|distance| !distance.is_finite());
        let Some(place) = finite else { return Ok(()) };
        let field = format!("distances_m[{place}]");
        let refused = fault(&field, "expected a finite number of metres");
        Err(refused.value(self.distances_m[place]).into())
    }

    /// A number that changes with any count and any distance.
    pub fn digest(&self) -> u64 {
        let mut value = digest(0, &[]);
        for (counts, distance_m) in self.counts.iter().zip(&self.distances_m) {
            value = digest(value, &distance_m.to_le_bytes());
            value = counts.iter().fold(value, |value, count| digest(value, &count.to_le_bytes()));
        }
        value
    }
}

/// FNV-1a of 64 bits, going on from `before`.
pub(super) fn digest(before: u64, bytes: &[u8]) -> u64 {
    let start = before ^ 0xcbf2_9ce4_8422_2325;
    bytes
        .iter()
        .fold(start, |value, &byte| (value ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_trained_on_is_refused() {
        let fault = |samples: Samples| samples.check().unwrap_err().to_string();
        assert!(fault(Samples::default()).contains("one histogram at least"));
        let uneven = Samples { counts: vec![[0; 256]; 2], distances_m: vec![0.1] };
        assert!(fault(uneven).contains("distances_m = 1: expected one a histogram: 2"));
        let nan = Samples { counts: vec![[0; 256]], distances_m: vec![f64::NAN] };
        assert!(fault(nan).contains("distances_m[0] = NaN"));
    }

    #[test]
    fn the_digest_sees_every_count_and_distance() {
        let samples = Samples { counts: vec![[7; 256]; 2], distances_m: vec![0.1, 0.2] };
        let mut other = samples.clone();
        other.counts[1][255] += 1;
        assert_ne!(samples.digest(), other.digest());
        let mut other = samples.clone();
        other.distances_m[0] = 0.1f64.next_up();
        assert_ne!(samples.digest(), other.digest());
        assert_eq!(samples.digest(), samples.clone().digest());
    }
}
