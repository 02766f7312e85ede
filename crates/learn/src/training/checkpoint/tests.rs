//! Tests of the checkpoints.

use super::*;
use crate::training::lm::Lm;
use crate::training::state::{BestBlock, Candidate};

fn state(recipe: &Recipe) -> TournamentState {
    // Numbers of all magnitudes, none of them round.
    let number = |k: usize| (k as f64 + 0.1).sqrt() * 10f64.powi(k as i32 % 600 - 300);
    let x: Vec<f64> = (0..parameters(recipe.neurons, KNOTS + 1)).map(number).collect();
    let candidate = |start| Candidate {
        start,
        made: 2,
        lm: Lm::new(x.iter().map(|x| x * (start as f64 - 1.5)).collect(), &recipe.optimiser),
        factors: vec![-0.0, f64::MIN_POSITIVE / 3.0],
    };
    TournamentState {
        stage: 0,
        block: 0,
        epochs: 3,
        data: "0123456789abcdef".to_owned(),
        scaling: Scaling {
            centre: vec![0.1; KNOTS],
            inverse_scale: vec![1.0 / 3.0; KNOTS],
            ..Scaling::default()
        },
        candidates: (0..recipe.stages[0].candidates).map(candidate).collect(),
        best: Some(BestBlock {
            start: 1,
            block: 2,
            ratio: f64::INFINITY,
            saturated: false,
            x: x.clone(),
        }),
        curve: Vec::new(),
    }
}

fn of(seed: &str) -> CheckpointOf {
    let settings = [("seed", seed), ("finish.blocks", "2")]
        .map(|(key, value)| (key.to_owned(), value.to_owned()))
        .into();
    CheckpointOf { settings, options: vec!["--quick".to_owned(), format!("--seed {seed}")] }
}

#[test]
fn every_bit_comes_back() {
    let (recipe, folder) = (Recipe::quick(), tempfile::tempdir().unwrap());
    let (path, state) = (folder.path().join("checkpoint"), state(&recipe));
    save(&path, &of("1"), &state).unwrap();
    let loaded = load(&path, &of("1"), &recipe).unwrap();
    assert_eq!(loaded, state);
    let bits = |state: &TournamentState| -> Vec<u64> {
        let numbers = state.candidates.iter().flat_map(|c| c.lm.x.iter().chain(&c.factors));
        numbers.map(|x| x.to_bits()).collect()
    };
    assert_eq!(bits(&loaded), bits(&state));
}

#[test]
fn what_is_no_checkpoint_of_this_training_is_refused_by_name() {
    let (recipe, folder) = (Recipe::quick(), tempfile::tempdir().unwrap());
    let path = folder.path().join("checkpoint");
    let fault = |seed: &str| load(&path, &of(seed), &recipe).unwrap_err().to_string();
    save(&path, &of("1"), &state(&recipe)).unwrap();
    let error = fault("2");
    assert!(
        error.ends_with(
            "settings.seed = 1: of another training: this one has 2; \
             it was started with --seed 1, here it is --seed 2"
        ),
        "{error}"
    );
    let text = std::fs::read_to_string(&path).unwrap();
    let state_text = &text[..text.rfind(SUM).unwrap()];
    let change = |from: &str, to: &str| {
        std::fs::write(&path, with_checksum(&state_text.replacen(from, to, 1))).unwrap();
    };
    change("checkpoint/2", "checkpoint/1");
    assert!(fault("1").contains("schema = tofsim.checkpoint/1: expected"));
    change("epochs = 3", "epochs = 6");
    assert!(fault("1").contains("state.epochs: does not fit the recipe"));
    change("start = 0", "start = x");
    assert!(fault("1").contains("no checkpoint"));
    change("made = 2", "made = 99");
    assert!(fault("1").contains("state.candidates.made: does not fit the recipe"));
    let mut short = state(&recipe);
    short.candidates[1].lm.least = Some((0.5, vec![0.1]));
    save(&path, &of("1"), &short).unwrap();
    assert!(fault("1").contains("state.candidates.lm.least: does not fit the recipe"));
    std::fs::write(&path, "").unwrap();
    assert!(fault("1").contains("schema"));
    std::fs::remove_file(&path).unwrap();
    assert!(fault("1").contains("no checkpoint there; expected the folder (-o)"));
}

#[test]
fn every_changed_digit_is_noticed() {
    let (recipe, folder) = (Recipe::quick(), tempfile::tempdir().unwrap());
    let path = folder.path().join("checkpoint");
    save(&path, &of("1"), &state(&recipe)).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let digits = text.bytes().enumerate().filter(|(_, byte)| byte.is_ascii_digit());
    for (place, digit) in digits.step_by(4001) {
        let mut changed = text.clone().into_bytes();
        changed[place] = b'0' + (digit - b'0' + 1) % 10;
        std::fs::write(&path, changed).unwrap();
        assert!(load(&path, &of("1"), &recipe).is_err(), "byte {place}");
    }
    std::fs::write(&path, &text[..text.rfind(SUM).unwrap()]).unwrap();
    let error = load(&path, &of("1"), &recipe).unwrap_err().to_string();
    assert!(error.contains("does not match its checksum"), "{error}");
}

#[test]
fn options_that_differ_are_named_on_their_side() {
    let list = |options: &str| options.split_terminator(',').map(str::to_owned).collect::<Vec<_>>();
    let differing = |begun, now| differing(&list(begun), &list(now));
    let with = differing("--quick,--seed 1", "--seed 1");
    assert_eq!(with, "; it was started with --quick, which is missing here");
    assert_eq!(differing("", "-s a=1,-s b=2"), "; it was started without -s a=1 -s b=2");
    assert!(differing("--seed 1", "--seed 1").contains("a file that they name has changed"));
}
