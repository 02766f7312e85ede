//! A scenario beside what a network was trained for.

mod keys;
mod scene;

use std::path::Path;

use serde_json::Value;

use crate::error::{Input, Result};
use crate::network::Network;
use crate::network::domain::{Domain, holds, in_words};
use crate::note::{Note, NoteCode, NoteValue};
use crate::scenario::Scenario;

use keys::{DARK_FILE, FOLLOWING, KEYS, LATER, PULSE_FILE};
use scene::{EXTENDED, RECTANGLE, SHAPE};

pub(crate) use keys::OF_DRIFT;

const CHAIN: &str = "tdc.profile";
const CALIBRATION: &str = "tdc.calibration";
const DECODER: &str = "tdc.decoder";
/// What files say nothing of: the only calibration and the only decoder that there was, and the only target.
const UNSAID: [(&str, &str); 4] =
    [(CALIBRATION, OWN_DELAYS), (DECODER, ONES), (SHAPE, RECTANGLE), (EXTENDED, "false")];
const OWN_DELAYS: &str = "true";
const ONES: &str = "ones";
const DARK_RATE: &str = "spad.dark_rate_hz";

/// Text of a note on a network outside its training domain.
const TEXT: &str = "the network was not trained for it";

/// A key of the scenario, and the least and the largest value that a grid gives it.
pub type GridRange<'a> = (&'a str, [f64; 2]);

/// The domain of a network that is trained on histograms of a scenario, whose keys in `grid` have those
/// ranges.
///
/// # Errors
/// When the scenario has no such key.
pub fn of(scenario: &Scenario, grid: &[GridRange]) -> Result<Domain> {
    let values = Values::new(scenario, grid)?;
    let mut domain = Domain::default();
    let words = [CHAIN, CALIBRATION, DECODER, PULSE_FILE, DARK_FILE, SHAPE, EXTENDED];
    for key in KEYS.into_iter().chain(words).chain(values.of_scene()) {
        match values.get(key) {
            Some(Found::Word(word)) if UNSAID.contains(&(key, word.as_str())) => {}
            Some(Found::Range([_, most])) if key == DARK_RATE => {
                // Fewer dark counts are no other histograms: there is one in some 10,000 shots.
                domain.ranges.insert(key.to_owned(), [0.0, most]);
            }
            Some(Found::Range(range)) => drop(domain.ranges.insert(key.to_owned(), range)),
            Some(Found::Word(word)) => drop(domain.words.insert(key.to_owned(), word)),
            None => {}
        }
    }
    Ok(domain)
}

/// Where a scenario, whose keys in `grid` have those ranges, lies outside of what a network was trained
/// for.
///
/// # Errors
/// When the scenario has no such key.
pub fn notes(network: &Network, scenario: &Scenario, grid: &[GridRange]) -> Result<Vec<Note>> {
    let values = Values::new(scenario, grid)?;
    let outside = |key: &str, value: NoteValue, expected: String| {
        Note::new(NoteCode::OutsideTraining, key, value, expected, TEXT)
    };
    let chain = |trained: &str| {
        let own = &scenario.tdc.profile;
        let differs = file_name(trained) != file_name(own);
        differs.then(|| outside(CHAIN, own.as_str().into(), trained.to_owned()))
    };
    let Some(domain) = &network.domain else {
        let text = "the network's file does not say what it was trained for";
        let name = network.name.as_str();
        let expected = "a file with [domain]";
        let key = "estimator.network";
        let unknown = Note::new(NoteCode::OutsideTraining, key, name, expected, text);
        return Ok([unknown].into_iter().chain(chain(&network.training.chain)).collect());
    };
    let mut notes = Vec::new();
    let later = LATER.into_iter().filter(|(key, _)| !domain.ranges.contains_key(*key));
    let ranges = domain.ranges.iter().map(|(key, range)| (key.as_str(), *range));
    for (key, range) in ranges.chain(later.map(|(key, only)| (key, [only; 2]))) {
        match values.get(key) {
            Some(Found::Range(found)) if holds(range, found) => {}
            _ if values.decides_nothing(key) => {}
            Some(Found::Range([least, largest])) if least == largest => {
                notes.push(outside(key, least.into(), in_words(range)));
            }
            Some(Found::Range(found)) => {
                notes.push(outside(key, in_words(found).as_str().into(), in_words(range)));
            }
            _ => notes.push(outside(key, NoteValue::None, in_words(range))),
        }
    }
    for (key, file) in
        [(PULSE_FILE, &scenario.laser.pulse_file), (DARK_FILE, &scenario.spad.dark_file)]
    {
        if let (Some(file), false) = (file, domain.words.contains_key(key)) {
            notes.push(outside(key, file.as_str().into(), "none".to_owned()));
        }
    }
    let trained = domain.words.get(CALIBRATION).map_or(OWN_DELAYS, String::as_str);
    let own = scenario.tdc.calibration.to_string();
    if file_name(trained) != file_name(&own) {
        notes.push(outside(CALIBRATION, own.as_str().into(), trained.to_owned()));
    }
    let trained = domain.words.get(DECODER).map_or(ONES, String::as_str);
    let own = scenario.tdc.decoder.name();
    if trained != own {
        notes.push(outside(DECODER, own.into(), trained.to_owned()));
    }
    for (key, usual) in [(SHAPE, RECTANGLE), (EXTENDED, "false")] {
        let trained = domain.words.get(key).map_or(usual, String::as_str);
        match values.get(key) {
            Some(Found::Word(own)) if own != trained => {
                notes.push(outside(key, own.as_str().into(), trained.to_owned()));
            }
            _ => {}
        }
    }
    for (key, trained) in &domain.words {
        match values.get(key) {
            _ if key == CHAIN => notes.extend(chain(trained)),
            _ if UNSAID.iter().any(|(unsaid, _)| key == unsaid) => {}
            Some(Found::Word(word)) if word == *trained => {}
            Some(Found::Word(word)) => {
                notes.push(outside(key, word.as_str().into(), trained.clone()))
            }
            _ => notes.push(outside(key, NoteValue::None, trained.clone())),
        }
    }
    Ok(notes)
}

/// A chain's name, wherever its file is.
fn file_name(profile: &str) -> Option<&std::ffi::OsStr> {
    Path::new(profile).file_name()
}

/// What stands at the keys of a scenario.
struct Values<'a> {
    scenario: Value,
    grid: &'a [GridRange<'a>],
}

enum Found {
    Range([f64; 2]),
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
        let following = FOLLOWING.iter().find(|(following, ..)| *following == key);
        following.is_some_and(|(_, causes, reference)| {
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
