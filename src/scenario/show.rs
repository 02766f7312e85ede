//! Complete listing of a scenario: every key with its value, meaning, unit, range and source.

use std::fmt::Write;

use serde_json::Value as Json;

use super::keys::{resolve, schema};
use super::model::Scenario;

/// The keys that most people change, in a starter scenario.
const STARTER: [&str; 20] = [
    "description",
    "seed",
    "target.distance_m",
    "target.reflectance",
    "target.shape",
    "ambient.irradiance_w_m2_nm",
    "laser.average_power_w",
    "laser.pulse_sigma_ps",
    "spad.pdp",
    "spad.dark_rate_hz",
    "spad.afterpulse_probability",
    "tdc.profile",
    "tdc.calibration",
    "tdc.bins",
    "tdc.bin_ps",
    "pll.jitter_rms_ps",
    "firmware.laser_freq",
    "firmware.mode",
    "firmware.shots_per_frame",
    "estimator.kind",
];

/// Formats the resolved scenario as TOML. The schema's descriptions, and optional keys that are not set, appear as
/// comments.
pub fn show(scenario: &Scenario) -> String {
    listing(scenario, |_| true)
}

/// Formats the keys of a scenario that most people change as TOML, with the schema's descriptions; the others have their
/// defaults.
pub fn starter(scenario: &Scenario) -> String {
    listing(scenario, |path| STARTER.contains(&path))
}

fn listing(scenario: &Scenario, wants: fn(&str) -> bool) -> String {
    let schema = schema();
    let values = serde_json::to_value(scenario).unwrap_or(Json::Null);
    let mut text = String::new();
    Listing { root: &schema, wants }.table(&mut text, &schema, &values, "", false);
    text.trim_start().to_owned()
}

/// What is listed.
struct Listing<'a> {
    /// The schema.
    root: &'a Json,
    /// Whether a key is listed, by its path.
    wants: fn(&str) -> bool,
}

impl Listing<'_> {
    fn table(&self, text: &mut String, schema: &Json, values: &Json, path: &str, in_list: bool) {
        let empty = serde_json::Map::new();
        let keys = schema["properties"].as_object().unwrap_or(&empty);
        let is_table = |key: &str| values[key].is_object();
        let plain = keys.iter().filter(|(key, _)| !is_table(key));
        for (key, schema) in plain.filter(|(key, _)| (self.wants)(&format!("{path}{key}"))) {
            // What may be left out is, where it says nothing.
            let Some(value) = values.get(key) else { continue };
            let schema = resolve(self.root, schema);
            match value {
                Json::Null if in_list => {}
                Json::Null => {
                    let _ = writeln!(text, "# {}\n# {key} is not given", comment(&schema));
                }
                Json::Array(elements) if elements.iter().all(Json::is_object) => {
                    for element in elements {
                        let _ = write!(text, "\n[[{path}{key}]]\n");
                        let item = resolve(self.root, &schema["items"]);
                        self.table(text, &item, element, &format!("{path}{key}."), true);
                    }
                }
                value => {
                    let _ = writeln!(text, "# {}\n{key} = {}", comment(&schema), literal(value));
                }
            }
        }
        // A table whose keys are the user's own.
        let values_here = values.as_object().into_iter().flatten();
        for (key, value) in values_here.filter(|(key, _)| !keys.contains_key(*key)) {
            let _ = writeln!(text, "{} = {}", literal(&Json::from(key.as_str())), literal(value));
        }
        for (key, schema) in keys.iter().filter(|(key, _)| is_table(key)) {
            let mut inner = String::new();
            let inner_path = format!("{path}{key}.");
            self.table(&mut inner, &resolve(self.root, schema), &values[key], &inner_path, false);
            if !inner.is_empty() || (self.wants)(&inner_path) {
                let _ = write!(text, "\n# {}\n[{path}{key}]\n{inner}", comment(schema));
            }
        }
    }
}

fn comment(schema: &Json) -> String {
    let text = |name| schema[name].as_str();
    let mut comment = text("description").unwrap_or_default().replace('\n', " ");
    if let Some(unit) = text("unit").filter(|&unit| unit != "1") {
        let _ = write!(comment, " [{unit}]");
    }
    if let (Some(low), Some(high)) = (schema.get("minimum"), schema.get("maximum")) {
        let _ = write!(comment, " {low} .. {high}");
    }
    if let Some(source) = text("source") {
        let _ = write!(comment, " ({source})");
    }
    comment
}

fn literal(value: &Json) -> String {
    match value {
        Json::Number(number) if number.is_f64() => {
            let number = number.as_f64().unwrap_or_default();
            if number.abs() >= 1e6 { format!("{number:e}") } else { format!("{number:?}") }
        }
        Json::String(text) => toml_edit::Value::from(text.as_str()).to_string(),
        Json::Array(elements) => {
            let elements: Vec<_> = elements.iter().map(literal).collect();
            format!("[{}]", elements.join(", "))
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::toml::Checked;
    use crate::scenario::{Control, builtin, load};

    #[test]
    fn what_is_shown_can_be_read_again() {
        let scenarios = builtin::scenarios().map(|(name, _)| load(name, &[]).unwrap().scenario);
        for mut scenario in scenarios {
            scenario.control.push(Control { at_us: 99.5, rst: Some(true), ..Control::default() });
            scenario.description += "\n[target]\n# \"quoted\" \\ \t";
            let text = show(&scenario);
            let checked = Checked::parse::<Scenario>("shown", &text).unwrap();
            assert_eq!(checked.read::<Scenario>().unwrap(), scenario);
        }
    }

    #[test]
    fn a_starter_has_the_keys_that_most_people_change() {
        let scenario = load("kc705", &["target.distance_m=0.3".to_owned()]).unwrap().scenario;
        let text = starter(&scenario);
        let again: Scenario = toml::from_str(&text).unwrap();
        assert_eq!(again, scenario);
        let keys = text.lines().filter(|line| !line.starts_with('#') && line.contains(" = "));
        assert_eq!(keys.count(), STARTER.len(), "{text}");
        assert!(text.contains("# Distance from the sensor."), "{text}");
        assert!(!text.contains("[atmosphere]"), "{text}");
    }

    #[test]
    fn a_key_that_is_not_given_is_shown_with_its_meaning() {
        let text = show(&Scenario::default());
        assert!(text.contains("# illuminance_klux is not given"), "{text}");
        assert!(text.contains("[klux] 0.0 .. 1000.0 (eq. 3.15 to 3.18; Table 3.2: 14)"), "{text}");
        let in_klux = load("kc705", &["ambient.illuminance_klux=14".to_owned()]).unwrap().scenario;
        let text = show(&in_klux);
        assert!(text.contains("irradiance_w_m2_nm = 0.582"), "{text}");
        assert_eq!(toml::from_str::<Scenario>(&text).unwrap(), in_klux);
    }

    #[test]
    fn every_number_has_a_unit_a_range_and_a_source() {
        let schema = schema();
        for (name, table) in schema["$defs"].as_object().unwrap() {
            let Some(keys) = table["properties"].as_object() else { continue };
            for (key, field) in keys {
                let kind = field["type"].as_str().or(field["type"][0].as_str());
                if matches!(kind, Some("number" | "integer")) {
                    for attribute in ["unit", "minimum", "maximum", "source", "description"] {
                        assert!(!field[attribute].is_null(), "{name}.{key}: no {attribute}");
                    }
                }
            }
        }
    }
}
