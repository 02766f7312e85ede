//! Photon counts against the link budget, and the fast samplers against a slow one, under fixed seeds.

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp, Normal, Poisson};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use tofsim::firmware::carry_chain::{Delays, TAPS};
use tofsim::firmware::tdc;
use tofsim::kernel::Time;
use tofsim::kernel::pulse::Pulse;
use tofsim::optics::eye_safety::maximum_average_power_w;
use tofsim::optics::variation::Variation;
use tofsim::optics::{BinProbabilities, Bins, Budget, Hazard};
use tofsim::scenario::{AmbientModel, Laser, Scenario};
use tofsim::sensor::light::Light;
use tofsim::sensor::spad::Spads;
use tofsim::sensor::streams::{exponential, normal};

/// Distances of the thesis's tables [m].
const DISTANCES_M: [f64; 6] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
/// Clock period of the TDC.
/// A test fails if its chi-square is larger than chance would make it once in so many runs.
const LEVEL: f64 = 1e-3;

/// A scene of distance [m], reflectance and irradiance [W/m^2/nm].
fn scene(distance_m: f64, reflectance: f64, irradiance_w_m2_nm: f64) -> Scenario {
    let mut scenario = Scenario::default();
    scenario.target.distance_m = distance_m;
    scenario.target.reflectance = reflectance;
    scenario.ambient.irradiance_w_m2_nm = irradiance_w_m2_nm;
    scenario
}

fn budget(scenario: &Scenario) -> Budget {
    Budget::new(scenario, Pulse::default())
}

/// Near (some photons would come before the laser edge), bright, dim, dark, laser off, a pulse with a tail,
/// a laser that jitters, near and far, and light that leaves late.
fn scenes() -> [(&'static str, Budget); 9] {
    let tailed = Pulse::tailed(100.0, 250.0);
    let variation =
        Variation::of(&Laser { timing_jitter_ps: 200.0, energy_jitter: 0.4, ..Laser::default() });
    let mut off = budget(&scene(0.5, 0.34, 0.2));
    off.signal_per_shot = 0.0;
    let mut late = scene(0.1, 0.60, 0.4);
    late.laser.delay_ps = 1800.0;
    [
        ("near", budget(&scene(0.1, 0.60, 0.4))),
        ("bright", budget(&scene(0.6, 0.60, 0.4))),
        ("dim", budget(&scene(0.6, 0.08, 0.05))),
        ("dark", budget(&scene(0.5, 0.34, 0.0))),
        ("laser off", off),
        ("jitter, near", Budget { variation, ..budget(&scene(0.1, 0.60, 0.4)) }),
        ("jitter", Budget { variation, ..budget(&scene(0.4, 0.60, 0.1)) }),
        ("tail", Budget { pulse: tailed, ..budget(&scene(0.3, 0.60, 0.1)) }),
        ("delay", budget(&late)),
    ]
}

fn assert_close(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() < relative, "{found} for {expected}");
}

#[test]
fn signal_photons_per_shot_are_the_thesis_link_budget() {
    let expected = [
        (0.60, [39.43, 9.856, 4.381, 2.464, 1.577, 1.056]),
        (0.34, [22.343, 5.585, 2.4826, 1.3963, 0.8937, 0.5984]),
    ];
    for (reflectance, row) in expected {
        for (distance_m, expected) in DISTANCES_M.into_iter().zip(row) {
            let found = budget(&scene(distance_m, reflectance, 0.0)).signal_per_shot;
            assert_close(found, expected, 1e-3);
        }
    }
}

#[test]
fn the_fitted_ambient_rate_is_proportional_to_irradiance_and_reflectance() {
    for (irradiance, reflectance) in [(0.4, 0.60), (0.1, 0.08)] {
        for distance_m in DISTANCES_M {
            let found = budget(&scene(distance_m, reflectance, irradiance)).ambient_rate_hz;
            assert_close(found, 3.968e9 * irradiance * reflectance, 1e-3);
        }
    }
    let mut twice = scene(0.5, 0.60, 0.4);
    twice.spad.pdp *= 2.0;
    assert_close(budget(&twice).ambient_rate_hz, 2.0 * 0.9523e9, 1e-3);
}

#[test]
fn the_physical_ambient_rate_falls_where_the_target_does_not_fill_the_view() {
    let expected = [2.992e9, 2.992e9, 2.992e9, 2.992e9, 2.943e9, 2.654e9];
    for (distance_m, expected) in DISTANCES_M.into_iter().zip(expected) {
        let mut scenario = scene(distance_m, 0.60, 0.4);
        scenario.ambient.model = AmbientModel::Physical;
        assert_close(budget(&scenario).ambient_rate_hz, expected, 5e-3);
    }
}

#[test]
fn the_laser_may_have_12_77_mw() {
    let scenario = Scenario::default();
    let exposure_s = scenario.firmware.shots_per_frame as f64 / scenario.laser.repetition_rate_hz;
    let limit_w = maximum_average_power_w(exposure_s, scenario.laser.wavelength_nm).unwrap();
    assert_close(limit_w, 12.77e-3, 1e-3);
    assert!(scenario.laser.average_power_w < limit_w);
}

