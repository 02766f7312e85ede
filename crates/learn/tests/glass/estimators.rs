//! Depths behind glass: after a calibration, against the bound.

use tofsim_learn::estimation::likelihood::two_echoes::TwoEchoes;
use tofsim_learn::estimation::likelihood::{Likelihood, Model};
use tofsim_learn::estimation::matched_filter::MatchedFilter;
use tofsim_learn::estimation::{Estimator, Failure};

use super::bound::{echo, exact};
use super::*;

/// Detected photons per shot of the target.
pub const SIGNAL: f64 = 0.1;
pub const DISTANCES_M: [f64; 7] = [0.05, 0.1, 0.15, 0.2, 0.4, 0.6, 0.9];
/// The window's light over the target's.
pub const GLASS: [f64; 4] = [0.3, 1.0, 3.0, 10.0];

/// Depths of frames against the bound with a pedestal.
struct Errors {
    failures: usize,
    mean_mm: f64,
    mean_se_mm: f64,
    rms_mm: f64,
    bound_mm: f64,
}

fn errors(estimator: &dyn Estimator, bins: &Bins, light: &Light, frames: usize) -> Errors {
    let histograms = light.drawn(bins, frames, (light.distance_m * 1e3) as u64);
    let found: Vec<_> = histograms
        .iter()
        .filter_map(|one| Some(1e3 * (estimator.estimate(one).ok()? - light.distance_m)))
        .collect();
    let count = found.len() as f64;
    let mean_mm = found.iter().sum::<f64>() / count;
    let rms_mm = (found.iter().map(|mm| mm * mm).sum::<f64>() / count).sqrt();
    let template = exact(bins, light.glass);
    let model = Model::new(&acquisition(bins, Some(&template))).unwrap();
    let bound = model.cramer_rao_of(&[echo(light.signal, light.distance_m)], 1.0).unwrap();
    Errors {
        failures: frames - found.len(),
        mean_mm,
        mean_se_mm: rms_mm / count.sqrt(),
        rms_mm,
        bound_mm: 1e3 * bound[0],
    }
}

/// A template of so many frames.
pub fn template(bins: &Bins, glass: f64, frames: usize) -> GlassTemplate {
    let light = Light { glass, ..Light::DARK };
    calibrated(bins, &light.drawn(bins, frames, 99)).unwrap().template
}

fn print(glass: f64, light: &Light, found: &Errors) {
    println!(
        "| {glass} | {} | {:+.3} ± {:.3} | {:.3} | {:.3} | {:.3} | {} |",
        light.distance_m,
        found.mean_mm,
        found.mean_se_mm,
        found.rms_mm,
        found.bound_mm,
        found.rms_mm / found.bound_mm,
        found.failures
    );
}

fn rows(frames: usize, take: impl Fn(f64, &Light, &Errors)) {
    let bins = bins("kintex7");
    for glass in GLASS {
        let template = template(&bins, glass * SIGNAL, 500);
        let likelihood = Likelihood::new(&acquisition(&bins, Some(&template))).unwrap();
        for distance_m in DISTANCES_M {
            let light = Light { glass: glass * SIGNAL, signal: SIGNAL, distance_m, ..Light::DARK };
            take(glass, &light, &errors(&likelihood, &bins, &light, frames));
        }
    }
}

/// Measured with 2000 frames in `docs/cover-glass.md`.
#[test]
#[ignore = "long: ./check --full"]
fn likelihood_reaches_the_bound_behind_glass() {
    rows(300, |glass, light, found| {
        print(glass, light, found);
        let Errors { failures, mean_mm, mean_se_mm, rms_mm, bound_mm } = *found;
        assert!(mean_mm.abs() < 0.5 + 4.0 * mean_se_mm, "{glass} {light:?}: {mean_mm} mm");
        // Four standard deviations of a standard deviation from 300 frames above 1.1.
        assert!(rms_mm < bound_mm * 1.1 * (1.0 + 4.0 / 600f64.sqrt()), "{glass} {light:?}");
        assert_eq!(failures, 0, "{glass} {light:?}");
    });
}

#[test]
#[ignore = "prints a table of docs/cover-glass.md"]
fn prints_depths_behind_glass() {
    rows(2000, print);
}

#[test]
fn a_window_that_has_become_dirty_costs_no_bias_and_is_measured() {
    let bins = bins("ideal");
    let template = template(&bins, 0.4, 200);
    let likelihood = Likelihood::new(&acquisition(&bins, Some(&template))).unwrap();
    for amplitude in [0.0, 0.5, 1.0, 2.5] {
        let light = Light { glass: 0.4 * amplitude, signal: 0.2, distance_m: 0.3, ..Light::DARK };
        let (mut pulls, mut off_mm) = (0.0, 0.0);
        let histograms = light.drawn(&bins, 100, 17);
        for one in &histograms {
            let found = likelihood.find(one).unwrap();
            let pedestal = found.pedestal.unwrap();
            if amplitude > 0.0 {
                let error = pedestal.relative_se.hypot(0.003 * amplitude);
                pulls += ((pedestal.relative - amplitude) / error).powi(2) / 100.0;
            } else {
                assert!(pedestal.relative < 0.02, "{pedestal:?}");
            }
            assert!(pedestal.misfit.abs() < 5.0, "{amplitude}: {pedestal:?}");
            off_mm += 1e1 * (found.depth_m - 0.3);
        }
        assert!(off_mm.abs() < 0.5, "{amplitude}: {off_mm} mm");
        assert!(amplitude == 0.0 || (0.5..1.6).contains(&pulls), "{amplitude}: {pulls}");
    }
}

