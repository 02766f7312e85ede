//! Any scene, pulse, chain and number of shots.

use std::collections::BTreeMap;

use rand::{Rng, RngExt};
use rayon::prelude::*;

use tofsim::sensor::streams::{Source, stream};
use tofsim::sim::estimates::likelihood::Found;

use super::{Instrument, Place, Tally};

/// Standard deviations of the pulse [ps].
const PULSES_PS: [u32; 5] = [80, 137, 200, 300, 400];
/// Chains by name; after them come [`RANDOM_CHAINS`].
const CHAINS: [&str; 3] = ["uniform", "table6_3", "ideal"];
const RANDOM_CHAINS: u64 = 3;
/// Distances at which groups begin [m].
const NEARER_M: [f64; 8] = [0.05, 0.07, 0.1, 0.15, 0.25, 0.4, 0.6, 0.8];
/// Two standard deviations at the bound, above which a scene says nothing worth having [m].
const WORTH_M: f64 = 0.020;

/// A standard normal number.
fn normal(random: &mut impl Rng) -> f64 {
    let (radius, turn) = (1.0 - random.random::<f64>(), random.random::<f64>());
    (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * turn).cos()
}

/// A chain file whose taps are drawn log-normally.
fn random_chain(number: u64) -> String {
    let mut random = stream(23, Source::Scene, number);
    let taps: Vec<_> = (0..800).map(|_| 11.5 * (0.35 * normal(&mut random)).exp()).collect();
    // All of them take 9.2 ns, as those of `uniform` do.
    let factor = 9200.0 / taps.iter().sum::<f64>();
    let taps: Vec<_> = taps.iter().map(|ps| format!("{:.3}", ps * factor)).collect();
    format!("offset_ps = 2230.0\ntap_delays_ps = [{}]\n", taps.join(", "))
}

/// Every chain with every pulse, and the chain's name.
fn instruments() -> Vec<(String, u32, Instrument)> {
    let folder = tempfile::tempdir().unwrap();
    let mut chains: Vec<_> =
        CHAINS.iter().map(|&name| (name.to_owned(), name.to_owned())).collect();
    for number in 0..RANDOM_CHAINS {
        let path = folder.path().join(format!("{number}.toml"));
        std::fs::write(&path, random_chain(number)).unwrap();
        chains.push((format!("random {number}"), path.display().to_string()));
    }
    let all = PULSES_PS.into_iter().flat_map(|ps| chains.iter().map(move |chain| (ps, chain)));
    let load = |(ps, (name, path)): (u32, &(String, String))| {
        let set = [format!("laser.pulse_sigma_ps={ps}"), format!("tdc.profile={path}")];
        let instrument = Instrument::load("kc705", &[&set[0], &set[1]]);
        (name.clone(), ps, instrument)
    };
    all.map(load).collect()
}

/// One histogram, and the groups that it is in.
struct Look {
    groups: Vec<String>,
    found: Found,
    distance_m: f64,
    bound_m: f64,
}

/// The histogram of that number; `None` where its bound is not worth having.
fn look(instruments: &[(String, u32, Instrument)], number: u64) -> Option<Look> {
    let mut random = stream(22, Source::Histogram, number);
    let place = Place {
        distance_m: random.random_range(0.05..0.93),
        reflectance: 0.03 * (0.95f64 / 0.03).powf(random.random()),
        irradiance_w_m2_nm: if random.random_bool(0.1) { 0.0 } else { random.random() },
    };
    let shots = (3000.0 * 20f64.powf(random.random())) as u64;
    let (chain, pulse_ps, instrument) = &instruments[random.random_range(0..instruments.len())];
    let scene = instrument.scene(place, shots).filter(|scene| 2.0 * scene.bound_m < WORTH_M)?;
    let nearer = NEARER_M.iter().rfind(|m| **m <= place.distance_m).unwrap();
    let fewer = [3_000, 6_000, 12_000, 24_000].into_iter().rfind(|least| *least <= shots).unwrap();
    Some(Look {
        groups: vec![
            "all".to_owned(),
            format!("from {nearer} m"),
            format!("pulse of {pulse_ps} ps"),
            format!("chain {chain}"),
            format!("from {fewer} shots"),
        ],
        found: scene.look(&scene.draw(&mut random)),
        distance_m: place.distance_m,
        bound_m: scene.bound_m,
    })
}

/// So many histograms: group by group at most 1.1 times the bound, and deviations of their own that are
/// right to a quarter; all in all few that are not believed, and hardly one that is believed and wrong.
fn everywhere(count: u64) {
    let instruments = instruments();
    let looks: Vec<_> =
        (0..count).into_par_iter().filter_map(|number| look(&instruments, number)).collect();
    let mut tallies = BTreeMap::<&str, Tally>::new();
    for Look { groups, found, distance_m, bound_m } in &looks {
        for group in groups {
            tallies.entry(group).or_default().add(found, *distance_m, *bound_m);
        }
    }
    tallies.iter().for_each(|(name, tally)| println!("{}", tally.row(name)));
    for (name, tally) in &tallies {
        let row = tally.row(name);
        assert!(tally.ratio() < 1.1 && (0.8..1.25).contains(&tally.own()), "{row}");
    }
    let all = &tallies["all"];
    assert!(all.drawn > 0.8 * count as f64, "{}", all.row("all"));
    assert!(all.raised_part() < 0.04 && all.far <= 1e-4 * all.kept, "{}", all.row("all"));
}

#[test]
fn it_reaches_the_bound_with_any_pulse_chain_and_number_of_shots() {
    everywhere(20_000);
}

#[test]
#[ignore = "long: ./check --full"]
fn it_reaches_the_bound_in_two_hundred_thousand_histograms() {
    everywhere(200_000);
}
