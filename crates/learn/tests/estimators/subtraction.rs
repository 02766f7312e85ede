//! Tests of the residual after subtraction, and that it does not improve detection.

use tofsim::kernel::pulse::Pulse;
use tofsim::optics::{BinProbabilities, Budget, Hazard};
use tofsim::scenario::Scenario;
use tofsim::sensor::streams::{Source, stream};
use tofsim_learn::estimation::peak_detection::PeakDetection;
use tofsim_learn::estimation::subtraction::Subtraction;
use tofsim_learn::estimation::{Estimator, HistogramPair};

use super::{DISTANCES_M, SHOTS, bins, grid};

/// Section 5.2: left of the echo nothing is left, right of it less than nothing.
#[test]
fn subtraction_leaves_a_negative_tail_and_no_better_detection() {
    let bins = bins("ideal");
    let (mut tails, mut successes) = (Vec::new(), [0; 2]);
    for irradiance_w_m2_nm in [0.1, 0.2, 0.3, 0.4] {
        let mut scenario = Scenario::default();
        scenario.target.distance_m = 0.6;
        scenario.target.reflectance = 0.6;
        scenario.ambient.irradiance_w_m2_nm = irradiance_w_m2_nm;
        let budget = Budget::new(&scenario, Pulse::default());
        let with = |hazard| BinProbabilities::new(&hazard, &bins);
        let (on, off) = (with(Hazard::new(&budget)), with(Hazard::dark(&budget)));
        let mut random = stream(5, Source::Histogram, 0);
        let (mut left, mut right) = (0.0, 0.0);
        for _ in 0..100 {
            let mut draw = |of: &BinProbabilities| -> Vec<u32> {
                of.draw(15_000, &mut random).into_iter().map(|n| n as u32).collect()
            };
            let (on, off) = (draw(&on), draw(&off));
            let pair = HistogramPair { dark: off, lit: on };
            let difference = pair.difference();
            let mean = |part: &[i32]| part.iter().sum::<i32>() as f64 / part.len() as f64 / 100.0;
            left += mean(&difference[..140]);
            right += mean(&difference[180..]);
            let subtraction = Subtraction { detection: PeakDetection::new(2 * 15_000) };
            let found = subtraction.estimate_pair(&pair);
            successes[0] += found.is_ok() as usize;
            let detection = PeakDetection::new(15_000);
            successes[1] += detection.estimate(&pair.lit).is_ok() as usize;
        }
        assert!(left.abs() < 1.0, "{left}");
        tails.push(right);
    }
    println!("{tails:?} {successes:?}");
    for (found, expected) in tails.iter().zip([-16.0, -9.0, -3.8, -1.5]) {
        assert!((found - expected).abs() < 0.8, "{tails:?}");
    }
    assert!(successes[0] < successes[1], "{successes:?}");
}

/// Failures of subtraction with the prominence taken of all shots, with it taken of the lit ones, and
/// of plain peak detection on a histogram of all shots, among as many measurements.
fn failures_with_and_without_dark_shots(distance_m: f64, repeats: usize) -> [usize; 3] {
    let (bins, plain) = (bins("ideal"), PeakDetection::new(SHOTS));
    let of_all = Subtraction { detection: plain.clone() };
    let of_lit = Subtraction { detection: PeakDetection::new(SHOTS / 2) };
    let mut random = stream(12, Source::Histogram, (distance_m * 1e3) as u64);
    let mut failures = [0; 3];
    grid(distance_m, &bins, repeats, |budget, histograms| {
        let hazards = [Hazard::dark(budget), Hazard::new(budget)];
        let codes = hazards.map(|hazard| BinProbabilities::new(&hazard, &bins));
        for histogram in histograms {
            let mut draw = |k: usize| -> Vec<u32> {
                codes[k].draw(SHOTS / 2, &mut random).into_iter().map(|n| n as u32).collect()
            };
            let pair = HistogramPair { dark: draw(0), lit: draw(1) };
            let found = [
                of_all.estimate_pair(&pair),
                of_lit.estimate_pair(&pair),
                plain.estimate(&histogram),
            ];
            for (failures, found) in failures.iter_mut().zip(found) {
                *failures += usize::from(found.is_err());
            }
        }
    });
    failures
}

/// The same number of shots, one half of them dark: Algorithm 2 does not help the detector.
/// `MEASURE=1` counts among 30,000 measurements instead of 1,500; docs/accuracy.md has those.
#[test]
fn subtraction_fails_more_often_than_peak_detection_alone() {
    let repeats = if std::env::var_os("MEASURE").is_some() { 100 } else { 5 };
    let mut sums = [0; 3];
    for distance_m in DISTANCES_M {
        let failures = failures_with_and_without_dark_shots(distance_m, repeats);
        println!("{distance_m} m: {failures:?} of {}", 300 * repeats);
        sums.iter_mut().zip(failures).for_each(|(sum, failures)| *sum += failures);
    }
    let [of_all, of_lit, plain] = sums;
    assert!(of_all > plain && of_lit > plain, "{sums:?}");
}
