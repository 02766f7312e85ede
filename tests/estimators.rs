//! The estimators against scipy, the thesis's tables and the Cramér-Rao bound, under fixed seeds.

use proptest::prelude::*;
use tofsim::estimation::by_name::{Acquisition, Kind, Needs};
use tofsim::estimation::likelihood::{Likelihood, Scene};
use tofsim::estimation::matched_filter::MatchedFilter;
use tofsim::estimation::peak_detection::PeakDetection;
use tofsim::estimation::spline::Spline;
use tofsim::estimation::subtraction::Subtraction;
use tofsim::estimation::{Estimator, Failure, Pair};
use tofsim::firmware::centroid_estimator::Params;
use tofsim::kernel::Time;
use tofsim::network::{Histogram, Network};
use tofsim::optics::{BinProbabilities, Bins, Budget, Hazard};
use tofsim::scenario::builtin::Source as Place;
use tofsim::scenario::{Scenario, chain};
use tofsim::sensor::streams::{Source, stream};

/// Distances of the thesis's tables [m].
const DISTANCES_M: [f64; 6] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
/// Shots of a frame [shots].
const SHOTS: u64 = 30_000;

fn bins(profile: &str) -> Bins {
    let (delays, period) = (chain::load(profile, &Place::working_directory()).unwrap(), 8);
    let period = Time::from_ns(period);
    Bins::of_chain(&delays, &delays.calibration(period), period)
}

fn acquisition(bins: &Bins) -> Acquisition<'_> {
    Acquisition { bins, shots: SHOTS, pulse_sigma_ps: 137.0 }
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
        let budget = Budget::new(&scenario);
        let probabilities = BinProbabilities::new(&Hazard::new(&budget), bins);
        let draw = |_| probabilities.draw(SHOTS, &mut random).map(|count| count as u16);
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

/// The generator that `tests/reference/scipy_spline.py` has as well.
struct Lcg(u64);

impl Lcg {
    fn below(&mut self, limit: i64) -> i64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as i64 % limit
    }
}

#[test]
fn splines_on_any_knots_are_scipys() {
    for line in include_str!("reference/scipy_spline.csv").lines().skip(1) {
        let (seed, expected) = line.split_once(',').unwrap();
        let seed: u64 = seed.parse().unwrap();
        let mut lcg = Lcg(seed);
        let count = 2 + seed % 12;
        let mut knots = vec![lcg.below(1000)];
        (1..count).for_each(|k| knots.push(knots[k as usize - 1] + 1 + lcg.below(2000)));
        let values: Vec<_> = (0..count).map(|_| lcg.below(20_000) - 10_000).collect();
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        let thousandths = |part: &[i64]| part.iter().map(|&k| k as f64 / 1e3).collect::<Vec<_>>();
        let spline = Spline::new(&thousandths(&knots), &thousandths(&values)).unwrap();
        for expected in expected.split(' ') {
            let place = first - 100 + lcg.below(last - first + 200);
            let (found, expected): (f64, f64) =
                (spline.at(place as f64 / 1e3), expected.parse().unwrap());
            assert!(
                (found - expected).abs() < 1e-9 * (1.0 + expected.abs()),
                "{seed}: {found} {expected}"
            );
        }
    }
}

/// A falling slope with noise, and one to three triangular echoes.
fn sketch(seed: u64) -> Histogram {
    let mut lcg = Lcg(seed);
    let (start, fall) = (lcg.below(400), lcg.below(4));
    let slope = |k: i64| (start - fall * k).max(0);
    let mut counts: Vec<_> = (0..256).map(|k| slope(k) + lcg.below(1 + start / 4)).collect();
    for _ in 0..1 + lcg.below(3) {
        let (centre, height, half) = (lcg.below(256), lcg.below(700), 4 + lcg.below(30));
        for (k, count) in (0..).zip(&mut counts) {
            *count += height * (half - (k - centre).abs()).max(0) / half;
        }
    }
    std::array::from_fn(|bin| counts[bin] as u16)
}

