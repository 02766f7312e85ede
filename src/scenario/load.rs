//! Finds a scenario, lays overrides over it, and checks the whole.

use std::path::Path;

use crate::error::{Input, Result, hint, read_text};
use crate::files::toml::{Checked, assign, read};

use super::builtin::{self, Source};
use super::model::Scenario;
use super::validate;

/// The scenario that `run` takes when none is named.
pub const DEFAULT: &str = "kc705";

/// A scenario, where it came from, and where its files are.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// Built-in name, or the file's stem.
    pub name: String,
    /// The checked values.
    pub scenario: Scenario,
    /// The `key=value` overrides that are in them, as given.
    pub set: Vec<String>,
    /// Where the files are that it names.
    pub files: Source,
}

/// Loads a built-in scenario by name or a file by path, with `key=value` overrides.
pub fn load(name: &str, overrides: &[String]) -> Result<Loaded> {
    if let Some(text) = builtin::scenario(name) {
        return parse(name, &format!("scenario {name}"), text, Source::BuiltIn, overrides);
    }
    let path = Path::new(name);
    if !path.exists() && !name.contains(['/', '.']) {
        let (hint, _) = hint(name, builtin::SCENARIOS.iter().map(|(name, _)| *name));
        let expected = format!("no such file or built-in scenario{hint}; see `scenario list`");
        return Err(Input::new("scenario", expected).value(name).into());
    }
    let text = read_text(path)?;
    let stem = path.file_stem().map_or(name.into(), |stem| stem.to_string_lossy());
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    parse(&stem, name, &text, Source::Folder(folder), overrides)
}

fn parse(
    name: &str,
    source: &str,
    text: &str,
    files: Source,
    overrides: &[String],
) -> Result<Loaded> {
    let checked = Checked::parse::<Scenario>(source, text)?;
    let mut table = checked.table().clone();
    for assignment in overrides {
        assign::<Scenario>(&mut table, "-s", assignment)?;
    }
    validate::windows(&table, &checked)?;
    let scenario: Scenario = read(source, &table)?;
    validate::validate(&scenario, &checked)?;
    Ok(Loaded { name: name.to_owned(), scenario, set: overrides.to_vec(), files })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_text(text: &str, overrides: &[&str]) -> std::result::Result<Scenario, String> {
        let overrides: Vec<_> = overrides.iter().map(|&o| o.to_owned()).collect();
        parse("t", "t.toml", text, Source::BuiltIn, &overrides)
            .map(|loaded| loaded.scenario)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn every_built_in_scenario_loads() {
        for (name, _) in builtin::SCENARIOS {
            let loaded = load(name, &[]).unwrap();
            assert!(!loaded.scenario.description.is_empty(), "{name}");
        }
        assert_eq!(load(DEFAULT, &[]).unwrap().scenario.target.distance_m, 0.5);
    }

    #[test]
    fn an_override_reaches_a_nested_key() {
        let scenario = from_text("", &["target.distance_m=0.25", "tdc.profile=ideal"]).unwrap();
        assert_eq!(scenario.target.distance_m, 0.25);
        assert_eq!(scenario.tdc.profile, "ideal");
        let scenario = from_text("[target]\nreflectance = 0.5", &["target.distance_m=1"]).unwrap();
        assert_eq!((scenario.target.distance_m, scenario.target.reflectance), (1.0, 0.5));
    }

    #[test]
    fn a_number_needs_no_digit_on_either_side_of_its_point() {
        let scenario = from_text("", &["target.reflectance=.9", "target.distance_m=1."]).unwrap();
        assert_eq!((scenario.target.reflectance, scenario.target.distance_m), (0.9, 1.0));
        // A text stays one.
        assert_eq!(from_text("", &["tdc.profile=007"]).unwrap().tdc.profile, "007");
        let error = from_text("", &["target.distance_m=-.5"]).unwrap_err();
        assert!(
            error.ends_with("target.distance_m = -0.5: expected a number from 0.001 to 6.9 [m]")
        );
        let error = from_text("", &["firmware.shots_per_frame=.5"]).unwrap_err();
        assert!(error.contains("= 0.5: expected a whole number"), "{error}");
    }

    #[test]
    fn faults_have_line_and_column() {
        let error = |text| from_text(text, &[]).unwrap_err();
        assert_eq!(
            error("[target]\ndistance_m = -0.5\n"),
            "t.toml:2:14: target.distance_m = -0.5: expected a number from 0.001 to 6.9 [m]"
        );
        assert!(error("[target]\ndistance_m = nan").contains("expected a number"));
        assert!(error("[target]\ndistance_m = \"1\"").contains("expected a number from"));
        assert!(error("[targett]").contains("did you mean `target`?"));
        assert!(error("[target]\ndistanse_m = 1").starts_with("t.toml:2:1: target.distanse_m"));
        assert!(error("[firmware]\nshots_per_frame = 0").contains("from 1 to 65535 [shots]"));
        assert!(error("[firmware]\nshots_per_frame = 65536").contains("from 1 to 65535 [shots]"));
        assert!(error("[firmware]\nshots_per_frame = 10.5").contains("a whole number"));
        assert!(error("a = [1,\n2").starts_with("t.toml:2:"));
        assert!(error("[ambient]\nmodel = \"fited\"").contains("`fitted`, `physical`"));
        assert!(error("[[control]]\nat_us = 1\nlaser_frequ = 1").contains("`laser_freq`"));
    }

    #[test]
    fn a_faulty_override_is_named() {
        let error = |o| from_text("", &[o]).unwrap_err();
        assert!(error("target.distance_m=-1").starts_with("-s target.distance_m=-1: "));
        assert!(error("target.distance=1").contains("did you mean `distance_m`?"));
        assert!(error("target").contains("expected key=value"));
    }
}