#[test]
fn another_shape_of_the_pedestal_is_a_misfit() {
    let bins = bins("ideal");
    // The template is half a pulse late.
    let mut rows = template(&bins, 0.4, 200).bins().to_vec();
    let hazards: Vec<_> = rows.iter().map(|bin| bin.hazard).collect();
    rows.iter_mut().enumerate().for_each(|(k, bin)| {
        bin.hazard = if k < 2 { 0.0 } else { hazards[k - 2] };
    });
    let moved = GlassTemplate::new("moved", rows).unwrap();
    let likelihood = Likelihood::new(&acquisition(&bins, Some(&moved))).unwrap();
    let light = Light { glass: 0.4, signal: 0.2, distance_m: 0.5, ..Light::DARK };
    for one in light.drawn(&bins, 20, 5) {
        if let Ok(found) = likelihood.find(&one) {
            assert!(found.pedestal.unwrap().misfit > 5.0, "{found:?}");
        }
    }
}

#[test]
fn two_targets_behind_glass_are_both_found_at_their_bound() {
    let bins = bins("kintex7");
    let template = template(&bins, 0.5, 500);
    let estimator = TwoEchoes::new(&acquisition(&bins, Some(&template))).unwrap();
    for (near_m, far_m) in [(0.15, 0.3), (0.25, 0.4), (0.4, 0.7)] {
        let light = Light { glass: 0.5, signal: 0.2, distance_m: near_m, second: (0.2, far_m) };
        let exact = exact(&bins, 0.5);
        let model = Model::new(&acquisition(&bins, Some(&exact))).unwrap();
        let bound = model.cramer_rao_of(&[echo(0.2, near_m), echo(0.2, far_m)], 1.0).unwrap();
        let mut squares = [0.0; 2];
        for one in light.drawn(&bins, 200, 6) {
            let found = estimator.find(&one).unwrap();
            let second = found.second.expect("both are clear");
            let off_m = [found.depth_m - near_m, second.depth_m - far_m];
            squares.iter_mut().zip(off_m).for_each(|(sum, off)| *sum += off * off / 200.0);
        }
        for (square, bound) in squares.iter().zip(bound) {
            let ratio = square.sqrt() / bound;
            println!("{near_m} {far_m}: {ratio:.3}");
            assert!((0.8..1.15 + 0.2).contains(&ratio), "{near_m} {far_m}: {ratio}");
        }
    }
}

#[test]
fn the_window_alone_is_no_target() {
    let bins = bins("ideal");
    let template = template(&bins, 1.0, 200);
    let acquisition = acquisition(&bins, Some(&template));
    let likelihood = Likelihood::new(&acquisition).unwrap();
    let (two, matched) =
        (TwoEchoes::new(&acquisition).unwrap(), MatchedFilter::new(&acquisition).unwrap());
    let light = Light { glass: 1.0, ..Light::DARK };
    let mut wrong = [0; 3];
    for one in light.drawn(&bins, 100, 21) {
        let estimators: [&dyn Estimator; 3] = [&likelihood, &two, &matched];
        for (wrong, estimator) in wrong.iter_mut().zip(estimators) {
            match estimator.estimate(&one) {
                Err(Failure::NoPeak | Failure::NoConvergence) => {}
                _ => *wrong += 1,
            }
        }
    }
    println!("{wrong:?}");
    assert!(wrong.iter().all(|wrong| *wrong <= 1), "{wrong:?}");
}

#[test]
fn the_matched_filter_sees_an_echo_beside_the_window() {
    let bins = bins("ideal");
    let template = template(&bins, 1.0, 200);
    let [with, without] = [Some(&template), None]
        .map(|glass| MatchedFilter::new(&acquisition(&bins, glass)).unwrap());
    for distance_m in [0.15, 0.3, 0.6] {
        let light = Light { glass: 1.0, signal: 0.1, distance_m, ..Light::DARK };
        for one in light.drawn(&bins, 20, 4) {
            let found_m = with.estimate(&one).unwrap();
            assert!((found_m - distance_m).abs() < 0.02, "{distance_m}: {found_m}");
            let window_m = without.estimate(&one).unwrap();
            assert!(window_m < 0.06, "{window_m}");
        }
    }
}

#[test]
fn a_template_is_refused_where_its_model_does_not_hold() {
    let bins = bins("ideal");
    let template = exact(&bins, 0.5);
    let own = acquisition(&bins, Some(&template));
    let jitter = Likelihood::new(&Acquisition { jitter_ps: 20.0, ..own }).unwrap_err();
    assert!(jitter.to_string().contains("estimator.glass_file: expected none where clock edges"));
    let setup = Setup::load("kc705", &["firmware.mode=1"]).unwrap();
    let free_running = Acquisition::of(&setup, &bins, SHOTS).free_running;
    let mode_1 = Acquisition { free_running, ..own };
    for error in [Likelihood::new(&mode_1).err(), MatchedFilter::new(&mode_1).err()] {
        let error = error.unwrap().to_string();
        assert!(error.contains("estimator.glass_file: expected none in MODE 1"), "{error}");
    }
    let other = super::bins("kintex7");
    let error = Likelihood::new(&acquisition(&other, Some(&template))).unwrap_err().to_string();
    assert!(error.contains("the limit of this instrument's bin"), "{error}");
    let name = |number| ("mine.npy".to_owned(), number);
    let error =
        GlassCalibration::new(&Acquisition { free_running, ..acquisition(&bins, None) }, &[], name);
    assert!(error.unwrap_err().to_string().contains("firmware.mode = 1: expected 0"));
}
