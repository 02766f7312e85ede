//! Targets of other shapes, and fog, from the scenario to the histogram.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use tofsim::Setup;
use tofsim::optics::budget::LIGHT_M_S;
use tofsim::optics::{BinProbabilities, Hazard};

use crate::common::{frames, setup};

/// Chance of each code in a shot.
fn chances(setup: &Setup) -> Vec<f64> {
    BinProbabilities::new(&Hazard::new(&setup.budget), &setup.bins()).of_code().to_vec()
}

/// Returns the local maxima of the codes' probabilities that are at least a tenth of the largest, refined by a
/// parabola through the logarithms [m].
fn peaks_m(chances: &[f64]) -> Vec<f64> {
    let (reach, most) = (20, chances.iter().copied().fold(0.0, f64::max));
    let is_peak = |bin: &usize| {
        let around = &chances[bin - reach..=bin + reach];
        chances[*bin] > 0.1 * most && around.iter().all(|chance| *chance <= chances[*bin])
    };
    let centre = |bin: usize| {
        let [before, at, after] = [bin - 4, bin, bin + 4].map(|bin| chances[bin].ln());
        bin as f64 + 0.5 + 4.0 * 0.5 * (before - after) / (before - 2.0 * at + after)
    };
    let peaks = (reach..chances.len() - reach).filter(is_peak);
    peaks.map(|bin| centre(bin) * 25e-12 * LIGHT_M_S / 2.0).collect()
}

#[test]
fn a_step_edge_gives_two_peaks_at_its_two_distances() {
    // So faint that pile-up moves nothing, and a narrow beam, in which all ways to a part are as long.
    let keys = [
        "tdc.profile=ideal",
        "target.shape=step",
        "target.distance_m=0.3",
        "target.second_distance_m=0.75",
        "laser.field_of_illumination_deg=2",
        "ambient.irradiance_w_m2_nm=0",
        "spad.pdp=1e-6",
    ];
    let found = peaks_m(&chances(&setup("kc705", &keys)));
    assert_eq!(found.len(), 2, "{found:?}");
    assert!((found[0] - 0.3).abs() < 1e-3 && (found[1] - 0.75).abs() < 1e-3, "{found:?}");
    let one = peaks_m(&chances(&setup("kc705", &[&keys[..], &["target.edge_m=9"]].concat())));
    assert!(one.len() == 1 && (one[0] - 0.3).abs() < 1e-3, "{one:?}");
}

#[test]
fn the_worked_examples_are_what_they_say() {
    let fog = setup("fog", &[]);
    assert!((0.6..0.7).contains(&fog.budget.transmission), "{}", fog.budget.transmission);
    assert!(fog.budget.backscatter_per_shot > 0.0);
    let step = peaks_m(&chances(&setup("step", &[])));
    assert_eq!(step.len(), 2, "{step:?}");
}

#[test]
fn a_run_counts_what_the_closed_form_expects_of_each_scene() {
    let glass = ["cover.fraction=1.5e-4", "cover.smear_fraction=0.3", "laser.delay_ps=500"];
    let net = ["target.second_share=0.4", "target.second_distance_m=0.25"];
    let varied = ["laser.timing_jitter_ps=100", "laser.energy_jitter=0.2"];
    let [both, varied] = [[&glass[..], &net].concat(), [&glass[..], &varied].concat()];
    let scenes: [&[&str]; 10] = [
        &glass,
        &net,
        &both,
        &varied,
        &["atmosphere.visibility_m=5"],
        &["target.shape=sphere", "atmosphere.rain_mm_h=200"],
        &["target.shape=step", "target.distance_m=0.3", "target.tilt_deg=20"],
        &["target.yaw_deg=70", "target.length_m=2"],
        &["target.shape=disc", "target.retro_side_m=0.01"],
        &["atmosphere.visibility_m=2", "laser.timing_jitter_ps=100", "laser.energy_jitter=0.2"],
    ];
    for keys in scenes {
        let setup = setup("kc705", keys);
        let expected = chances(&setup);
        let (count, shots) = (20, 30_000.0);
        let mut sums = vec![0.0; expected.len() + 1];
        for frame in frames(&setup, count) {
            sums.iter_mut().zip(&frame.histogram).for_each(|(sum, hits)| *sum += f64::from(*hits));
        }
        let all = shots * count as f64;
        sums[expected.len()] = all - sums.iter().sum::<f64>();
        let none = 1.0 - expected.iter().sum::<f64>();
        let cells = sums.iter().zip(expected.iter().chain([&none])).map(|(sum, p)| (sum, all * p));
        let cells: Vec<_> = cells.filter(|(_, mean)| *mean > 5.0).collect();
        let chi2: f64 = cells.iter().map(|(sum, mean)| (*sum - mean).powi(2) / mean).sum();
        let p = 1.0 - ChiSquared::new(cells.len() as f64 - 1.0).unwrap().cdf(chi2);
        println!("{keys:?}: p = {p:.3}");
        assert!(p > 1e-3, "{keys:?}: chi-square {chi2} of {} cells, p = {p:e}", cells.len());
    }
}

#[test]
fn what_passes_through_no_air_and_meets_a_plain_rectangle_is_what_it_was() {
    let plain = setup("kc705", &[]);
    // Keys that nothing asks for.
    let idle = ["target.radius_m=3", "atmosphere.overlap_m=0.5", "target.edge_m=0.1"];
    let same = setup("kc705", &idle);
    assert_eq!(plain.budget, same.budget);
    assert_eq!(frames(&plain, 1), frames(&same, 1));
    // Before there were other scenes.
    assert_eq!(plain.budget.signal_per_shot, 0.893_708_312_109_351_8);
}
