//! Depths behind a cover glass, drawn from hazards that are written down here once more.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Binomial, Distribution};
use statrs::distribution::{ContinuousCDF, Normal};

use crate::firmware::histogram_builder;
use crate::firmware::likelihood_estimator::LikelihoodEstimator;
use crate::firmware::likelihood_estimator::params::{Params, Wanted};
use crate::firmware::likelihood_estimator::targets::Targets;
use crate::kernel::pulse::Pulse;

use super::super::estimate;
use super::{extremes, step};

/// Shots of a histogram, width of a bin and deviation of the pulse [ps].
const SHOTS: u64 = 30_000;
const BIN_PS: f64 = 25.0;
const SIGMA_PS: f64 = 137.0;
const METRES_PER_PS: f64 = 1.498_962_29e-4;

/// Part of a pulse in each bin.
fn parts(at_ps: f64) -> Vec<f64> {
    let normal = Normal::new(at_ps, SIGMA_PS).unwrap();
    let before = |bin: usize| if bin == 0 { 0.0 } else { normal.cdf(bin as f64 * BIN_PS) };
    (0..256).map(|bin| before(bin + 1) - before(bin)).collect()
}

fn instrument(glass: &[f64], targets: Targets) -> Params {
    let edges_ps: Vec<_> = (0..=256).map(|bin| f64::from(bin) * BIN_PS).collect();
    Params::new(&Wanted {
        histogram: histogram_builder::Params::default(),
        shots: SHOTS,
        edges_ps: &edges_ps,
        bin_ps: BIN_PS,
        pulse: Pulse::Gaussian { sigma_ps: SIGMA_PS },
        metres_per_ps: METRES_PER_PS,
        delay_ps: 0.0,
        glass,
        targets,
    })
    .unwrap()
}

fn draw(hazards: &[f64], random: &mut ChaCha8Rng) -> Vec<u32> {
    let mut left = SHOTS;
    let mut ended = |hazard: &f64| {
        let count = Binomial::new(left, -(-hazard).exp_m1()).unwrap().sample(random);
        left -= count;
        count as u32
    };
    hazards.iter().map(&mut ended).collect()
}

#[test]
fn errors_behind_glass_are_as_large_as_sigma_states() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let (mut kept, mut squares, mut far, mut all, mut mean) = (0.0, 0.0, 0, 0, 0.0);
    for _ in 0..4000 {
        let glass = parts(random.random_range(0.0..120.0));
        let light = (random.random_range(0.03f64.ln()..3f64.ln())).exp();
        let template: Vec<_> = glass.iter().map(|part| part * light).collect();
        let now = random.random_range(0.6..1.6);
        let signal = light * now * random.random_range(0.1f64.ln()..3f64.ln()).exp();
        let at_ps = random.random_range(333.0..3000.0);
        let ambient = random.random_range(0.0..5e-3);
        let echo = parts(at_ps);
        let hazards: Vec<_> =
            (0..256).map(|bin| ambient + now * template[bin] + signal * echo[bin]).collect();
        let found = estimate(&instrument(&template, Targets::One), &draw(&hazards, &mut random));
        all += 1;
        if !found.status.is_empty() {
            continue;
        }
        let error = (found.depth_m() - at_ps * METRES_PER_PS) / found.sigma_m();
        kept += 1.0;
        squares += error * error;
        mean += error;
        far += usize::from(error.abs() > 6.0);
    }
    let (rms, mean) = ((squares / kept).sqrt(), mean / kept);
    println!("{kept} of {all}, rms {rms}, mean {mean}, far {far}");
    assert!(kept > 0.8 * f64::from(all) && (0.9..1.1).contains(&rms), "{kept}, {rms}");
}

/// Compares block and estimate on drawn and extreme histograms behind several glasses.
#[test]
fn the_block_finds_the_same_behind_glass() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for (at_ps, light, scale) in [(0.0, 0.5, 1.0), (100.0, 3.0, 0.5), (700.0, 0.05, 2.0)] {
        let template: Vec<_> = parts(at_ps).iter().map(|part| part * light).collect();
        let p = instrument(&template, Targets::One);
        let mut all = extremes(256, p.histogram.most_hits() as u32, &mut random);
        for at_ps in [200.0, 333.0, 700.0, 900.0, 1500.0, 4000.0, 6300.0] {
            let echo = parts(at_ps);
            let signal = random.random_range(0.01..2.0);
            let hazard = |bin: usize| 1e-3 + scale * template[bin] + signal * echo[bin];
            all.push(draw(&(0..256).map(hazard).collect::<Vec<_>>(), &mut random));
        }
        finds_the_same(&p, &all);
    }
}

/// Compares block and estimate on histograms. Returns how many have two targets.
fn finds_the_same(p: &Params, histograms: &[Vec<u32>]) -> usize {
    let mut block = LikelihoodEstimator::default();
    let same = |histogram: &Vec<u32>| {
        let (found, edges) = step(&mut block, p, histogram);
        assert_eq!(found, estimate(p, histogram), "{histogram:?}");
        assert_eq!(edges, p.done());
        usize::from(found.second.is_some())
    };
    histograms.iter().map(same).sum()
}

/// The same with two echoes near and far from each other, in either order, with a glass and without.
#[test]
fn the_block_finds_the_same_two_targets() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let glasses: [&[f64]; 2] = [&[], &parts(100.0)];
    for glass in glasses {
        for targets in [Targets::NearestFirst, Targets::StrongestFirst] {
            let p = instrument(glass, targets);
            let mut all = extremes(256, p.histogram.most_hits() as u32, &mut random);
            for apart in [0.5, 1.0, 2.0, 2.7, 2.9, 3.2, 4.0, 6.0, 9.0, 12.0, 20.0, 30.0] {
                let at_ps = random.random_range(150.0..3000.0);
                let signal = random.random_range(0.02..1.0);
                let second = signal * random.random_range(0.1f64.ln()..1.2).exp();
                let [one, other] = [at_ps, at_ps + apart * SIGMA_PS].map(parts);
                let hazard = |bin: usize| {
                    let glass = glass.get(bin).copied().unwrap_or(0.0);
                    1e-3 + glass + signal * one[bin] + second * other[bin]
                };
                all.push(draw(&(0..256).map(hazard).collect::<Vec<_>>(), &mut random));
            }
            let two = finds_the_same(&p, &all);
            assert!((5..=13).contains(&two), "{two}");
        }
    }
}
