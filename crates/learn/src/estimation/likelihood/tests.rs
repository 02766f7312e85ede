use tofsim::firmware::carry_chain::{Delays, TAPS};
use tofsim::firmware::tdc;
use tofsim::kernel::Time;
use tofsim::kernel::pulse::Pulse;
use tofsim::optics::{BinProbabilities, Bins, Budget, Hazard};

use super::super::acquisition::{FreeRunning, most_probable};
use super::*;

/// A chain of taps that are alike.
fn even(tap_fs: i64, offset_ps: u64) -> Bins {
    let delays = Delays::new(Time::from_fs(offset_ps * 1000), &[tap_fs; TAPS]).unwrap();
    Bins::of_tdc(&tdc::Params::of_chain(delays))
}

/// A chain whose taps are far from alike, and whose ROM leaves holes.
fn uneven() -> Bins {
    let delays: Vec<_> = (0..TAPS as i64).map(|k| (k * k * 7919) % 44_000 - 10_000).collect();
    let delays = Delays::new(Time::from_fs(2_500_000), &delays).unwrap();
    let mut params = tdc::Params::of_chain(delays);
    params.decoder.cal[300..310].fill(tofsim::kernel::U::new(0));
    Bins::of_tdc(&params)
}

fn likelihood(bins: &Bins) -> Likelihood {
    Likelihood::new(&Acquisition::new(bins, 30_000, &Pulse::Gaussian { sigma_ps: 137.0 })).unwrap()
}

fn scenes() -> [Echo; 4] {
    let scene =
        |arrival_ps, signal, background_per_ps| Echo { arrival_ps, signal, background_per_ps };
    [
        scene(667.0, 39.0, 9.5e-4),
        scene(2000.0, 0.5, 1e-10),
        scene(3336.0, 0.9, 4e-4),
        scene(4003.0, 0.14, 1e-4),
    ]
}

fn budget(scene: &Echo) -> Budget {
    Budget {
        signal_per_shot: scene.signal,
        ambient_rate_hz: scene.background_per_ps * 1e12,
        mean_arrival: Time::from_ps_f64(scene.arrival_ps),
        ..Budget::default()
    }
}

/// The most probable histogram of a scene.
fn expected(bins: &Bins, scene: &Echo) -> Vec<u32> {
    let probabilities = BinProbabilities::new(&Hazard::new(&budget(scene)), bins);
    most_probable(probabilities.of_code(), 30_000)
}

#[test]
fn the_gradient_is_the_difference_of_log_likelihoods() {
    for bins in [even(12_500, 2_000), even(11_500, 2_230), uneven()] {
        let model = likelihood(&bins).model;
        for scene in scenes() {
            let histogram = expected(&bins, &Echo { arrival_ps: scene.arrival_ps + 20.0, ..scene });
            let at = model.coordinates(&scene);
            let (gradient, _) = model.slope(&at, &histogram);
            for k in 0..3 {
                let small = if k == 2 { at[2] * 1e-4 } else { 1e-5 };
                let value = |step: f64| {
                    let mut there = at;
                    there[k] += step;
                    model.log_likelihood(&there, &histogram)
                };
                let difference = (value(small) - value(-small)) / (2.0 * small);
                let error = (gradient[k] - difference).abs();
                assert!(error < 1e-3 + 1e-4 * difference.abs(), "{k} {scene:?}: {gradient:?}");
            }
        }
    }
}

#[test]
fn the_information_is_the_curvature_at_the_expected_histogram() {
    let bins = even(12_500, 2_000);
    let model = likelihood(&bins).model;
    for scene in [scenes()[0], scenes()[2]] {
        let at = model.coordinates(&scene);
        let histogram = expected(&bins, &scene);
        let (_, information) = model.slope(&at, &histogram);
        for k in 0..3 {
            let gradient = |step: f64| {
                let mut there = at;
                there[k] += step;
                model.slope(&there, &histogram).0
            };
            let (after, before) = (gradient(1e-5), gradient(-1e-5));
            for l in 0..3 {
                let curvature = (before[l] - after[l]) / 2e-5;
                let scale = (information[k][k] * information[l][l]).sqrt();
                // Counts are rounded, and Phi is a broken line there.
                let error = (information[k][l] - curvature).abs() / scale;
                assert!(error < 0.02, "{k} {l} {scene:?}: {error}");
            }
        }
    }
}

#[test]
fn the_scene_of_an_expected_histogram_is_found_again() {
    for bins in [even(12_500, 2_000), even(11_500, 2_230), uneven()] {
        let likelihood = likelihood(&bins);
        for scene in scenes() {
            let fit = likelihood.fit(&expected(&bins, &scene)).unwrap();
            let error = (fit.echo.arrival_ps - scene.arrival_ps) / fit.arrival_deviation_ps;
            assert!(error.abs() < 0.5, "{scene:?}: {fit:?}");
            let bound_m = likelihood.model.cramer_rao_m(&scene).unwrap();
            let deviation_m = fit.arrival_deviation_ps / ARRIVAL_PS_PER_M;
            assert!((deviation_m / bound_m - 1.0).abs() < 0.05, "{scene:?}: {fit:?} {bound_m}");
        }
    }
}

