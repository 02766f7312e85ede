//! The template that a calibration finds, against the light that drew its histograms.

use super::*;

#[test]
fn the_hazards_are_those_of_the_light_within_their_errors() {
    for (profile, glass) in [("ideal", 0.3), ("kintex7", 2.0)] {
        let (bins, light) = (bins(profile), Light { glass, ..Light::DARK });
        let found = calibrated(&bins, &light.drawn(&bins, 100, 3)).unwrap();
        let (mut squares, mut count) = (0.0, 0.0);
        for (code, bin) in found.template.bins().iter().enumerate() {
            let spans = bins.spans().iter().filter(|span| usize::from(span.code) == code);
            let of_glass = |time: tofsim::kernel::Time| {
                let t_ps = time.fs() as f64 * 1e-3;
                light.until(t_ps) - AMBIENT * t_ps
            };
            let expected: f64 = spans.map(|span| of_glass(span.until) - of_glass(span.from)).sum();
            if bin.hazard > 0.0 {
                squares += ((bin.hazard - expected) / bin.hazard_se).powi(2);
                count += 1.0;
            } else {
                assert!(expected < 1e-5 * glass, "{profile} {code}: {expected}");
            }
        }
        // Four standard deviations of a chi square.
        let off = f64::abs(squares / count - 1.0);
        assert!(count > 20.0 && off < 4.0 * f64::sqrt(2.0 / count), "{profile}: {squares} {count}");
        let [photons, photons_se] = found.photons;
        assert!((photons - glass).abs() < 4.0 * photons_se, "{photons} +- {photons_se}");
        assert!((found.delay_ps[0] - 190.0).abs() < 15.0, "{:?}", found.delay_ps);
        let [rate, rate_se] = found.ambient_per_ps;
        assert!((rate - AMBIENT).abs() < 4.0 * rate_se && rate_se < 0.03 * AMBIENT, "{rate}");
        assert!(found.support_ps[1] < 1500.0, "{:?}", found.support_ps);
    }
}

/// With the naive formula, bin by bin: -ln(1 - n / R) less the ambient light.
#[test]
fn a_hazard_is_the_part_of_the_waiting_shots_without_ambient_light() {
    let bins = bins("ideal");
    let histograms = Light { glass: 1.0, ..Light::DARK }.drawn(&bins, 20, 5);
    let found = calibrated(&bins, &histograms).unwrap();
    let mut waiting = 20.0 * SHOTS as f64;
    for (code, bin) in found.template.bins().iter().enumerate() {
        let hits: f64 = histograms.iter().map(|one| f64::from(one[code])).sum();
        let width_ps = bin.until_ps - bin.from_ps;
        let hazard = -(1.0 - hits / waiting).ln() - width_ps * found.ambient_per_ps[0];
        if bin.hazard > 0.0 {
            assert!((bin.hazard - hazard).abs() < 1e-12, "{code}");
            // Greenwood: a hit takes more of the few that wait.
            let counted = hits / (waiting * (waiting - hits));
            let se = (counted + (width_ps * found.ambient_per_ps[1]).powi(2)).sqrt();
            assert!((bin.hazard_se / se - 1.0).abs() < 1e-9, "{code}");
        }
        waiting -= hits;
    }
}

/// Of 400 calibrations: spread of the amplitude over its standard error.
#[test]
fn standard_errors_are_those_of_repeated_calibrations() {
    let bins = bins("ideal");
    let light = Light { glass: 2.5, ..Light::DARK };
    let (mut pulls, mut of_bins, mut count) = (0.0, 0.0, 0.0);
    let late = 24;
    let [from, until] =
        [late, late + 1].map(|bin| light.until(25.0 * bin as f64) - 25.0 * AMBIENT * bin as f64);
    for seed in 0..200 {
        let found = calibrated(&bins, &light.drawn(&bins, 2, 100 + seed)).unwrap();
        pulls += ((found.photons[0] - light.glass) / found.photons[1]).powi(2);
        let bin = found.template.bins()[late];
        of_bins += ((bin.hazard - (until - from)) / bin.hazard_se).powi(2);
        count += 1.0;
    }
    for squares in [pulls, of_bins] {
        let ratio = (squares / count).sqrt();
        assert!((0.85..1.15).contains(&ratio), "{ratio}");
    }
}

/// Returns where a refusal of histograms has seen a target [m].
fn refused_m(error: &str) -> f64 {
    let at = error.split("a target at ").nth(1).unwrap_or_else(|| panic!("{error}"));
    at.split(' ').next().unwrap().parse().unwrap()
}

