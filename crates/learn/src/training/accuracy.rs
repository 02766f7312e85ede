//! Errors of a network over a test set, by distance.

use rayon::prelude::*;

use super::data::Samples;
use super::weighting::Weighting;

/// Errors at a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceErrors {
    /// True distance [m].
    pub distance_m: f64,
    /// Histograms there.
    pub count: usize,
    /// Mean of depth minus distance [mm].
    pub mean_mm: f64,
    /// Twice the standard deviation of the depth [mm].
    pub two_sd_mm: f64,
    /// Root of the mean squared error [mm].
    pub rms_mm: f64,
}

/// Errors by distance, in the samples' order; those of one distance have to be neighbours.
pub fn by_distance(
    samples: &Samples,
    depth_m: impl Fn(&[u32]) -> f64 + Sync + Send,
) -> Vec<DistanceErrors> {
    let depths: Vec<f64> = samples.counts.par_iter().map(|counts| depth_m(counts)).collect();
    let pairs: Vec<_> = samples.distances_m.iter().copied().zip(depths).collect();
    pairs.chunk_by(|a, b| a.0 == b.0).map(row).collect()
}

/// Errors at one distance.
fn row(pairs: &[(f64, f64)]) -> DistanceErrors {
    let n = pairs.len() as f64;
    let errors = || pairs.iter().map(|(distance, depth)| (depth - distance) * 1e3);
    let mean_mm = errors().sum::<f64>() / n;
    let squares: f64 = errors().map(|error| (error - mean_mm) * (error - mean_mm)).sum();
    let variance = if pairs.len() > 1 { squares / (n - 1.0) } else { 0.0 };
    DistanceErrors {
        distance_m: pairs[0].0,
        count: pairs.len(),
        mean_mm,
        two_sd_mm: 2.0 * variance.sqrt(),
        rms_mm: (squares / n + mean_mm * mean_mm).sqrt(),
    }
}

/// The largest ratio of a spread to the line; infinite if a spread is no number.
pub fn worst_ratio(rows: &[DistanceErrors], line: &Weighting) -> f64 {
    let ratio = |row: &DistanceErrors| row.two_sd_mm / line.line_mm(row.distance_m);
    let number = |ratio: f64| if ratio.is_nan() { f64::INFINITY } else { ratio };
    rows.iter().map(ratio).map(number).fold(0.0, f64::max)
}

/// The largest ratio of a spread to the line or of a mean error to its limit, whichever is worse.
pub fn worst(rows: &[DistanceErrors], line: &Weighting) -> f64 {
    let means = rows.iter().map(|row| row.mean_mm.abs() / line.mean_mm);
    means.fold(worst_ratio(rows, line), f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_by_hand() {
        let count = |count| vec![count; 256];
        let counts = [100, 102, 104, 300].map(count).to_vec();
        let samples = Samples { counts, distances_m: vec![0.1, 0.1, 0.1, 0.4] };
        let rows = by_distance(&samples, |histogram| f64::from(histogram[0]) / 1000.0);
        let [near, far] = rows[..] else { panic!("{rows:?}") };
        assert_eq!((near.distance_m, near.count, far.distance_m), (0.1, 3, 0.4));
        assert!((near.mean_mm - 2.0).abs() < 1e-9 && (near.two_sd_mm - 4.0).abs() < 1e-9);
        assert!((near.rms_mm - (20.0f64 / 3.0).sqrt()).abs() < 1e-9);
        assert!((far.mean_mm + 100.0).abs() < 1e-9 && far.two_sd_mm == 0.0);
        let worst = worst_ratio(&rows, &Weighting::default());
        assert!((worst - 4.0 / 1.6).abs() < 1e-9);
        let biased = [DistanceErrors { mean_mm: -3.0, ..near }];
        assert!((super::worst(&biased, &Weighting::default()) - 3.0).abs() < 1e-9);
        let nan = DistanceErrors { two_sd_mm: f64::NAN, ..near };
        assert_eq!(worst_ratio(&[nan, near], &Weighting::default()), f64::INFINITY);
    }
}