/// The default carry chain: 11.5 ps taps, 2.23 ns before the first.
fn bins() -> Bins {
    let delays = Delays::new(Time::from_fs(2_230_000), &[11_500; TAPS]).unwrap();
    Bins::of_tdc(&tdc::Params::of_chain(delays))
}

/// Counts by code, and last the shots without one.
fn histogram(shots: u64, bins: &Bins, mut arrival: impl FnMut() -> Time) -> Vec<f64> {
    let mut counts = vec![0.0; 257];
    for _ in 0..shots {
        counts[bins.code_at(arrival()).map_or(256, usize::from)] += 1.0;
    }
    counts
}

/// One avalanche by inversion of the cumulative hazard.
fn inverted(hazard: &Hazard, rng: &mut impl Rng) -> Time {
    let word = rng.next_u64();
    match hazard.variation().is_none() {
        true => hazard.inverse(exponential(word)),
        false => {
            let pulse = [(); 2].map(|()| normal(rng.next_u64()));
            hazard.varied(pulse).inverse(exponential(word))
        }
    }
}

/// One avalanche, photon by photon: Poisson many from the pulse, the first of the ambient ones.
fn photon_by_photon(budget: &Budget, rng: &mut impl Rng) -> Time {
    let mut first_ps = f64::INFINITY;
    if budget.background_rate_hz() > 0.0 {
        first_ps = Exp::new(budget.background_rate_hz() * 1e-12).unwrap().sample(rng);
    }
    if budget.signal_per_shot > 0.0 {
        let Variation { timing_ps, energy, .. } = budget.variation;
        let mut scatter = || Normal::new(0.0, 1.0).unwrap().sample(rng);
        let mean_ps = budget.mean_arrival.fs() as f64 * 1e-3 + timing_ps * scatter();
        let signal = budget.signal_per_shot * (1.0 + energy * scatter()).max(0.0);
        let (sigma_ps, tail_ps) = match budget.pulse {
            Pulse::Tailed { sigma_ps, tail_ps } => (sigma_ps, tail_ps),
            _ => (budget.pulse.sigma_ps(), 0.0),
        };
        let pulse = Normal::new(mean_ps - tail_ps, sigma_ps).unwrap();
        let tail = |rng: &mut _| tail_ps * Exp::new(1.0).unwrap().sample(rng);
        let photons = match signal > 0.0 {
            true => Poisson::new(signal).unwrap().sample(rng),
            false => 0.0,
        };
        for _ in 0..photons as u64 {
            first_ps = first_ps.min((pulse.sample(rng) + tail(rng)).max(0.0));
        }
    }
    Time::from_fs((first_ps * 1e3) as u64)
}

/// Probability of a chi-square sum at least as large by chance; neighbouring cells are merged until
/// `weight` expects 10 counts in each.
fn p_value(cells: impl Iterator<Item = (f64, f64, f64)>) -> f64 {
    let mut merged: Vec<(f64, f64, f64)> = vec![(0.0, 0.0, 0.0)];
    for (found, expected, variance) in cells {
        let add = |a: (f64, f64, f64)| (a.0 + found, a.1 + expected, a.2 + variance);
        match merged.last_mut() {
            Some(last) if last.2 < 10.0 => *last = add(*last),
            _ => merged.push((found, expected, variance)),
        }
    }
    if merged.last().is_some_and(|last| last.2 < 10.0) {
        let rest = merged.pop().unwrap();
        let last = merged.last_mut().unwrap();
        *last = (last.0 + rest.0, last.1 + rest.1, last.2 + rest.2);
    }
    let terms =
        merged.iter().map(|(found, expected, variance)| (found - expected).powi(2) / variance);
    let freedom = merged.len() as f64 - 1.0;
    assert!(freedom >= 1.0, "too few counts to compare");
    ChiSquared::new(freedom).unwrap().sf(terms.sum())
}

/// Pearson's test of counts against probabilities; the last cell takes what is left over.
fn against(counts: &[f64], probabilities: &BinProbabilities) -> f64 {
    let shots: f64 = counts.iter().sum();
    let of_code = probabilities.of_code();
    let left_over = 1.0 - of_code.iter().sum::<f64>();
    let expected = of_code.iter().chain([&left_over]).map(|p| p * shots);
    p_value(counts.iter().zip(expected).map(|(&found, expected)| (found, expected, expected)))
}

/// Two-sample test of two histograms of equally many shots.
fn between(a: &[f64], b: &[f64]) -> f64 {
    p_value(a.iter().zip(b).map(|(&a, &b)| (a, b, a + b)))
}