#[test]
fn the_peaks_of_a_thousand_histograms_are_scipys() {
    let mut expected = vec![Vec::new(); 1000];
    for line in include_str!("reference/scipy_peaks.csv").lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        expected[row[0] as usize].push([row[1], row[2], row[3]]);
    }
    let detection = PeakDetection::new(SHOTS);
    for (seed, expected) in expected.iter().enumerate() {
        let found = detection.peaks(&sketch(seed as u64).map(f64::from)).unwrap();
        assert_eq!(found.len(), expected.len(), "{seed}: {found:?}");
        for (found, expected) in found.iter().zip(expected) {
            let found = [found.location, found.width, found.prominence];
            for (found, expected) in found.iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 1e-9, "{seed}: {found} {expected}");
            }
        }
    }
    assert!(expected.iter().filter(|peaks| peaks.len() > 1).count() > 400);
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
    let likelihood = Likelihood::new(&acquisition(&bins)).unwrap();
    let filter = MatchedFilter::new(&acquisition(&bins)).unwrap();
    for distance_m in DISTANCES_M {
        let (mut variance, mut likely, mut matched) = (0.0, Vec::new(), Vec::new());
        grid(distance_m, &bins, 1, |budget, histograms| {
            let bound_m = likelihood.model().cramer_rao_m(&Scene::from(budget)).unwrap();
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
        let budget = Budget::new(&scenario);
        let with = |hazard| BinProbabilities::new(&hazard, &bins);
        let (on, off) = (with(Hazard::new(&budget)), with(Hazard::dark(&budget)));
        let mut random = stream(5, Source::Histogram, 0);
        let (mut left, mut right) = (0.0, 0.0);
        for _ in 0..100 {
            let mut draw = |of: &BinProbabilities| of.draw(15_000, &mut random).map(|n| n as u16);
            let (on, off) = (draw(&on), draw(&off));
            let difference = Pair { dark: off, lit: on }.difference();
            let mean = |part: &[i32]| part.iter().sum::<i32>() as f64 / part.len() as f64 / 100.0;
            left += mean(&difference[..140]);
            right += mean(&difference[180..]);
            let subtraction = Subtraction { detection: PeakDetection::new(2 * 15_000) };
            let found = subtraction.estimate_pair(&Pair { dark: off, lit: on });
            successes[0] += found.is_ok() as usize;
            let detection = PeakDetection::new(15_000);
            successes[1] += detection.estimate(&on).is_ok() as usize;
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
            let mut draw = |k: usize| codes[k].draw(SHOTS / 2, &mut random).map(|n| n as u16);
            let pair = Pair { dark: draw(0), lit: draw(1) };
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

fn any_histogram() -> impl Strategy<Value = Histogram> {
    let counts = prop_oneof![
        prop::collection::vec(any::<u16>(), 256),
        prop::collection::vec(0u16..200, 256),
        prop::collection::vec(prop_oneof![9 => Just(0u16), 1 => 0u16..3000], 256),
        any::<u16>().prop_map(|count| vec![count; 256]),
        (0..256usize, any::<u16>(), 0u16..80).prop_map(|(bin, count, floor)| {
            let mut counts = vec![floor; 256];
            counts[bin] = count;
            counts
        }),
    ];
    counts.prop_map(|counts| std::array::from_fn(|bin| counts[bin]))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_histogram_makes_an_estimator_panic_or_answer_with_nonsense(
        histogram in any_histogram(),
        profile in prop::sample::select(vec!["ideal", "uniform", "table6_3"]),
        shots in prop::sample::select(vec![1u64, 500, 30_000, 65_535]),
    ) {
        let (bins, network) = (bins(profile), Network::builtin("ideal").unwrap().unwrap());
        let acquisition = Acquisition { shots, ..acquisition(&bins) };
        let needs = Needs { acquisition, network: &network, centroid: &Params::default() };
        for kind in [Kind::Network, Kind::NetworkFloat, Kind::Peak, Kind::Likelihood, Kind::Matched] {
            match kind.estimator(&needs).unwrap().estimate(&histogram) {
                Ok(distance_m) => prop_assert!(distance_m.abs() < 50.0, "{kind:?} {distance_m}"),
                Err(failure) => prop_assert!(!failure.to_string().is_empty()),
            }
        }
        let subtraction = Subtraction { detection: PeakDetection::new(shots) };
        let found = subtraction.estimate_pair(&Pair { dark: [200; 256], lit: histogram });
        prop_assert!(found.is_err() || found.is_ok_and(f64::is_finite));
    }
}

#[test]
fn an_empty_histogram_has_no_distance() {
    let (bins, network) = (bins("uniform"), Network::builtin("uniform").unwrap().unwrap());
    let (acquisition, centroid) = (acquisition(&bins), &Params::default());
    let needs = Needs { acquisition, network: &network, centroid };
    for kind in [Kind::Peak, Kind::Likelihood, Kind::Matched] {
        assert_eq!(kind.estimator(&needs).unwrap().estimate(&[0; 256]), Err(Failure::NoHits));
    }
}
