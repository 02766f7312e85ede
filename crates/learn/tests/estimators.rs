//! The estimators against scipy, the thesis's tables and the Cramér-Rao bound, under fixed seeds.

mod any_histogram;
mod detector;
mod effects;
mod likelihood_estimator;
mod pixels;
mod scipy;
mod subtraction;

use tofsim::firmware::tdc;
use tofsim::kernel::Time;
use tofsim::kernel::pulse::Pulse;
use tofsim::network::Histogram;
use tofsim::optics::{BinProbabilities, Bins, Budget, Hazard};
use tofsim::scenario::builtin::Source as Place;
use tofsim::scenario::{Scenario, chain};
use tofsim::sensor::streams::{Source, stream};
use tofsim_learn::estimation::Acquisition;
use tofsim_learn::estimation::Estimator;
use tofsim_learn::estimation::acquisition::Echo;
use tofsim_learn::estimation::likelihood::{Likelihood, Model};
use tofsim_learn::estimation::matched_filter::MatchedFilter;
use tofsim_learn::estimation::peak_detection::PeakDetection;

/// Distances of the thesis's tables [m].
const DISTANCES_M: [f64; 6] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
/// Shots of a frame [shots].
const SHOTS: u64 = 30_000;

fn bins(profile: &str) -> Bins {
    let delays = chain::load(profile, &Place::Folder("".into()), Time::from_ns(8)).unwrap();
    Bins::of_tdc(&tdc::Params::of_chain(delays))
}

fn acquisition(bins: &Bins) -> Acquisition<'_> {
    Acquisition::new(bins, SHOTS, &Pulse::Gaussian { sigma_ps: 137.0 })
}

/// Calls `take` with the budget and `repeats` histograms of each scene: 15 irradiances from 0 to
/// 0.4 W/m^2/nm times 20 reflectances from 0.08 to 0.6, as in section 4.4.
fn grid(
    distance_m: f64,
    bins: &Bins,
    repeats: usize,
    mut take: impl FnMut(&Budget, &mut dyn Iterator<Item = Histogram>),
) {
    let mut random = stream(11, Source::Histogram, (distance_m * 1e3) as u64);
    for cell in 0..300 {
        let mut scenario = Scenario::default();
        scenario.target.distance_m = distance_m;
        scenario.ambient.irradiance_w_m2_nm = 0.4 * (cell / 20) as f64 / 14.0;
        scenario.target.reflectance = 0.08 + 0.52 * (cell % 20) as f64 / 19.0;
        let budget = Budget::new(&scenario, Pulse::default());
        let probabilities = BinProbabilities::new(&Hazard::new(&budget), bins);
        let draw = |_| -> Histogram {
            let drawn = probabilities.draw(SHOTS, &mut random);
            drawn.into_iter().map(|count| count as u32).collect()
        };
        take(&budget, &mut (0..repeats).map(draw));
    }
}

/// Mean of the errors and twice their standard deviation [mm].
fn spread_mm(errors_m: &[f64]) -> (f64, f64) {
    let count = errors_m.len() as f64;
    let mean = errors_m.iter().sum::<f64>() / count;
    let variance = errors_m.iter().map(|error| (error - mean).powi(2)).sum::<f64>() / count;
    (1e3 * mean, 2e3 * variance.sqrt())
}

/// Failures of peak detection on ideal bins, and the errors of its successes [m].
fn peak_detection(distance_m: f64, repeats: usize) -> (usize, Vec<f64>) {
    let detection = PeakDetection::new(SHOTS);
    let (mut failures, mut errors_m) = (0, Vec::new());
    grid(distance_m, &bins("ideal"), repeats, |_, histograms| {
        for histogram in histograms {
            match detection.estimate(&histogram) {
                Ok(found_m) => errors_m.push(found_m - distance_m),
                Err(_) => failures += 1,
            }
        }
    });
    errors_m.retain(|error_m| error_m.abs() < 0.08);
    (failures, errors_m)
}

/// Measured with 100 repeats, of 30,000: 0 2 2 3 401 2510; the thesis has 0 0 0 7 332 2584. With 20
/// repeats the bounds are 4 standard deviations of a count to either side of the measurement.
#[test]
fn peak_detection_fails_as_often_as_in_table_4_3() {
    let bounds = [(0, 0), (0, 3), (0, 3), (0, 4), (44, 116), (413, 591)];
    for (distance_m, (least, most)) in DISTANCES_M.into_iter().zip(bounds) {
        let (failures, _) = peak_detection(distance_m, 20);
        println!("{distance_m} m: {failures} failures of 6000");
        assert!((least..=most).contains(&failures), "{distance_m} m: {failures}");
    }
}

#[test]
fn peak_detection_errs_as_in_table_5_2() {
    let thesis_mm = [-5.7, 2.2, 3.9, 3.6, 0.7, -2.3];
    let mut squares = 0.0;
    for (distance_m, thesis_mm) in DISTANCES_M.into_iter().zip(thesis_mm) {
        let (mean_mm, twice_mm) = spread_mm(&peak_detection(distance_m, 20).1);
        println!("{distance_m} m: {mean_mm:.2} +- {twice_mm:.2} mm, thesis {thesis_mm}");
        squares += (mean_mm - thesis_mm) * (mean_mm - thesis_mm);
        assert!((9.0..13.0).contains(&twice_mm), "{distance_m} m: {twice_mm}");
    }
    let rms_mm = (squares / 6.0).sqrt();
    assert!(rms_mm < 0.5, "{rms_mm} mm rms from Table 5.2");
}

/// Likelihood within 15 % of the bound, pooled over the scenes, and without bias; the matched filter
/// within 1.8 times. One repeat: 300 histograms, so that a deviation is known to 4 %.
fn against_the_bound(profile: &str) {
    let bins = bins(profile);
    let (model, likelihood) =
        (Model::new(&acquisition(&bins)), Likelihood::new(&acquisition(&bins)));
    let (model, likelihood) = (model.unwrap(), likelihood.unwrap());
    let filter = MatchedFilter::new(&acquisition(&bins)).unwrap();
    for distance_m in DISTANCES_M {
        let (mut variance, mut likely, mut matched) = (0.0, Vec::new(), Vec::new());
        grid(distance_m, &bins, 1, |budget, histograms| {
            let bound_m = model.cramer_rao_m(&Echo::from(budget)).unwrap();
            variance += bound_m * bound_m / 300.0;
            for histogram in histograms {
                likely.push(likelihood.estimate(&histogram).unwrap() - distance_m);
                matched.push(filter.estimate(&histogram).unwrap() - distance_m);
            }
        });
        let bound_mm = 2e3 * f64::sqrt(variance);
        let ((mean_mm, likely_mm), (_, matched_mm)) = (spread_mm(&likely), spread_mm(&matched));
        println!("{profile} {distance_m} m: {bound_mm:.3} {likely_mm:.3} {matched_mm:.3} mm");
        assert!((0.85..1.15).contains(&(likely_mm / bound_mm)), "{likely_mm} {bound_mm}");
        // Four standard errors of the mean.
        assert!(mean_mm.abs() < 4.0 * bound_mm / 2.0 / 300f64.sqrt(), "{mean_mm} {bound_mm}");
        assert!(matched_mm < 1.8 * bound_mm, "{matched_mm} {bound_mm}");
    }
}

#[test]
fn maximum_likelihood_reaches_the_cramer_rao_bound_on_ideal_bins() {
    against_the_bound("ideal");
}

#[test]
fn maximum_likelihood_reaches_the_cramer_rao_bound_on_uneven_bins() {
    against_the_bound("uniform");
}
