//! The pulse that a calibration finds, against the one that drew the histograms, under fixed seeds.

use tofsim::Setup;
use tofsim::kernel::pulse::Pulse;
use tofsim::network::Histogram;
use tofsim::optics::{BinProbabilities, Bins, Budget, Hazard};
use tofsim::sensor::streams::{Source, stream};
use tofsim_learn::calibration::Sightings;
use tofsim_learn::calibration::goodness::Goodness;
use tofsim_learn::calibration::samples::sampled;
use tofsim_learn::calibration::scoring::climb;
use tofsim_learn::calibration::shape::{Formula, Shape, Width};
use tofsim_learn::estimation::Acquisition;

const SHOTS: u64 = 30_000;

fn bins() -> Bins {
    Setup::load("kc705", &[]).unwrap().bins()
}

/// Histograms of a pulse, from 0.15 to 0.6 m and over the reflectances of the thesis.
fn drawn(pulse: &Pulse, bins: &Bins, count: usize, seed: u64) -> Vec<Histogram> {
    let mut random = stream(seed, Source::Histogram, 0);
    let mut scenario = Setup::load("kc705", &[]).unwrap().scenario;
    let draw = |k: usize| {
        scenario.target.distance_m = 0.15 + 0.45 * k as f64 / count as f64;
        scenario.target.reflectance = 0.08 + 0.52 * ((k * 7) % 10) as f64 / 9.0;
        scenario.ambient.irradiance_w_m2_nm = 0.1;
        let hazard = Hazard::new(&Budget::new(&scenario, pulse.clone()));
        let counts = BinProbabilities::new(&hazard, bins).draw(SHOTS, &mut random);
        counts.into_iter().map(|count| count as u32).collect()
    };
    (0..count).map(draw).collect()
}

struct Found {
    width: Width,
    log_likelihood: f64,
    goodness: Goodness,
}

fn found(pulse: &Pulse, formula: Formula, count: usize, seed: u64) -> Found {
    let bins = bins();
    let start = Pulse::default();
    let acquisition = Acquisition::new(&bins, SHOTS, &start);
    let mut sightings = Sightings::new(&acquisition, drawn(pulse, &bins, count, seed)).unwrap();
    let climbed = climb(&acquisition, &mut sightings, Shape::new(formula, 137.0)).unwrap();
    let shape = climbed.shape;
    let goodness = Goodness::new(&acquisition, &sightings, &shape.pulse(), shape.free()).unwrap();
    let width = shape.width(&climbed.covariance);
    Found { width, log_likelihood: climbed.log_likelihood, goodness }
}

#[test]
fn the_width_of_a_gaussian_is_found_within_its_error() {
    let mut pulls = 0.0;
    for seed in 0..24 {
        let sigma_ps = 100.0 + 6.0 * seed as f64;
        let found = found(&Pulse::Gaussian { sigma_ps }, Formula::Gaussian, 6, seed);
        let pull = (found.width.sigma_ps - sigma_ps) / found.width.sigma_se_ps;
        assert!(found.width.sigma_se_ps < 0.01 * sigma_ps, "{:?}", found.width);
        assert!(pull.abs() < 4.0, "{sigma_ps}: {:?}", found.width);
        assert!(found.goodness.chance > 1e-4, "{:?}", found.goodness);
        pulls += pull * pull / 24.0;
    }
    assert!((0.4..1.8).contains(&pulls), "mean square of {pulls} deviations");
}

#[test]
fn a_tail_is_found_within_its_error_and_seen_to_be_missing() {
    let mut pulls = [0.0; 2];
    for seed in 0..16 {
        let tail_ps = 50.0 + 10.0 * seed as f64;
        let pulse = Pulse::tailed(120.0, tail_ps);
        let found = found(&pulse, Formula::Tail, 6, 100 + seed);
        let width = found.width;
        let both = [
            (width.sigma_ps - 120.0) / width.sigma_se_ps,
            (width.tail_ps - tail_ps) / width.tail_se_ps,
        ];
        assert!(both.iter().all(|pull| pull.abs() < 4.0), "{tail_ps}: {width:?}");
        pulls = [0, 1].map(|k| pulls[k] + both[k] * both[k] / 16.0);
    }
    assert!(pulls.iter().all(|pulls| (0.3..2.0).contains(pulls)), "{pulls:?}");
}

#[test]
fn a_gaussian_has_no_tail_and_a_tail_is_no_gaussian() {
    let gaussian = |formula| found(&Pulse::default(), formula, 8, 7);
    let [without, with] = [Formula::Gaussian, Formula::Tail].map(gaussian);
    let gain = with.log_likelihood - without.log_likelihood;
    assert!((-1e-3..4.5).contains(&gain), "{gain}");
    assert!(with.width.most_tail_ps < 80.0, "{:?}", with.width);
    let tail = |formula| found(&Pulse::tailed(120.0, 100.0), formula, 8, 7);
    let [without, with] = [Formula::Gaussian, Formula::Tail].map(tail);
    assert!(with.log_likelihood - without.log_likelihood > 100.0);
    assert!(without.goodness.chance < 1e-6, "{:?}", without.goodness);
    assert!(with.goodness.chance > 1e-3, "{:?}", with.goodness);
}

#[test]
fn a_pulse_with_two_humps_is_found_by_samples_alone() {
    let bins = bins();
    let hump = |t: f64, at: f64, sigma: f64| (-0.5 * ((t - at) / sigma).powi(2)).exp() / sigma;
    let density: Vec<_> = (0..160)
        .map(|k| hump(10.0 * k as f64, 500.0, 90.0) + 0.3 * hump(10.0 * k as f64, 900.0, 120.0))
        .collect();
    let truth = Pulse::Sampled(tofsim::kernel::pulse::Samples::new(10.0, &density).unwrap());
    let histograms = drawn(&truth, &bins, 100, 5);
    let start = Pulse::default();
    let acquisition = Acquisition::new(&bins, SHOTS, &start);
    let mut sightings = Sightings::new(&acquisition, histograms).unwrap();
    let climbed = climb(&acquisition, &mut sightings, Shape::new(Formula::Tail, 137.0)).unwrap();
    let formula = climbed.shape.pulse();
    let wrong = Goodness::new(&acquisition, &sightings, &formula, 2).unwrap();
    assert!(wrong.chance < 1e-9, "{wrong:?}");
    let measured = sampled(&acquisition, &mut sightings, &formula, 25.0).unwrap();
    let right =
        Goodness::new(&acquisition, &sightings, &measured.pulse, measured.density.len()).unwrap();
    println!("{right:?} after {wrong:?}");
    assert!(right.chi_square < 1.1 * right.degrees_of_freedom, "{right:?}");
    let worst = (-600..900).map(f64::from).map(|t| (measured.pulse.part(t) - truth.part(t)).abs());
    let worst = worst.fold(0.0, f64::max);
    println!("worst {worst}");
    assert!(worst < 0.01, "{worst}");
}
