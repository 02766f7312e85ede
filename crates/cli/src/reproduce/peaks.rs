//! Peak detection over the grid of section 4.4: 300 lights, each repeated, at six distances.

use std::sync::atomic::AtomicBool;

use tofsim::error::Result;
use tofsim_learn::dataset::{Axis, Grid, GridPurpose, HistogramSource, Rows};
use tofsim_learn::estimation::Estimator;
use tofsim_learn::estimation::acquisition::ARRIVAL_PS_PER_M;
use tofsim_learn::estimation::peak_detection::PeakDetection;
use tofsim_learn::evaluation::thesis::DISTANCES_M;
use tofsim_learn::evaluation::{Evaluation, Spread};

/// Shots of a frame, the thesis's TCSPC [shots].
pub const SHOTS: u64 = 30_000;
/// Irradiances and reflectances, the factors of the 300 that are ours to choose.
const LIGHTS: [u64; 2] = [15, 20];
/// A single peak further off than that is not the signal's [m].
pub const WRONG_M: f64 = 0.08;

/// Peak detection results at each of the six distances.
pub struct Peaks {
    /// Histograms at a distance.
    pub trials: u64,
    /// Of those, the ones without exactly one peak.
    pub failures: [u64; 6],
    /// Single peaks that are not the signal's.
    pub wrong: [u64; 6],
    /// Errors of the peaks that are the signal's, after the thesis's compensation [m].
    pub errors_m: [Vec<f64>; 6],
    /// The grid as the options of `evaluate`.
    pub options: Vec<String>,
}

impl Peaks {
    /// Draws `repeats` histograms of each light and distance.
    pub(super) fn measure(
        source: &HistogramSource,
        repeats: u64,
        seed: u64,
        stop: Option<&AtomicBool>,
    ) -> Result<Self> {
        let steps = |from: f64, until: f64, count: u64| {
            let value = |k| from + (until - from) * k as f64 / (count - 1) as f64;
            (0..count).map(|k| format!("{:.6}", value(k))).collect::<Vec<_>>().join(",")
        };
        let options = [
            "target.distance_m=0.1..0.6:0.1".to_owned(),
            format!("ambient.irradiance_w_m2_nm={}", steps(0.0, 0.4, LIGHTS[0])),
            format!("target.reflectance={}", steps(0.08, 0.6, LIGHTS[1])),
        ];
        let axes = options.iter().map(|option| Axis::parse("grid", option));
        let axes = axes.collect::<Result<Vec<_>>>()?;
        let grid = Grid::own(&axes, source.scenario(), GridPurpose::Test)?.repeated(repeats)?;
        let estimators: [Box<dyn Estimator>; 1] = [Box::new(PeakDetection::new(SHOTS))];
        let trials = grid.lights() * repeats;
        let evaluation =
            Evaluation::new(source, &Rows::All(grid), seed, &estimators, stop, |_| {})?;
        let mut peaks = Peaks {
            trials,
            failures: [0; 6],
            wrong: [0; 6],
            errors_m: Default::default(),
            options: options.into(),
        };
        for (scene, error) in evaluation.scenes.iter().zip(&evaluation.columns[0].errors_m) {
            let Some(at) = DISTANCES_M.iter().position(|m| *m == scene.distance_m) else {
                continue;
            };
            match error {
                None => peaks.failures[at] += 1,
                Some(error) if error.abs() > WRONG_M => peaks.wrong[at] += 1,
                Some(error) => peaks.errors_m[at].push(*error),
            }
        }
        Ok(peaks)
    }

    /// Errors at a distance.
    pub fn spread(&self, at: usize) -> Spread {
        Spread::of(self.errors_m[at].iter().copied().map(Some))
    }

    /// Listing 5.3: the straight line from where peaks are to where targets are, each peak of each distance alike;
    /// its slope and offset, with their standard errors [1, m].
    pub fn compensation(&self) -> [(f64, f64); 2] {
        let PeakDetection { slope, offset_m, .. } = PeakDetection::new(SHOTS);
        let pairs = || {
            DISTANCES_M.into_iter().zip(&self.errors_m).flat_map(move |(truth, errors)| {
                errors.iter().map(move |error| ((truth + error - offset_m) / slope, truth))
            })
        };
        let n = pairs().count() as f64;
        let (mx, my) = pairs().fold((0.0, 0.0), |(x, y), pair| (x + pair.0 / n, y + pair.1 / n));
        let sum = |of: fn(f64, f64) -> f64| pairs().map(|(x, y)| of(x - mx, y - my)).sum::<f64>();
        let (xx, xy, yy) = (sum(|x, _| x * x), sum(|x, y| x * y), sum(|_, y| y * y));
        let slope = xy / xx;
        let variance = (yy - slope * xy) / (n - 2.0);
        let slope_error = (variance / xx).sqrt();
        let offset_error = (variance * (1.0 / n + mx * mx / xx)).sqrt();
        [(slope, slope_error), (my - slope * mx, offset_error)]
    }

    /// Time at which an echo of a distance arrives [ps].
    pub fn arrival_ps(distance_m: f64) -> f64 {
        distance_m * ARRIVAL_PS_PER_M
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_of_exact_peaks_takes_the_compensation_back() {
        let detection = PeakDetection::new(SHOTS);
        // Peaks where a line of slope 0.9 and offset 0.04 has them.
        let error = |truth: f64| {
            let place = (truth - 0.04) / 0.9;
            detection.slope * place + detection.offset_m - truth
        };
        let errors_m = DISTANCES_M.map(|truth| vec![error(truth); 3]);
        let peaks =
            Peaks { trials: 3, failures: [0; 6], wrong: [0; 6], errors_m, options: Vec::new() };
        let [(slope, _), (offset_m, error_m)] = peaks.compensation();
        assert!((slope - 0.9).abs() < 1e-9 && (offset_m - 0.04).abs() < 1e-9, "{slope} {offset_m}");
        assert!(error_m < 1e-6);
    }
}
