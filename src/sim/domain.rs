//! A scenario beside what a network was trained for.

use std::path::Path;

use serde_json::Value;

use crate::error::{Input, Result};
use crate::network::Network;
use crate::network::domain::{Domain, holds, in_words};
use crate::note::{Note, NoteCode, NoteValue};
use crate::optics::dark::STATED_AT_C;
use crate::scenario::Scenario;
use crate::scenario::drift::REFERENCE_C;

/// Keys of the scenario that decide how the histograms of a frame are distributed. The laser's rate is
/// none of them: in MODE 0 every shot begins with a reset.
const KEYS: [&str; 54] = [
    "target.distance_m",
    "target.reflectance",
    "target.length_m",
    "target.width_m",
    TILT,
    YAW,
    OFFSET_X,
    OFFSET_Y,
    PATCH,
    VISIBILITY,
    RAIN,
    "ambient.model",
    "ambient.irradiance_w_m2_nm",
    "ambient.fitted_rate_hz_per_w_m2_nm",
    "laser.average_power_w",
    "laser.repetition_rate_hz",
    "laser.wavelength_nm",
    "laser.pulse_sigma_ps",
    TAIL,
    DELAY,
    TIMING,
    ENERGY,
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
    TEMPERATURE,
    DOUBLING,
    SPREAD,
    AFTERPULSES,
    ROW_OUTPUTS,
    PULSE,
    PULSE_GAP,
    BIN,
    FIRST_BIN,
    DIE,
    SUPPLY,
    DIE_THEN,
    SUPPLY_THEN,
    PER_C,
    PER_MV,
    RECALIBRATED,
    WINDOW,
    CLK_SYS,
    "pll.jitter_rms_ps",
    "firmware.mode",
    SHOTS,
];
const TILT: &str = "target.tilt_deg";
const YAW: &str = "target.yaw_deg";
const OFFSET_X: &str = "target.offset_x_m";
const OFFSET_Y: &str = "target.offset_y_m";
const PATCH: &str = "target.retro_side_m";
const VISIBILITY: &str = "atmosphere.visibility_m";
const RAIN: &str = "atmosphere.rain_mm_h";
const TAIL: &str = "laser.pulse_tail_ps";
const DELAY: &str = "laser.delay_ps";
const TIMING: &str = "laser.timing_jitter_ps";
const ENERGY: &str = "laser.energy_jitter";
const PULSE_FILE: &str = "laser.pulse_file";
const ON_TDC: &str = "spad.on_tdc";
const TEMPERATURE: &str = "spad.temperature_c";
const DOUBLING: &str = "spad.dark_doubling_c";
const SPREAD: &str = "spad.dark_spread";
const AFTERPULSES: &str = "spad.afterpulse_probability";
const ROW_OUTPUTS: &str = "spad.row_outputs";
const CROSSTALK: &str = "spad.crosstalk_probability";
const PULSE: &str = "spad.pulse_ns";
const PULSE_GAP: &str = "spad.pulse_gap_ns";
const DARK_FILE: &str = "spad.dark_file";
const BIN: &str = "tdc.bin_ps";
const FIRST_BIN: &str = "tdc.first_bin_ps";
const DIE: &str = "tdc.temperature_c";
const SUPPLY: &str = "tdc.supply_mv";
const DIE_THEN: &str = "tdc.calibrated_at_c";
const SUPPLY_THEN: &str = "tdc.calibrated_at_mv";
const PER_C: &str = "tdc.delay_per_c";
const PER_MV: &str = "tdc.delay_per_mv";
const RECALIBRATED: &str = "tdc.recalibrate_frames";
const WINDOW: &str = "tdc.setup_window_ps";
/// What a drift of the chain is of.
pub(crate) const OF_DRIFT: [&str; 6] = [DIE, SUPPLY, DIE_THEN, SUPPLY_THEN, PER_C, PER_MV];
/// Keys that say what follows from others, and decide nothing while these are all at a reference.
const FOLLOWING: [(&str, &[&str], f64); 4] = [
    // Outputs that are not on the TDC come to it by crosstalk alone.
    (ROW_OUTPUTS, &[CROSSTALK], 0.0),
    (DOUBLING, &[TEMPERATURE], STATED_AT_C),
    (PER_C, &[DIE, DIE_THEN], REFERENCE_C),
    (PER_MV, &[SUPPLY, SUPPLY_THEN], 0.0),
];
/// What the dividers come to, which no key of a file says [MHz].
const CLK_SYS: &str = "pll.clk_sys_mhz";
/// Keys that older files do not have, and the only value that there was.
const LATER: [(&str, f64); 30] = [
    (TILT, 0.0),
    (YAW, 0.0),
    (OFFSET_X, 0.0),
    (OFFSET_Y, 0.0),
    (PATCH, 0.0),
    (VISIBILITY, 0.0),
    (RAIN, 0.0),
    (TAIL, 0.0),
    (DELAY, 0.0),
    (TIMING, 0.0),
    (ENERGY, 0.0),
    (ON_TDC, 1.0),
    (TEMPERATURE, 20.0),
    (DOUBLING, 8.0),
    (SPREAD, 0.0),
    (AFTERPULSES, 0.0),
    (ROW_OUTPUTS, 0.0),
    (PULSE, 0.0),
    (PULSE_GAP, 0.0),
    (BIN, 25.0),
    (FIRST_BIN, 0.0),
    (DIE, 25.0),
    (SUPPLY, 0.0),
    (DIE_THEN, 25.0),
    (SUPPLY_THEN, 0.0),
    (PER_C, 0.001),
    (PER_MV, -0.001),
    (RECALIBRATED, 0.0),
    (WINDOW, 0.0),
    (CLK_SYS, 125.0),
];
const CHAIN: &str = "tdc.profile";
const CALIBRATION: &str = "tdc.calibration";
const DECODER: &str = "tdc.decoder";
const SHAPE: &str = "target.shape";
const EXTENDED: &str = "target.extended";
/// What files say nothing of: the only calibration and the only decoder that there was, and the only target.
const UNSAID: [(&str, &str); 4] =
    [(CALIBRATION, OWN_DELAYS), (DECODER, ONES), (SHAPE, RECTANGLE), (EXTENDED, "false")];
