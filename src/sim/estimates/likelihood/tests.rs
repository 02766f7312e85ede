//! The clocked block against the estimate at once.

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

mod glass;

use super::*;
use crate::firmware::likelihood_estimator::{In, LikelihoodEstimator, Registers};
use crate::firmware::tof_top::slot::SlotEstimator;
use crate::kernel::U;
use crate::optics::{BinProbabilities, Hazard};
use crate::sim::setup::Setup;

/// The block, stepped from a start until `algo_done`, and the edges it took.
fn step(block: &mut LikelihoodEstimator, p: &Params, histogram: &[u32]) -> (Found, u64) {
    let mut i = In { algo_start: true, ..In::default() };
    block.rise(&i, p);
    i.algo_start = false;
    let mut edges = 0;
    while !block.registers.algo_done {
        let word = histogram[block.likelihood_memory.registers.read_addr.index()];
        block.rise(&In { count: U::new(word.into()), ..i }, p);
        edges += 1;
        assert!(edges < 20_000, "it does not end");
    }
    let now = &block.registers;
    let found = Found {
        depth: now.depth.get(),
        sigma: now.sigma.get() as i64,
        status: now.status.into(),
        code: now.code,
        chi_square: now.chi_square.get() as i64,
        second: second(now),
    };
    (found, edges)
}

/// The second target, of which nothing but 0 is given without one.
fn second(now: &Registers) -> Option<Second> {
    let is_there = now.second_sigma != 0;
    assert!(is_there || now.second_depth.get() == 0 && now.second_strength == 0);
    assert_eq!(now.second_valid, is_there && now.second_status == 0);
    is_there.then(|| Second {
        depth: now.second_depth.get(),
        sigma: now.second_sigma.get() as i64,
        signal: now.second_strength.get() as i64,
        status: now.second_status.into(),
    })
}

/// Histograms of a scenario, drawn from its closed form.
fn drawn(setup: &Setup, shots: u64, rng: &mut impl Rng) -> Vec<u32> {
    let chances = BinProbabilities::new(&Hazard::new(&setup.budget), &setup.bins());
    chances.draw(shots, rng).into_iter().map(|count| count as u32).collect()
}

fn extremes(bins: usize, most: u32, rng: &mut impl RngExt) -> Vec<Vec<u32>> {
    let of = |count: &mut dyn FnMut(usize) -> u32| (0..bins).map(count).collect::<Vec<_>>();
    let full = rng.random_range(0..bins);
    let edge = rng.random_range(0..bins);
    let level = rng.random_range(0..most / bins as u32 + 2);
    vec![
        of(&mut |_| 0),
        of(&mut |_| most),
        of(&mut |bin| if bin == 0 { most } else { 0 }),
        of(&mut |bin| if bin == full { most } else { 0 }),
        of(&mut |bin| if bin == full { most / 3 } else { level }),
        of(&mut |bin| if bin % 2 == 0 { most } else { 0 }),
        of(&mut |bin| if bin % 2 == 1 { level } else { 0 }),
        of(&mut |bin| if bin < edge { level } else { 0 }),
        of(&mut |bin| if bin >= edge { most } else { 1 }),
        of(&mut |_| rng.random_range(0..=most)),
        of(&mut |_| rng.random_range(0..=level)),
    ]
}

/// Instruments: a scenario's name and what is set.
const INSTRUMENTS: [(&str, &[&str]); 9] = [
    ("kc705", &[]),
    ("kc705", &["tdc.profile=table6_3", "laser.pulse_sigma_ps=400"]),
    ("kc705", &["tdc.profile=ideal", "laser.pulse_sigma_ps=80", "target.distance_m=0.07"]),
    ("compact", &[]),
    ("fine", &["target.distance_m=0.06", "ambient.irradiance_w_m2_nm=1"]),
    ("kc705", &["laser.delay_ps=1234.5", "target.distance_m=0.2"]),
    ("kc705", &["estimator.targets=2"]),
    ("compact", &["estimator.targets=2", "estimator.order=strongest"]),
    ("fine", &["estimator.targets=2", "target.distance_m=0.06"]),
];

/// Compares block and estimate on so many drawn histograms of each instrument, and as many extreme ones.
fn compare(count: usize) {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for (name, set) in INSTRUMENTS {
        let setup = Setup::load(name, set).unwrap();
        let shots = setup.params.frame_ctrl.shots_per_frame.into();
        let p = setup.likelihood(shots).unwrap();
        let most = p.histogram.most_hits() as u32;
        let mut block = LikelihoodEstimator::default();
        let mut all: Vec<_> = (0..count).map(|_| drawn(&setup, shots, &mut rng)).collect();
        while all.len() < 2 * count {
            all.extend(extremes(p.histogram.bins, most, &mut rng));
        }
        for histogram in all {
            let (found, edges) = step(&mut block, &p, &histogram);
            assert_eq!(found, estimate(&p, &histogram), "{name} {set:?} {histogram:?}");
            assert_eq!(edges, p.done(), "{name} {set:?}");
        }
    }
}

#[test]
fn the_block_finds_the_same_in_as_many_cycles_whatever_it_sees() {
    compare(40);
}

#[test]
#[ignore = "long: ./check --full"]
fn the_block_finds_the_same_in_10_000_histograms() {
    compare(1_000);
}
