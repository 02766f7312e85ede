//! Histograms with their true distances: what a network is trained and judged on.

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