const RECTANGLE: &str = "rectangle";
/// Keys that decide something with one shape.
const OF_SHAPE: [(&str, &[&str]); 4] = [
    ("disc", &["target.radius_m"]),
    ("sphere", &["target.radius_m"]),
    ("step", &["target.second_distance_m", "target.edge_m"]),
    ("mesh", &["target.mesh_unit_m", "target.mesh_file"]),
];
/// Keys that decide something where another one is not 0.
const OF_NUMBER: [(&str, &[&str]); 3] = [
    (PATCH, &["target.retro_x_m", "target.retro_y_m", "target.retro_cd_lx_m2"]),
    (
        VISIBILITY,
        &[
            "atmosphere.visibility_model",
            "atmosphere.visibility_contrast",
            LIDAR_RATIO,
            OVERLAP,
            AIRLIGHT,
        ],
    ),
    (RAIN, &["atmosphere.rain_db_km", "atmosphere.rain_exponent", LIDAR_RATIO, OVERLAP, AIRLIGHT]),
];
const LIDAR_RATIO: &str = "atmosphere.lidar_ratio_sr";
const OVERLAP: &str = "atmosphere.overlap_m";
const AIRLIGHT: &str = "atmosphere.airlight";
const OWN_DELAYS: &str = "true";
const ONES: &str = "ones";
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
        let is_shape =
            |shape: &str| matches!(self.get(SHAPE), Some(Found::Word(own)) if own == shape);
        let is_there =
            |key: &str| matches!(self.get(key), Some(Found::Range(range)) if range != [0.0; 2]);
        let shapes = OF_SHAPE.into_iter().filter(|(shape, _)| is_shape(shape));
        let numbers = OF_NUMBER.into_iter().filter(|(key, _)| is_there(key));
        shapes.chain(numbers).flat_map(|(_, keys)| keys).copied().collect()
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