#[test]
fn inverted_draws_follow_the_closed_form() {
    let bins = bins();
    for (seed, (name, budget)) in scenes().into_iter().enumerate() {
        let hazard = Hazard::new(&budget);
        let mut rng = ChaCha8Rng::seed_from_u64(seed as u64);
        let counts = histogram(2_000_000, &bins, || inverted(&hazard, &mut rng));
        let p = against(&counts, &BinProbabilities::new(&hazard, &bins));
        println!("{name}: p = {p:.3}");
        assert!(p > LEVEL, "{name}: p = {p:e}");
    }
}

#[test]
fn histograms_drawn_in_one_step_follow_the_closed_form() {
    let bins = bins();
    for (seed, (name, budget)) in scenes().into_iter().enumerate() {
        let probabilities = BinProbabilities::new(&Hazard::new(&budget), &bins);
        let mut rng = ChaCha8Rng::seed_from_u64(100 + seed as u64);
        let shots = 30_000;
        let mut counts = vec![0.0; 257];
        for _ in 0..200 {
            let drawn = probabilities.draw(shots, &mut rng);
            let none = shots - drawn.iter().sum::<u64>();
            for (count, drawn) in counts.iter_mut().zip(drawn.into_iter().chain([none])) {
                *count += drawn as f64;
            }
        }
        let p = against(&counts, &probabilities);
        println!("{name}: p = {p:.3}");
        assert!(p > LEVEL, "{name}: p = {p:e}");
    }
}

#[test]
fn inverted_draws_agree_with_photon_by_photon() {
    let bins = bins();
    for (seed, (name, budget)) in scenes().into_iter().enumerate() {
        let hazard = Hazard::new(&budget);
        let mut rng = ChaCha8Rng::seed_from_u64(200 + seed as u64);
        let fast = histogram(500_000, &bins, || inverted(&hazard, &mut rng));
        let slow = histogram(500_000, &bins, || photon_by_photon(&budget, &mut rng));
        let p = between(&fast, &slow);
        println!("{name}: p = {p:.3}");
        assert!(p > LEVEL, "{name}: p = {p:e}");
    }
}

#[test]
fn causes_come_in_proportion_to_their_hazards() {
    let mut budget = budget(&scene(0.6, 0.60, 0.1));
    budget.dark_rate_hz = 2e8;
    let hazard = Hazard::new(&budget);
    let mut rng = ChaCha8Rng::seed_from_u64(300);
    let mut counts = [[0.0; 3]; 2];
    let shots = 200_000;
    for _ in 0..shots {
        let t = inverted(&hazard, &mut rng);
        counts[0][hazard.cause(t, rng.random()) as usize] += 1.0;
        let mut alone = |signal, ambient, dark| {
            let one = Budget {
                signal_per_shot: signal,
                ambient_rate_hz: ambient,
                dark_rate_hz: dark,
                ..budget.clone()
            };
            photon_by_photon(&one, &mut rng)
        };
        let firsts = [
            alone(budget.signal_per_shot, 0.0, 0.0),
            alone(0.0, budget.ambient_rate_hz, 0.0),
            alone(0.0, 0.0, budget.dark_rate_hz),
        ];
        let cause = (0..3).min_by_key(|&cause| firsts[cause]).unwrap();
        counts[1][cause] += 1.0;
    }
    let p = between(&counts[0], &counts[1]);
    println!("{counts:?}: p = {p:.3}");
    assert!(p > LEVEL, "{counts:?}: p = {p:e}");
}

#[test]
fn outputs_of_a_row_are_low_together_as_often_as_independent_diodes_are() {
    // Of a diode that fires at a rate and rests for a dead time, the share of time in which it is armed.
    let (rate_hz, dead_ns, end) = (5e6, 20.0, Time::from_ns(20_000_000));
    let armed = 1.0 / (1.0 + rate_hz * dead_ns * 1e-9);
    for count in [1, 7, 40] {
        let mut rng = ChaCha8Rng::seed_from_u64(count as u64);
        let all_hz = rate_hz * count as f64;
        let mut wait =
            |share: f64| Time::from_ps_f64(exponential(rng.next_u64()) * share / all_hz * 1e12);
        let mut spads = Spads::new(count, Time::from_ps_f64(dead_ns * 1e3), wait(1.0));
        spads.set_passive(true, Time::ZERO);
        let (mut last, mut low_fs, mut rises) = (Time::ZERO, 0u64, 0u32);
        while spads.next_event() < end {
            let (now, output) = (spads.next_event(), spads.output());
            if !output {
                low_fs += (now - last).fs();
            }
            last = now;
            spads.event(&mut Light::None);
            rises += u32::from(spads.output() && !output);
            if spads.waits() {
                spads.arm(now + wait(spads.share()));
            }
        }
        let expected = armed.powi(count as i32);
        // Each low time is exponential, and there are so many.
        let error = 4.0 / f64::from(rises).sqrt();
        assert_close(low_fs as f64 / last.fs() as f64, expected, error);
        assert_close(f64::from(rises), expected * all_hz * last.seconds(), error);
    }
}
