//! Whatever effects a scenario has, alone or in pairs: each fidelity gives what the plain step gives, or refuses.

use std::fs;
use std::path::Path;

use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use tofsim::scenario::effects::Effect;
use tofsim::sim::{Run, Stepping};
use tofsim::{Frame, HistogramRun, Observers, SecondOpinion, Setup};

use crate::common::{csv, empty};
use crate::stepping::assert_all_alike;

/// A short frame that shows what effects do to it.
const BASE: [&str; 4] = [
    "firmware.shots_per_frame=60",
    "target.distance_m=0.3",
    "target.reflectance=0.3",
    "spad.dead_time_ns=400",
];
/// Pairs that are drawn.
const PAIRS: usize = 80;
/// Frames whose histograms are compared in distribution.
const FRAMES: u64 = 400;

/// Keys that show an effect; files are in `folder`.
fn switched_on(effect: Effect, folder: &Path) -> Vec<String> {
    let in_folder = |key: &&str| match key.strip_suffix(".csv").and_then(|of| of.split_once('=')) {
        Some((key, file)) => {
            let path = folder.join(file).with_extension("csv");
            format!("{key}={:?}", path.display().to_string())
        }
        None => key.to_string(),
    };
    effect.example().iter().map(in_folder).collect()
}

/// Writes the files that keys name.
fn write_files(folder: &Path) {
    let photons: String = (0..400).map(|shot| format!("{shot},{}\n", 1500 + 7 * shot)).collect();
    let histogram = (0..256).map(|bin| u32::from(bin == 80) * 40).collect();
    for (name, text) in [
        ("conditions.csv", "time_s,temperature_c,supply_mv\n2e-6,5,0\n3e-5,80,0\n".to_owned()),
        ("pulse.csv", "time_ps,density\n0,1\n100,3\n200,2\n300,1\n400,1\n".to_owned()),
        ("photons.csv", format!("shot,arrival_ps\n{photons}")),
        ("histogram.csv", csv(&histogram)),
    ] {
        fs::write(folder.join(name), text).unwrap();
    }
}

/// Checks each effect alone, and pairs, and fails with all that `check` finds wrong; what a scenario cannot have together
/// is passed over.
fn check_alone_and_in_pairs(seed: u64, mut check: impl FnMut(&Setup) -> Result<(), String>) {
    let folder = empty();
    write_files(folder.path());
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut drawn: Vec<_> = Effect::ALL.iter().map(|&effect| vec![effect]).collect();
    drawn.extend((0..PAIRS).map(|_| Effect::ALL.sample(&mut random, 2).copied().collect()));
    let (mut checked, mut wrong) = (0, Vec::new());
    for effects in drawn {
        let keys = effects.iter().flat_map(|&effect| switched_on(effect, folder.path()));
        let keys: Vec<_> = BASE.iter().map(|&key| key.to_owned()).chain(keys).collect();
        let seed = format!("seed={}", random.random_range(1..1000));
        let keys: Vec<_> = keys.iter().map(String::as_str).chain([seed.as_str()]).collect();
        let setup = Setup::load("kc705", &keys);
        assert!(setup.is_ok() || effects.len() > 1, "{effects:?}: {}", setup.unwrap_err());
        let Ok(setup) = setup else { continue };
        for &effect in &effects {
            assert!(effect.occurrence(&setup.scenario).is_some(), "{effects:?}");
        }
        wrong.extend(check(&setup).err().map(|what| format!("{effects:?}: {what}")));
        checked += 1;
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(checked > PAIRS / 2, "{checked}");
}

fn has(setup: &Setup, effect: Effect) -> bool {
    effect.occurrence(&setup.scenario).is_some()
}

#[test]
fn each_fast_way_and_any_thread_gives_what_the_plain_step_gives() {
    check_alone_and_in_pairs(1, |setup| {
        if !has(setup, Effect::HeldFrame) {
            let alike = assert_all_alike(setup, 5);
            return alike.map_err(|difference| difference.to_string().chars().take(200).collect());
        }
        let ends = |stepping| Run::new(setup).stepping(stepping).frames(1).is_ok();
        let ends = [Stepping::EveryCycle, Stepping::LeapShots].map(ends);
        if ends == [false, false] { Ok(()) } else { Err(format!("{ends:?}")) }
    });
}

#[test]
fn a_histogram_in_one_draw_is_distributed_as_that_of_simulated_shots_or_refused() {
    let mut accepted = 0;
    check_alone_and_in_pairs(2, |setup| {
        let Ok(draws) = HistogramRun::new(setup) else { return Ok(()) };
        accepted += 1;
        let counts = |run: &dyn Fn(Observers)| {
            let mut counts = vec![0u64; 256];
            let mut add = |frame: &Frame| {
                let both = counts.iter_mut().zip(&frame.histogram);
                both.for_each(|(sum, &count)| *sum += u64::from(count));
                Ok(())
            };
            run(Observers { frames: Some(&mut add), ..Observers::default() });
            counts
        };
        let drawn = counts(&|observers| drop(draws.many(FRAMES, observers).unwrap()));
        let run = || Run::new(setup).stepping(Stepping::LeapShots);
        let simulated = counts(&|observers| drop(run().many(FRAMES, observers).unwrap()));
        let (chi_square, degrees) = chi_square(&drawn, &simulated);
        let most = degrees + 5.0 * (2.0 * degrees).sqrt();
        let what = format!("chi-square {chi_square:.0} of {degrees}");
        if chi_square < most { Ok(()) } else { Err(what) }
    });
    assert!(accepted > 10, "{accepted}");
}

/// Chi-square of two samples of as many shots, over bins with ten counts or more, and its degrees of freedom.
fn chi_square(one: &[u64], other: &[u64]) -> (f64, f64) {
    let pairs = one.iter().zip(other).map(|(&a, &b)| (a as f64, b as f64));
    let terms: Vec<_> =
        pairs.filter(|(a, b)| a + b >= 10.0).map(|(a, b)| (a - b) * (a - b) / (a + b)).collect();
    (terms.iter().sum(), terms.len() as f64)
}

#[test]
fn a_second_opinion_is_right_or_there_is_none() {
    let (mut given, mut wrong) = (0, Vec::new());
    let folder = empty();
    write_files(folder.path());
    // Each effect, and none.
    for effect in Effect::ALL.into_iter().map(Some).chain([None]) {
        let keys = effect.map_or(Vec::new(), |effect| switched_on(effect, folder.path()));
        let more = ["firmware.shots_per_frame=20000", "target.distance_m=0.3"].map(str::to_owned);
        let keys: Vec<_> = keys.iter().chain(&more).map(String::as_str).collect();
        let setup = Setup::load("kc705", &keys).unwrap();
        let Ok(second) = SecondOpinion::new(&setup) else { continue };
        if has(&setup, Effect::HeldFrame) {
            continue;
        }
        given += 1;
        let frames = Run::new(&setup).stepping(Stepping::LeapShots).frames(2).unwrap();
        let opinion = second.of(&frames[1]).unwrap();
        // One that rejects the depth is not wrong.
        if !opinion.status.is_empty() {
            continue;
        }
        let (depth_m, sigma_m) = (opinion.depth_m.unwrap(), opinion.sigma_m.unwrap());
        let error_m = depth_m - setup.true_depth_m().unwrap();
        if error_m.abs() > 5.0 * sigma_m {
            wrong.push(format!("{effect:?}: {error_m} m, {opinion:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(given >= 4, "{given}");
}