#[test]
fn both_echoes_of_an_expected_histogram_are_found_again() {
    let bins = even(11_500, 2_230);
    let likelihood = likelihood(&bins);
    for (apart_ps, signal) in [(300.0, 0.6), (300.0, 2.0), (700.0, 0.1), (2000.0, 0.2)] {
        let scene = scenes()[2];
        let other =
            Echo { arrival_ps: scene.arrival_ps + apart_ps, signal, background_per_ps: 0.0 };
        let hazard = |echo: &Echo| Hazard::new(&budget(echo));
        let together = BinProbabilities::of_all(&[hazard(&scene), hazard(&other)], &bins);
        let histogram = most_probable(together.of_code(), 30_000);
        let alone = likelihood.fit(&histogram).unwrap();
        let both = likelihood.fit_both(&histogram, &alone).unwrap();
        for (fit, echo) in [(both.first, scene), (both.second, other)] {
            let error = (fit.echo.arrival_ps - echo.arrival_ps) / fit.arrival_deviation_ps;
            assert!(error.abs() < 0.5, "{apart_ps} ps, {signal}: {both:?}");
        }
    }
}

#[test]
fn one_echo_has_no_second() {
    let bins = even(11_500, 2_230);
    let likelihood = likelihood(&bins);
    for scene in scenes() {
        let histogram = expected(&bins, &scene);
        let alone = likelihood.fit(&histogram).unwrap();
        assert_eq!(likelihood.fit_both(&histogram, &alone), None);
    }
}

#[test]
fn what_is_no_echo_fails() {
    let bins = even(12_500, 2_000);
    let likelihood = likelihood(&bins);
    assert_eq!(likelihood.fit(&[0; 256]), Err(Failure::NoHits));
    let failure = Failure::TooManyHits { hits: 256 * 200, most: 30_000 };
    assert_eq!(likelihood.fit(&[200; 256]), Err(failure));
    assert_eq!(likelihood.fit(&[20; 256]), Err(Failure::NoPeak));
    let mut few = [0; 256];
    (few[100], few[103]) = (2, 1);
    assert_eq!(likelihood.fit(&few), Err(Failure::NoPeak));
}

#[test]
fn a_histogram_narrower_than_the_pulse_is_answered_or_refused_but_not_by_nan() {
    let bins = even(12_500, 2_000);
    let likelihood = likelihood(&bins);
    for bin in [0, 1, 100, 255] {
        for count in [1, 20, 1000, 30_000] {
            let mut histogram = [0; 256];
            histogram[bin] = count;
            if let Ok(fit) = likelihood.fit(&histogram) {
                let centre_ps = (bin as f64 + 0.5) * 25.0;
                let error_ps = fit.echo.arrival_ps - centre_ps;
                assert!(error_ps.abs() < 10.0 * 137.0, "{bin} {count}: {fit:?}");
            }
        }
    }
}

#[test]
fn the_bound_is_the_textbooks_where_nothing_disturbs() {
    // A faint pulse, no background, wide range: sigma / sqrt(photons), but for the width of a bin.
    let bins = even(12_500, 2_000);
    let model = likelihood(&bins).model;
    let scene = Echo { arrival_ps: 3000.0, signal: 1e-3, background_per_ps: 0.0 };
    let photons = 30_000.0 * 1e-3f64;
    let expected_m = 137.0 / photons.sqrt() / ARRIVAL_PS_PER_M;
    let found = model.cramer_rao_m(&scene).unwrap() / expected_m;
    assert!((0.99..1.02).contains(&found), "{found}");
    assert_eq!(model.cramer_rao_m(&Echo { arrival_ps: 1e6, ..scene }), None);
}

/// MODE 1 of the default scenario.
const FREE: FreeRunning = FreeRunning {
    period_ps: 48_000.0,
    dead_ps: 20_000.0,
    cycle_ps: 8_000.0,
    tap_0_ps: 2_230.0,
    chain_ps: 11_418.5,
};

#[test]
fn the_scene_of_an_expected_histogram_is_found_again_with_jitter_and_in_mode_1() {
    let bins = even(11_500, 2_230);
    let steady = Acquisition::new(&bins, 30_000, &Pulse::Gaussian { sigma_ps: 137.0 });
    let free_running = Acquisition { free_running: Some(FREE), ..steady };
    for acquisition in [Acquisition { jitter_ps: 70.0, ..steady }, free_running] {
        let likelihood = Likelihood::new(&acquisition).unwrap();
        for scene in scenes() {
            let scene = Echo { background_per_ps: scene.background_per_ps.min(4e-4), ..scene };
            let fit = likelihood
                .fit(&most_probable(&likelihood.model.probabilities(&scene), 30_000))
                .unwrap();
            let error = (fit.echo.arrival_ps - scene.arrival_ps) / fit.arrival_deviation_ps;
            assert!(error.abs() < 0.5, "{scene:?}: {fit:?}");
        }
    }
}

#[test]
fn a_diode_that_is_always_back_in_time_is_as_one_that_is_armed_for_each_shot() {
    // Without background the only avalanche of a shot is the echo's, long before the next one.
    let bins = even(11_500, 2_230);
    let steady = Acquisition::new(&bins, 30_000, &Pulse::Gaussian { sigma_ps: 137.0 });
    let free_running = Acquisition { free_running: Some(FREE), ..steady };
    let scene = Echo { arrival_ps: 2000.0, signal: 5.0, background_per_ps: 1e-12 };
    let [expected, found] = [steady, free_running]
        .map(|acquisition| Model::new(&acquisition).unwrap().probabilities(&scene));
    for (code, (found, expected)) in found.iter().zip(expected).enumerate().take(180) {
        assert!((found - expected).abs() < 1e-3, "{code}: {found} {expected}");
    }
    assert_eq!(found[200], 0.0, "a code that the second edge may have seen has no cell");
}
