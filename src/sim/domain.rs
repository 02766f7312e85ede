//! The domain of a network: what it was trained for, and where a scenario lies outside of that.

mod keys;
mod scene;

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

use crate::error::{Input, Result};
use crate::network::Network;
use crate::network::domain::{Domain, holds, in_words};
use crate::note::{Note, NoteCode, NoteValue};
use crate::scenario::Scenario;
use crate::scenario::effects::USUAL;

use keys::{CALIBRATION, CHAIN, DARK_RATE, DEPENDENT, NAMED, silent};
use scene::SHAPE;

pub(crate) use keys::DRIFT as DRIFT_KEYS;

/// Text of a note on a network outside its training domain.
const TEXT: &str = "the network was not trained for it";

/// A key of the scenario, and the least and the largest value that a grid gives it.
pub type GridRange<'a> = (&'a str, [f64; 2]);

/// Returns the domain of a network that is trained on histograms of a scenario, whose keys in `grid` have those
/// ranges.
///
/// # Errors
/// When the scenario has no such key.
pub fn of(scenario: &Scenario, grid: &[GridRange]) -> Result<Domain> {
    let values = Values::new(scenario, grid)?;
    let usual = Values::new(&USUAL, &[])?;
    let mut domain = Domain::default();
    for key in NAMED.into_iter().chain(silent()).chain(values.of_scene()) {
        let is_silent =
            || silent().any(|silent| silent == key) && values.get(key) == usual.get(key);
        match values.get(key) {
            Some(Found::Range([_, most])) if key == DARK_RATE => {
                // Fewer dark counts are no other histograms: there is one in some 10,000 shots.
                domain.ranges.insert(key.to_owned(), [0.0, most]);
            }
            Some(Found::Range(range)) => drop(domain.ranges.insert(key.to_owned(), range)),
            Some(Found::Word(_)) if is_silent() => {}
            Some(Found::Word(word)) => drop(domain.words.insert(key.to_owned(), word)),
            None => {}
        }
    }
    Ok(domain)
}

/// Returns notes on where a scenario, whose keys in `grid` have those ranges, lies outside of what a network was
/// trained for.
///
/// # Errors
/// When the scenario has no such key.
pub fn notes(network: &Network, scenario: &Scenario, grid: &[GridRange]) -> Result<Vec<Note>> {
    let values = Values::new(scenario, grid)?;
    let Some(domain) = &network.domain else {
        let text = "the network's file does not state its training domain";
        let name = network.name.as_str();
        let expected = "a file with [domain]";
        let key = "estimator.network";
        let unknown = Note::new(NoteCode::OutsideTraining, key, name, expected, text);
        let chain = Found::Word(network.training.chain.clone());
        return Ok([unknown].into_iter().chain(values.outside(CHAIN, Some(&chain))).collect());
    };
    let usual = Values::new(&USUAL, &[])?;
    let mut trained: BTreeMap<&str, Option<Found>> =
        silent().map(|key| (key, usual.get(key))).collect();
    let ranges = domain.ranges.iter().map(|(key, range)| (key, Found::Range(*range)));
    let words = domain.words.iter().map(|(key, word)| (key, Found::Word(word.clone())));
    trained.extend(ranges.chain(words).map(|(key, found)| (key.as_str(), Some(found))));
    let (numbers, words): (Vec<_>, Vec<_>) =
        trained.iter().partition(|(_, found)| matches!(found, Some(Found::Range(_))));
    let outside = |(key, found): (&&str, &Option<Found>)| values.outside(key, found.as_ref());
    Ok(numbers.into_iter().chain(words).filter_map(outside).collect())
}

/// Whether a key's files may move and mean the same.
fn is_of_chain(key: &str) -> bool {
    [CHAIN, CALIBRATION].contains(&key)
}

/// Returns the name of a chain or a calibration, wherever its file is.
fn file_name(profile: &str) -> Option<&std::ffi::OsStr> {
    Path::new(profile).file_name()
}