#[test]
fn a_target_is_detected_and_refused() {
    let bins = bins("kintex7");
    for (distance_m, signal) in
        [(0.15, 0.01), (0.15, 1.0), (0.3, 0.005), (0.6, 0.01), (0.85, 0.02), (0.9, 2.0)]
    {
        for glass in [0.1, 1.0] {
            let light = Light { glass, signal, distance_m, ..Light::DARK };
            let found = calibrated(&bins, &light.drawn(&bins, 100, 7));
            let error = found.err().unwrap_or_else(|| panic!("{light:?}: accepted"));
            assert!((refused_m(&error) - distance_m).abs() < 0.03, "{light:?}: {error}");
            // A strong one next to the window is the first that is seen.
            let is_named = error.starts_with("mine.npy: histogram = ");
            assert!(is_named || signal > 5.0 * glass, "{light:?}: {error}");
        }
    }
    // Next to the window, an echo shows if there is a dip before it.
    let light = Light { glass: 0.5, signal: 0.25, distance_m: 0.1, ..Light::DARK };
    let error = calibrated(&bins, &light.drawn(&bins, 100, 7)).expect_err("refused");
    assert!((refused_m(&error) - 0.1).abs() < 0.03, "{error}");
    // Without a window, a target is no pedestal.
    let light = Light { signal: 0.5, distance_m: 0.4, ..Light::DARK };
    let error = calibrated(&bins, &light.drawn(&bins, 10, 8)).unwrap_err();
    assert!(error.contains("histograms = all: a target at ") && error.contains("within 0.1 m"));
    assert!((refused_m(&error) - 0.4).abs() < 0.02, "{error}");
}

#[test]
fn one_histogram_with_a_target_among_others_is_named() {
    let bins = bins("ideal");
    let mut histograms = Light { glass: 0.5, ..Light::DARK }.drawn(&bins, 60, 9);
    let odd = Light { glass: 0.5, signal: 0.01, distance_m: 0.5, ..Light::DARK };
    histograms[17] = odd.drawn(&bins, 1, 10).remove(0);
    let error = calibrated(&bins, &histograms).unwrap_err();
    assert!(error.starts_with("mine.npy: histogram = 17: a target at "), "{error}");
    assert!((refused_m(&error) - 0.5).abs() < 0.02, "{error}");
    // The same of a near one, which the pedestal hides in the sum.
    let near = Light { glass: 0.5, signal: 0.1, distance_m: 0.06, ..Light::DARK };
    histograms[17] = near.drawn(&bins, 1, 11).remove(0);
    let error = calibrated(&bins, &histograms).unwrap_err();
    assert!(error.starts_with("mine.npy: histogram = 17: at 0.0"), "{error}");
    assert!(error.contains("differs from the other histograms"), "{error}");
}

#[test]
fn histograms_without_a_target_are_accepted() {
    let bins = bins("kintex7");
    for seed in 0..60 {
        let light = Light { glass: [0.02, 0.3, 3.0][seed as usize % 3], ..Light::DARK };
        let found = calibrated(&bins, &light.drawn(&bins, 40, 1000 + seed));
        assert!(found.is_ok(), "{seed}: {found:?}");
        let [change, change_se] = found.unwrap().change.unwrap();
        assert!(change.abs() < 4.5 * change_se, "{seed}: {change} +- {change_se}");
    }
}

#[test]
fn a_slow_change_of_the_window_is_measured() {
    let bins = bins("ideal");
    let mut all = Vec::new();
    for k in 0..40 {
        let glass = 0.5 * (1.0 + 0.02 * (f64::from(k) / 39.0 - 0.5));
        all.extend(Light { glass, ..Light::DARK }.drawn(&bins, 1, 50 + k as u64));
    }
    let [change, change_se] = calibrated(&bins, &all).unwrap().change.unwrap();
    assert!((change - 0.02).abs() < 4.0 * change_se && change_se < 0.006, "{change} {change_se}");
}

#[test]
fn what_shows_no_pedestal_is_refused() {
    let bins = bins("ideal");
    let error = calibrated(&bins, &Light::DARK.drawn(&bins, 5, 1)).unwrap_err();
    assert!(error.contains("pedestal = none: expected light of a cover window"), "{error}");
    let error = calibrated(&bins, &[]).unwrap_err();
    assert_eq!(error, "calibrate glass: expected a histogram at least");
    let strong = Light { glass: 14.0, ..Light::DARK };
    let error = calibrated(&bins, &strong.drawn(&bins, 2, 1)).unwrap_err();
    assert!(error.contains("shots used up at = ") && error.contains("pile-up"), "{error}");
}
