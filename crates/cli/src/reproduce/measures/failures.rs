//! Where peak detection finds nothing: Table 4.3 and Fig. 5.3.

use tofsim::error::Result;
use tofsim_learn::evaluation::thesis::{DISTANCES_M, PEAK_FAILURES, PEAK_TRIALS};

use crate::reproduce::measured::Measured;
use crate::reproduce::peaks::{Peaks, SHOTS};
use crate::reproduce::scenes::{View, bars, counts, curve, detection, upright};
use crate::reproduce::study::Study;
use crate::reproduce::values::Values;

/// Distance of the target of Fig. 5.3 [m].
const DISTANCE_M: f64 = 0.6;

pub(super) fn failures(study: &Study) -> Result<Measured> {
    let peaks = study.peaks()?;
    let scale = PEAK_TRIALS as f64 / peaks.trials as f64;
    // The standard error of a Poisson count, of one at least.
    let error = |count: u64| (count.max(1) as f64).sqrt();
    let mut values = Values::default();
    for (at, m) in DISTANCES_M.into_iter().enumerate() {
        let (printed, ours) = (PEAK_FAILURES[at], peaks.failures[at]);
        values.put_figure(format!("printed.{m}"), (printed as f64, error(printed)));
        values.put_figure(format!("failures.{m}"), (scale * ours as f64, scale * error(ours)));
        values.put(format!("wrong.{m}"), scale * peaks.wrong[at] as f64);
    }
    values.put("repeats", (peaks.trials / 300) as f64);
    values.put_words("seed", study.seed.to_string());
    let grid: Vec<_> = peaks.options.iter().map(|option| format!("--grid {option}")).collect();
    values.put_words("grid", grid.join(" "));
    Ok(values.into())
}

pub(super) fn failed_histogram(study: &Study) -> Result<Measured> {
    let view = View::new(study, DISTANCE_M, 0.6, 0.4)?;
    let detection = detection();
    let draws = study.size(2000, 300);
    let histogram = |number| counts(&view.histogram(study, 10_000 + number));
    let failed: Vec<u64> =
        (0..draws).filter(|k| detection.peaks(&histogram(*k)).is_empty()).collect();
    let shown = histogram(failed.first().copied().unwrap_or(0));
    let height = shown.iter().copied().fold(0.0, f64::max);
    let arrival_ns = 1e-3 * Peaks::arrival_ps(DISTANCE_M);
    let (x, y) = detection.curve(&shown).unwrap_or_default();
    let near = |k: &usize| (x[*k] * 1e-3 - arrival_ns).abs() < 0.3;
    let hump = (0..x.len()).filter(near).max_by(|a, b| y[*a].total_cmp(&y[*b])).unwrap_or(0);
    let before = (0..hump).rev().map(|k| y[k]).take(10).fold(f64::INFINITY, f64::min);
    let mut values = Values::default();
    values.put("draws", draws as f64);
    values.put("failed", failed.len() as f64);
    values.put("protuberance", y[hump] - before);
    values.put("at_ns", x[hump] * 1e-3);
    values.put("prominence", detection.prominence * SHOTS as f64);
    let layers = vec![
        bars(&shown),
        curve(&detection, &shown),
        upright(format!("target: {arrival_ns:.3} ns"), arrival_ns, height),
    ];
    Ok(Measured::from(values).layers(layers))
}
