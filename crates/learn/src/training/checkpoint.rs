//! Checkpoints: a training's state in a file, every number to the bit, and the settings it belongs
//! to. The last line is a checksum of the others.

use std::collections::BTreeMap;
use std::io::{ErrorKind, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};

use tofsim::error::{Error, Input, Result, read_text};
use tofsim::files::digest::digest;
use tofsim::files::output::write_file;
use tofsim::files::toml::Checked;

use super::basis::{KNOTS, fill_tiles};
use super::features::Scaling;
use super::recipe::Recipe;
use super::state::TournamentState;
use super::sums::parameters;

/// Value of the key `schema`.
const SCHEMA: &str = "tofsim.checkpoint/2";
/// Begins the line with the checksum.
const SUM: &str = "# checksum ";

/// Settings by name; a checkpoint is for these alone.
pub type CheckpointSettings = BTreeMap<String, String>;

/// Training that a checkpoint belongs to.
#[derive(Clone, Debug, Default)]
pub struct CheckpointOf {
    /// All that decides what comes out.
    pub settings: CheckpointSettings,
    /// The options that say so, for people: `--seed 2`.
    pub options: Vec<String>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Checkpoint {
    schema: String,
    /// `None` if an older tofsim wrote it.
    options: Option<Vec<String>>,
    settings: CheckpointSettings,
    state: TournamentState,
}

/// Writes a state; the file is whole or the one before.
///
/// # Errors
/// When the file cannot be written.
pub fn save(path: &Path, of: &CheckpointOf, state: &TournamentState) -> Result<()> {
    let CheckpointOf { settings, options } = of.clone();
    let (schema, state) = (SCHEMA.to_owned(), state.clone());
    let text = toml::to_string(&Checkpoint { schema, options: Some(options), settings, state });
    let text = text.map_err(|error| Input::new(path.display(), error))?;
    write_file(path, |file| file.write_all(with_checksum(&text).as_bytes()))
}

/// Adds the line with the checksum.
fn with_checksum(text: &str) -> String {
    format!("{text}{SUM}{:016x}\n", digest(0, text.as_bytes()))
}

/// Reads a state.
///
/// # Errors
/// When the file cannot be read or is no checkpoint, does not match its checksum, is one of another version or of other
/// settings, or does not fit the recipe.
pub fn load(path: &Path, of: &CheckpointOf, recipe: &Recipe) -> Result<TournamentState> {
    if std::fs::metadata(path).is_err_and(|error| error.kind() == ErrorKind::NotFound) {
        let expected = "no checkpoint there; expected the folder (-o) of a training that was begun \
            without --resume";
        return Err(Input::new(path.display(), expected).into());
    }
    let text = read_text(path)?;
    let name = path.display();
    let no_checkpoint = |error: Error| match error {
        Error::Input(fault) => {
            let expected = format!("no checkpoint: {}", fault.expected);
            Input { expected, ..*fault }.into()
        }
        other => other,
    };
    let checked = Checked::syntax(&name.to_string(), &text).map_err(no_checkpoint)?;
    let schema = checked.table().get("schema").and_then(|schema| schema.as_str());
    if schema != Some(SCHEMA) {
        let expected = format!("expected \"{SCHEMA}\"; without --resume the training begins anew");
        let fault = Input::new(&name, expected).field("schema");
        return Err(fault.value(schema.unwrap_or_default()).into());
    }
    let end = text.rfind(SUM).unwrap_or(text.len());
    if with_checksum(&text[..end]) != text {
        let expected = "damaged: does not match its checksum; expected the checkpoint as the training left it; \
            without --resume the training begins anew";
        return Err(Input::new(&name, expected).into());
    }
    let checkpoint: Checkpoint = checked.read().map_err(no_checkpoint)?;
    for key in of.settings.keys().chain(checkpoint.settings.keys()) {
        let (found, expected) = (checkpoint.settings.get(key), of.settings.get(key));
        if found != expected {
            let none = "none".to_owned();
            let options = checkpoint.options.as_ref();
            let expected = format!(
                "of another training: this one has {}{}",
                expected.unwrap_or(&none),
                options.map_or(String::new(), |options| differing(options, &of.options))
            );
            let field = format!("settings.{key}");
            let found = found.unwrap_or(&none);
            return Err(Input::new(&name, expected).field(field).value(found).into());
        }
    }
    check(&checkpoint.state, recipe).map_err(|field| {
        Input::new(&name, "does not fit the recipe").field(format!("state.{field}"))
    })?;
    Ok(checkpoint.state)
}

/// Returns the differences between the options with which a training was begun and is continued.
fn differing(begun: &[String], now: &[String]) -> String {
    let less = |these: &[String], those: &[String]| {
        let these = these.iter().filter(|option| !those.contains(option));
        these.map(String::as_str).collect::<Vec<_>>().join(" ")
    };
    match (less(begun, now).as_str(), less(now, begun).as_str()) {
        ("", "") => {
            "; its options are the same, so a file that they name has changed, or tofsim has".into()
        }
        (begun, "") => format!("; it was begun with {begun}, which is missing here"),
        ("", now) => format!("; it was begun without {now}"),
        (begun, now) => format!("; it was begun with {begun}, here it is {now}"),
    }
}

/// Checks that a state fits the recipe; the error is the field that does not.
fn check(state: &TournamentState, recipe: &Recipe) -> std::result::Result<(), &'static str> {
    let (stages, stage) = (recipe.stages.len(), recipe.stage(state.stage));
    let blocks = if state.stage == stages { recipe.finish.blocks } else { 0 };
    let size = parameters(recipe.neurons, state.scaling.columns());
    let fits = |x: &[f64]| x.len() == size && x.iter().all(|x| x.is_finite());
    let mut least = state.candidates.iter().filter_map(|candidate| candidate.lm.least.as_ref());
    let (scaling, knots) =
        ([&state.scaling.centre, &state.scaling.inverse_scale], state.scaling.centre.len());
    let checks = [
        ("stage", state.stage <= stages),
        ("block", state.block <= blocks),
        ("epochs", state.epochs < stage.epochs),
        ("candidates.made", state.candidates.iter().all(|one| one.made <= stage.epochs)),
        ("scaling", scaling.iter().all(|s| s.len() == knots && s.iter().all(|x| x.is_finite()))),
        (
            "scaling.knots",
            knots == KNOTS && state.scaling.knots.is_empty() || are_knots(&state.scaling),
        ),
        ("candidates", state.candidates.len() == stage.candidates),
        ("candidates.lm.x", state.candidates.iter().all(|candidate| fits(&candidate.lm.x))),
        ("candidates.lm.least", least.all(|(_, x)| fits(x))),
        ("best.x", state.best.iter().all(|best| fits(&best.x))),
    ];
    match checks.into_iter().find(|(_, good)| !good) {
        Some((field, _)) => Err(field),
        None => Ok(()),
    }
}

/// Returns whether the knots can be those of a basis.
fn are_knots(scaling: &Scaling) -> bool {
    let (knots, last_bin) = (&scaling.knots, scaling.bins as f64 - 1.0);
    let ends = (knots.first(), knots.last());
    let holds_all = matches!(ends, (Some(&first), Some(&last)) if first == 0.0 && last >= last_bin);
    knots.len() == scaling.centre.len()
        && fill_tiles(knots.len())
        && holds_all
        && knots.is_sorted_by(|a, b| a < b)
}

#[cfg(test)]
mod tests {
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
                 it was begun with --seed 1, here it is --seed 2"
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
        for (place, digit) in digits.step_by(401) {
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
        let list =
            |options: &str| options.split_terminator(',').map(str::to_owned).collect::<Vec<_>>();
        let differing = |begun, now| differing(&list(begun), &list(now));
        let with = differing("--quick,--seed 1", "--seed 1");
        assert_eq!(with, "; it was begun with --quick, which is missing here");
        assert_eq!(differing("", "-s a=1,-s b=2"), "; it was begun without -s a=1 -s b=2");
        assert!(differing("--seed 1", "--seed 1").contains("a file that they name has changed"));
    }
}
