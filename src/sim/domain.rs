//! A scenario beside what a network was trained for.

use std::path::Path;

use serde_json::Value;

use crate::error::{Input, Result};
use crate::network::Network;
use crate::network::domain::{Domain, holds, in_words};
use crate::note::{Note, NoteCode, NoteValue};
use crate::scenario::Scenario;

/// Keys of the scenario that decide how the histograms of a frame are distributed. The laser's rate is
/// none of them: in MODE 0 every shot begins with a reset.
const KEYS: [&str; 28] = [
    "target.distance_m",
    "target.reflectance",
    "target.length_m",
    "target.width_m",
    "ambient.model",
    "ambient.irradiance_w_m2_nm",
    "ambient.fitted_rate_hz_per_w_m2_nm",
    "laser.average_power_w",
    "laser.repetition_rate_hz",
    "laser.wavelength_nm",
    "laser.pulse_sigma_ps",
    "laser.field_of_illumination_deg",
    "lens.area_m2",
    "lens.efficiency",
    "filter.efficiency",
    "filter.sigma_nm",
    "spad.pdp",
    "spad.fill_factor",
    "spad.count",
    ON_TDC,
    "spad.field_of_view_deg",
    "spad.dark_rate_hz",
    BIN,
    FIRST_BIN,
    CLK_SYS,
    "pll.jitter_rms_ps",
    "firmware.mode",
    SHOTS,
];
const ON_TDC: &str = "spad.on_tdc";
const BIN: &str = "tdc.bin_ps";
const FIRST_BIN: &str = "tdc.first_bin_ps";
/// What the dividers come to, which no key of a file says [MHz].
const CLK_SYS: &str = "pll.clk_sys_mhz";
/// Keys that older files do not have, and the only value that there was.
const LATER: [(&str, f64); 4] = [(ON_TDC, 1.0), (BIN, 25.0), (FIRST_BIN, 0.0), (CLK_SYS, 125.0)];
const CHAIN: &str = "tdc.profile";
const DARK_RATE: &str = "spad.dark_rate_hz";
const SHOTS: &str = "firmware.shots_per_frame";

/// What a note says of a network outside its domain.
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
    for key in KEYS.into_iter().chain([CHAIN]) {
        match values.get(key) {
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
            Some(Found::Range([least, largest])) if least == largest => {
                notes.push(outside(key, least.into(), in_words(range)));
            }
            Some(Found::Range(found)) => {
                notes.push(outside(key, in_words(found).as_str().into(), in_words(range)));
            }
            _ => notes.push(outside(key, NoteValue::None, in_words(range))),
        }
    }
    for (key, trained) in &domain.words {
        match values.get(key) {
            _ if key == CHAIN => notes.extend(chain(trained)),
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
mod tests {
    use super::*;
    use crate::scenario::{self, builtin};

    const THESIS: [GridRange; 3] = [
        ("target.distance_m", [0.1, 0.6]),
        ("target.reflectance", [0.08, 0.6]),
        ("ambient.irradiance_w_m2_nm", [0.0, 0.4]),
    ];

    fn network() -> Network {
        Network::builtin("uniform").unwrap().unwrap()
    }

    fn keys(change: impl FnOnce(&mut Scenario)) -> Vec<String> {
        let mut scenario = Scenario::default();
        change(&mut scenario);
        let notes = notes(&network(), &scenario, &[]).unwrap();
        assert!(notes.iter().all(|note| note.code == NoteCode::OutsideTraining));
        notes.into_iter().map(|note| note.key).collect()
    }

    #[test]
    fn the_shipped_files_state_the_domain_of_their_training() {
        for name in Network::builtin_names() {
            let network = Network::builtin(name).unwrap().unwrap();
            if builtin::scenario(name).is_some() {
                let scenario = scenario::load(name, &[]).unwrap().scenario;
                assert!(network.domain.is_some(), "{name}");
                assert_eq!(notes(&network, &scenario, &[]).unwrap(), [], "{name}");
                continue;
            }
            let mut scenario = Scenario::default();
            scenario.tdc.profile = network.training.chain.clone();
            assert_eq!(network.domain, Some(of(&scenario, &THESIS).unwrap()), "{name}");
        }
    }

    #[test]
    fn each_thing_that_the_network_was_not_trained_for_is_named() {
        assert_eq!(keys(|_| {}), [""; 0]);
        assert_eq!(keys(|s| s.target.distance_m = 0.65), ["target.distance_m"]);
        assert_eq!(keys(|s| s.target.reflectance = 0.03), ["target.reflectance"]);
        assert_eq!(keys(|s| s.firmware.shots_per_frame = 10_000), ["firmware.shots_per_frame"]);
        assert_eq!(keys(|s| s.firmware.dark_frames = true), ["firmware.shots_per_frame"]);
        assert_eq!(keys(|s| s.lens.area_m2 *= 10.0), ["lens.area_m2"]);
        assert_eq!(keys(|s| s.tdc.profile = "ideal".into()), ["tdc.profile"]);
        assert_eq!(keys(|s| s.spad.dark_rate_hz = 0.0), [""; 0]);
        assert_eq!(keys(|s| s.pll.output_divide = 10), ["pll.clk_sys_mhz"]);
        assert_eq!(keys(|s| (s.pll.divide, s.pll.output_divide) = (2, 4)), [""; 0]);
        assert_eq!(keys(|s| s.firmware.laser_freq = 0), [""; 0]);
        let mode = |s: &mut Scenario| s.firmware.mode = crate::scenario::QuenchMode::FreeRunning;
        assert_eq!(keys(mode), ["firmware.mode"]);
    }

    #[test]
    fn a_grid_is_held_to_the_domain_as_a_whole() {
        let (network, scenario) = (network(), Scenario::default());
        assert_eq!(notes(&network, &scenario, &THESIS).unwrap(), []);
        let wide = [("target.distance_m", [0.05, 0.6])];
        let notes = notes(&network, &scenario, &wide).unwrap();
        assert_eq!(notes.len(), 1);
        assert_eq!(notes[0].value, NoteValue::Text("0.05 to 0.6".to_owned()));
        assert_eq!(notes[0].expected, "0.1 to 0.6");
        assert!(of(&scenario, &[("target.distance", [0.0, 1.0])]).is_err());
    }

    #[test]
    fn a_file_that_does_not_say_is_said_to_be_silent() {
        let silent = Network { domain: None, ..network() };
        let notes = notes(&silent, &Scenario::default(), &[]).unwrap();
        assert_eq!(notes.len(), 1);
        assert_eq!(notes[0].key, "estimator.network");
    }
}
