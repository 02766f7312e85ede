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
        (begun, "") => format!("; it was started with {begun}, which is missing here"),
        ("", now) => format!("; it was started without {now}"),
        (begun, now) => format!("; it was started with {begun}, here it is {now}"),
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
mod tests;
