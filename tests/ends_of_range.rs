//! At the ends of each key's range, alone and in pairs, a scenario runs alike at every fidelity, or is refused by name.

use std::panic::{AssertUnwindSafe, catch_unwind};

use rand::SeedableRng;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;
use serde_json::Value;

use tofsim::optics::{BinProbabilities, Hazard};
use tofsim::scenario::effects::Effect;
use tofsim::scenario::keys::keys;
use tofsim::sim::{Run, Stepping};
use tofsim::{Frame, HistogramRun, Observers, SecondOpinion, Setup};

use crate::stepping::assert_all_alike;

/// A short frame.
const BASE: [&str; 2] = ["firmware.shots_per_frame=60", "target.distance_m=0.3"];
/// Pairs that are drawn.
const PAIRS: usize = 400;
/// Longest frames that are simulated by every cycle, and at all [cycles].
const LONGEST: [u64; 2] = [100_000, 2_000_000];
/// Frames whose hits are compared in distribution.
const FRAMES: u64 = 20;

/// A key and its value.
type Assignment = (String, String);

/// Each key at both ends of its range and just within them, or with each of its few values.
fn ends() -> Vec<Assignment> {
    let of_key = |(key, schema): (String, Value)| {
        let values = values(&schema).into_iter().map(move |value| (key.clone(), value));
        values.collect::<Vec<_>>()
    };
    keys().into_iter().flat_map(of_key).collect()
}

fn values(schema: &Value) -> Vec<String> {
    if let Some(choices) = schema["oneOf"].as_array() {
        return choices.iter().map(|choice| choice["const"].to_string()).collect();
    }
    if schema["type"] == "boolean" {
        return vec!["false".to_owned(), "true".to_owned()];
    }
    if let (Some(low), Some(high)) = (schema["minimum"].as_u64(), schema["maximum"].as_u64()) {
        return [low, low + 1, high - 1, high].map(|value| value.to_string()).to_vec();
    }
    let (Some(low), Some(high)) = (schema["minimum"].as_f64(), schema["maximum"].as_f64()) else {
        return Vec::new();
    };
    let little = 1e-9 * (high - low);
    [low, low + little, high - little, high].map(|value| format!("{value:?}")).to_vec()
}

/// Returns what is wrong with a scenario.
fn fault(set: &[&Assignment]) -> Option<String> {
    let own: Vec<_> = set.iter().map(|(key, value)| format!("{key}={value}")).collect();
    let all: Vec<_> = BASE.into_iter().chain(own.iter().map(String::as_str)).collect();
    let checked = catch_unwind(AssertUnwindSafe(|| match Setup::load("kc705", &all) {
        Ok(setup) => check(&setup),
        Err(error) => {
            let error = error.to_string();
            // A value may make another key's one impossible, or the chain's length.
            let others = keys().into_iter().map(|(key, _)| key).filter(|key| key.contains('.'));
            let mut named = set.iter().map(|(key, _)| key.clone()).chain(others);
            let is_named = named.any(|key| error.contains(&key)) || error.contains("tap_ps = ");
            if is_named { Ok(()) } else { Err(format!("refused without a key: {error}")) }
        }
    }));
    let fault = checked.unwrap_or_else(|_| Err("panics".to_owned())).err()?;
    Some(format!("{}: {}", own.join(" "), fault.chars().take(300).collect::<String>()))
}

fn check(setup: &Setup) -> Result<(), String> {
    let text = format!("{:?} {:?} {:?}", setup.budget, setup.true_depth_m(), setup.notes());
    if text.contains("NaN") {
        return Err(text);
    }
    check_probabilities(setup)?;
    let cycles = setup.longest_run(1);
    if cycles > LONGEST[1] || Effect::HeldFrame.occurrence(&setup.scenario).is_some() {
        return Ok(());
    }
    if cycles <= LONGEST[0] {
        assert_all_alike(setup, 2).map_err(|difference| difference.to_string())?;
    }
    let frames = Run::new(setup).stepping(Stepping::LeapShots).frames(2);
    let frames = frames.map_err(|error| error.to_string())?;
    if let Ok(second) = SecondOpinion::new(setup) {
        let opinions = frames.iter().filter_map(|frame| second.of(frame));
        for opinion in opinions.flat_map(|opinion| [opinion.depth_m, opinion.sigma_m]).flatten() {
            if !opinion.is_finite() {
                return Err(format!("second opinion {opinion}"));
            }
        }
    }
    if cycles <= LONGEST[0] { compare_hits(setup) } else { Ok(()) }
}

/// Checks that the probabilities of the codes are probabilities.
fn check_probabilities(setup: &Setup) -> Result<(), String> {
    let codes = BinProbabilities::new(&Hazard::new(&setup.budget), &setup.bins());
    let sum: f64 = codes.of_code().iter().sum();
    let are_some = codes.of_code().iter().all(|chance| (0.0..=1.0 + 1e-9).contains(chance));
    if are_some && sum <= 1.0 + 1e-6 { Ok(()) } else { Err(format!("probabilities sum to {sum}")) }
}

/// Compares the hits of drawn histograms with those of simulated shots.
fn compare_hits(setup: &Setup) -> Result<(), String> {
    let Ok(draws) = HistogramRun::new(setup) else { return Ok(()) };
    let hits = |run: &dyn Fn(Observers)| {
        let mut hits = 0;
        let mut add = |frame: &Frame| {
            hits += frame.hits();
            Ok(())
        };
        run(Observers { frames: Some(&mut add), ..Observers::default() });
        hits as f64
    };
    let drawn = hits(&|observers| drop(draws.many(FRAMES, observers).unwrap()));
    let run = || Run::new(setup).stepping(Stepping::LeapShots);
    let simulated = hits(&|observers| drop(run().many(FRAMES, observers).unwrap()));
    let is_alike = (drawn - simulated).abs() <= 6.0 * (drawn + simulated + 1.0).sqrt();
    if is_alike { Ok(()) } else { Err(format!("{drawn} hits drawn, {simulated} simulated")) }
}

fn check_all(sets: &[Vec<&Assignment>]) {
    let faults: Vec<_> = sets.iter().filter_map(|set| fault(set)).collect();
    assert!(faults.is_empty(), "{} of {}:\n{}", faults.len(), sets.len(), faults.join("\n"));
}

#[test]
fn each_key_at_the_ends_of_its_range_runs_alike_or_is_refused() {
    let ends = ends();
    assert!(ends.len() > 400, "{}", ends.len());
    check_all(&ends.iter().map(|end| vec![end]).collect::<Vec<_>>());
}

#[test]
fn pairs_of_keys_at_the_ends_of_their_ranges_run_alike_or_are_refused() {
    let ends = ends();
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let pairs: Vec<Vec<_>> = (0..PAIRS).map(|_| ends.sample(&mut random, 2).collect()).collect();
    check_all(&pairs);
}