/// The values of a scenario's keys.
struct Values<'a> {
    scenario: Value,
    grid: &'a [GridRange<'a>],
}

/// The values of a key.
#[derive(Clone, PartialEq)]
enum Found {
    /// Numbers from the first to the second.
    Range([f64; 2]),
    /// A word or a name.
    Word(String),
}

impl<'a> Values<'a> {
    fn new(scenario: &Scenario, grid: &'a [GridRange<'a>]) -> Result<Self> {
        let fault = |error| Input::new("scenario", error);
        let mut shown = serde_json::to_value(scenario).map_err(fault)?;
        shown["firmware"]["shots_per_frame"] = scenario.firmware.shots_of_a_frame().into();
        let tdc = &scenario.tdc;
        let then = [tdc.calibrated_at_c, tdc.calibrated_at_mv];
        shown["tdc"]["calibrated_at_c"] = then[0].unwrap_or(tdc.temperature_c).into();
        shown["tdc"]["calibrated_at_mv"] = then[1].unwrap_or(tdc.supply_mv).into();
        shown["pll"]["clk_sys_mhz"] = scenario.pll.clk_sys_mhz().into();
        let values = Values { scenario: shown, grid };
        match grid.iter().find(|(key, _)| values.at(key).is_none_or(|value| !value.is_number())) {
            Some((key, _)) => Err(Input::new("grid", "expected a number's key").value(key).into()),
            None => Ok(values),
        }
    }

    fn at(&self, key: &str) -> Option<&Value> {
        self.scenario.pointer(&format!("/{}", key.replace('.', "/")))
    }

    /// Returns a note that a key is not as a network was trained, if it is not.
    fn outside(&self, key: &str, trained: Option<&Found>) -> Option<Note> {
        let own = self.get(key);
        let holds = match (trained, &own) {
            (Some(Found::Range(trained)), Some(Found::Range(own))) => holds(*trained, *own),
            (Some(Found::Word(trained)), Some(Found::Word(own))) if is_of_chain(key) => {
                file_name(trained) == file_name(own)
            }
            (trained, own) => trained == own.as_ref(),
        };
        if holds || self.decides_nothing(key) {
            return None;
        }
        let value = match own {
            Some(Found::Range([least, largest])) if least == largest => least.into(),
            Some(Found::Range(range)) => NoteValue::Text(in_words(range)),
            Some(Found::Word(word)) => NoteValue::Text(word),
            None => NoteValue::None,
        };
        let expected = match trained {
            Some(Found::Range(range)) => in_words(*range),
            Some(Found::Word(word)) => word.clone(),
            None => NoteValue::None.to_string(),
        };
        Some(Note::new(NoteCode::OutsideTraining, key, value, expected, TEXT))
    }

    /// Keys that decide something of a scene like this one, and nothing of a plain rectangle in clear air.
    fn of_scene(&self) -> Vec<&'static str> {
        let shape = match self.get(SHAPE) {
            Some(Found::Word(shape)) => shape,
            _ => String::new(),
        };
        scene::keys(
            &shape,
            |key| matches!(self.get(key), Some(Found::Range(range)) if range != [0.0; 2]),
        )
    }

    /// Whether all that the key would have an effect by is at the reference.
    fn decides_nothing(&self, key: &str) -> bool {
        let dependent = DEPENDENT.iter().find(|(dependent, ..)| *dependent == key);
        dependent.is_some_and(|(_, causes, reference)| {
            let is_there =
                |cause| matches!(self.get(cause), Some(Found::Range(range)) if range == [*reference; 2]);
            causes.iter().all(|cause| is_there(cause))
        })
    }

    fn get(&self, key: &str) -> Option<Found> {
        if let Some((_, range)) = self.grid.iter().find(|(known, _)| *known == key) {
            return Some(Found::Range(*range));
        }
        match self.at(key)? {
            Value::Number(number) => number.as_f64().map(|number| Found::Range([number; 2])),
            Value::String(word) => Some(Found::Word(word.clone())),
            Value::Bool(truth) => Some(Found::Word(truth.to_string())),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;
