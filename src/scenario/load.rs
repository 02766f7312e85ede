//! Loading of a scenario: finds its file, applies overrides, and checks the result.

use std::path::Path;

use toml_edit::Table;

use crate::error::{Input, Result, hint, read_text};
use crate::files::toml::{Checked, RenamedKey, assign, merge, read, rename};
use crate::note::{Note, NoteCode};

use super::builtin::{self, Source};
use super::illuminance;
use super::model::Scenario;
use super::validate;

/// Name of the scenario that is used by default.
pub const DEFAULT: &str = "kc705";

/// A checked scenario with its name, overrides and the origin of its files.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// Built-in name, or the file's stem.
    pub name: String,
    /// The checked values.
    pub scenario: Scenario,
    /// The `key=value` overrides that were applied, as given.
    pub set: Vec<String>,
    /// Origin of the files that the scenario names.
    pub files: Source,
    /// Notes on keys that were given by a former name.
    pub renamed: Vec<Note>,
}

/// Loads a built-in scenario by name or a scenario file by path, and applies `key=value` overrides.
///
/// # Errors
/// If there is no such scenario, or the scenario or an override is invalid.
pub fn load(name: &str, overrides: &[String]) -> Result<Loaded> {
    if let Some(text) = builtin::scenario(name) {
        return from_text(name, &format!("scenario {name}"), text, Source::BuiltIn, overrides);
    }
    let path = Path::new(name);
    if !path.exists() && !name.contains(['/', '.']) {
        let (hint, _) = hint(name, builtin::scenarios().map(|(name, _)| name));
        let expected = format!("no such file or built-in scenario{hint}; see `scenario list`");
        return Err(Input::new("scenario", expected).value(name).into());
    }
    let text = read_text(path)?;
    let stem = path.file_stem().map_or(name.into(), |stem| stem.to_string_lossy());
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    from_text(&stem, name, &text, Source::Folder(folder), overrides)
}

/// Parses the text of a scenario file, and applies `key=value` overrides. Errors name the file as `source`; `files`
/// locates the files that the scenario names.
///
/// # Errors
/// If the scenario or an override is invalid.
pub fn from_text(
    name: &str,
    source: &str,
    text: &str,
    files: Source,
    overrides: &[String],
) -> Result<Loaded> {
    let checked = Checked::parse::<Scenario>(source, text)?;
    let (mut table, mut over) = (checked.table().clone(), Table::new());
    for assignment in overrides {
        assign::<Scenario>(&mut over, "-s", assignment)?;
    }
    let mut renamed = rename::<Scenario>(source, &mut table)?;
    renamed.extend(rename::<Scenario>("-s", &mut over)?);
    illuminance::settle_overrides(&checked, &mut table, &over)?;
    merge(&mut table, &over);
    validate::windows(&table, &checked)?;
    let mut scenario: Scenario = read(source, &table)?;
    illuminance::settle(&mut scenario, &checked)?;
    validate::validate(&scenario, &checked)?;
    let renamed = renamed.into_iter().map(renamed_key).collect();
    Ok(Loaded { name: name.to_owned(), scenario, set: overrides.to_vec(), files, renamed })
}

/// Creates the note that a key was given by its former name.
fn renamed_key(key: RenamedKey) -> Note {
    let RenamedKey { former, present, value } = key;
    Note::new(NoteCode::RenamedKey, former, &*value, present, "the key has been renamed")
}

#[cfg(test)]
mod tests {
    use crate::scenario::AmbientModel;

    use super::*;

    fn from_text(text: &str, overrides: &[&str]) -> std::result::Result<Scenario, String> {
        let overrides: Vec<_> = overrides.iter().map(|&o| o.to_owned()).collect();
        super::from_text("t", "t.toml", text, Source::BuiltIn, &overrides)
            .map(|loaded| loaded.scenario)
            .map_err(|error| error.to_string())
    }

    #[test]
    fn every_built_in_scenario_loads() {
        for (name, _) in builtin::scenarios() {
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
            error.ends_with("target.distance_m = -0.5: expected a number from 0.001 to 1000.0 [m]")
        );
        let error = from_text("", &["firmware.shots_per_frame=.5"]).unwrap_err();
        assert!(error.contains("= 0.5: expected a whole number"), "{error}");
    }

    #[test]
    fn faults_have_line_and_column() {
        let error = |text| from_text(text, &[]).unwrap_err();
        assert_eq!(
            error("[target]\ndistance_m = -0.5\n"),
            "t.toml:2:14: target.distance_m = -0.5: expected a number from 0.001 to 1000.0 [m]"
        );
        assert!(error("[target]\ndistance_m = nan").contains("expected a number"));
        assert!(error("[target]\ndistance_m = \"1\"").contains("expected a number from"));
        assert!(error("[targett]").contains("did you mean `target`?"));
        assert!(error("[target]\ndistanse_m = 1").starts_with("t.toml:2:1: target.distanse_m"));
        assert!(error("[firmware]\nshots_per_frame = 0").contains("from 1 to 16777215 [shots]"));
        assert!(error("[firmware]\nshots_per_frame = 65536").contains("expected 65535 at most"));
        assert!(error("[firmware]\nshots_per_frame = 10.5").contains("a whole number"));
        assert!(error("a = [1,\n2").starts_with("t.toml:2:"));
        assert!(error("[ambient]\nmodel = \"fited\"").contains("`fitted`, `physical`"));
        assert!(error("[[control]]\nat_us = 1\nlaser_frequ = 1").contains("`laser_freq`"));
    }

    #[test]
    fn ambient_light_may_be_stated_in_klux() {
        let irradiance = |text, overrides: &[&str]| {
            from_text(text, overrides).unwrap().ambient.irradiance_w_m2_nm
        };
        let of_14_klux = irradiance("", &["ambient.illuminance_klux=14"]);
        assert!((of_14_klux - 0.582).abs() < 1e-3, "{of_14_klux}, and not the default");
        let in_file = "[ambient]\nilluminance_klux = 14";
        assert_eq!(irradiance(in_file, &[]), of_14_klux);
        assert_eq!(irradiance(in_file, &["target.distance_m=0.3"]), of_14_klux);
        assert_eq!(irradiance("", &["ambient.illuminance_klux=0"]), 0.0);
        let red = ["ambient.illuminance_klux=14", "laser.wavelength_nm=700"];
        assert!(irradiance("", &red) < 0.7 * of_14_klux, "a black body has less there");
    }

    #[test]
    fn a_klux_may_be_one_of_sunlight_where_that_is_known() {
        let sun = ["ambient.illuminance_klux=100", "ambient.spectrum=sun"];
        let found = from_text("", &sun).unwrap().ambient.irradiance_w_m2_nm;
        assert!((found - 0.3384).abs() < 1e-4, "{found}");
        let watts = from_text("", &["ambient.spectrum=sun"]).unwrap().ambient;
        assert_eq!(watts.irradiance_w_m2_nm, 0.2, "it decides what a klux is only");
        let error = |over| from_text("", &[&sun[..], &[over]].concat()).unwrap_err();
        for (over, wavelength_nm) in [
            ("laser.wavelength_nm=650", 650),
            ("laser.wavelength_nm=1150", 1150),
            ("filter.sigma_nm=60", 940),
        ] {
            let expected =
                format!("laser.wavelength_nm = {wavelength_nm}: expected 6 filter.sigma_nm");
            assert!(error(over).contains(&expected), "{}", error(over));
        }
        assert!(
            from_text("", &["ambient.spectrum=moon"]).unwrap_err().contains("`halogen`, `sun`")
        );
    }

    #[test]
    fn an_override_states_ambient_light_in_place_of_the_file() {
        let ambient = |text, over| from_text(text, &[over]).unwrap().ambient;
        let watts = "[ambient]\nirradiance_w_m2_nm = 0.1";
        let found = ambient(watts, "ambient.illuminance_klux=14").irradiance_w_m2_nm;
        assert!((found - 0.582).abs() < 1e-3, "{found}");
        let klux = "ambient = { illuminance_klux = 14, model = \"physical\" }";
        let found = ambient(klux, "ambient.irradiance_w_m2_nm=0.1");
        assert_eq!((found.irradiance_w_m2_nm, found.model), (0.1, AmbientModel::Physical));
    }

    #[test]
    fn ambient_light_stated_twice_is_refused() {
        let both = "[ambient]\nirradiance_w_m2_nm = 0.2\nilluminance_klux = 14";
        for overrides in [&[][..], &["ambient.illuminance_klux=3"]] {
            assert_eq!(
                from_text(both, overrides).unwrap_err(),
                "t.toml:3:20: ambient.illuminance_klux = 14: expected one statement of the ambient \
                 light, ambient.irradiance_w_m2_nm is given too"
            );
        }
        for over in [
            &["ambient.illuminance_klux=3", "ambient.irradiance_w_m2_nm=0.1"][..],
            &["ambient={irradiance_w_m2_nm=0.1, illuminance_klux=3}"],
        ] {
            assert_eq!(
                from_text("", over).unwrap_err(),
                "-s ambient.illuminance_klux: expected one statement of the ambient light, \
                 -s ambient.irradiance_w_m2_nm is given too"
            );
        }
        let error = from_text("[ambient]\nilluminance_klux = -1", &[]).unwrap_err();
        assert!(error.contains("expected a number from 0.0 to 1000.0 [klux]"), "{error}");
    }

    #[test]
    fn a_key_may_be_given_by_its_former_name_with_a_note() {
        let load = |text, overrides: &[&str]| {
            let overrides: Vec<_> = overrides.iter().map(|&o| o.to_owned()).collect();
            super::from_text("t", "t.toml", text, Source::BuiltIn, &overrides)
        };
        let former = "[estimator]\ntold_sigma_ps = 133\ntold_shots = 9";
        let loaded = load(former, &["estimator.told_shots=30300"]).unwrap();
        let estimator = &loaded.scenario.estimator;
        assert_eq!((estimator.assumed_sigma_ps, estimator.assumed_shots), (133.0, 30_300));
        let notes: Vec<_> = loaded.renamed.iter().map(ToString::to_string).collect();
        assert_eq!(notes.len(), 3);
        assert_eq!(
            notes[2],
            "note: estimator.told_shots = 30300: the key has been renamed \
             (expected estimator.assumed_shots) [renamed-key]"
        );
        let loaded = load(former, &["estimator.assumed_shots=8"]).unwrap();
        assert_eq!(loaded.scenario.estimator.assumed_shots, 8);
        let both = load("", &["estimator.told_shots=1", "estimator.assumed_shots=2"]).unwrap_err();
        assert_eq!(
            both.to_string(),
            "-s: estimator.told_shots = 1: expected one of estimator.assumed_shots and its former name"
        );
    }

    #[test]
    fn a_faulty_override_is_named() {
        let error = |o| from_text("", &[o]).unwrap_err();
        assert!(error("target.distance_m=-1").starts_with("-s target.distance_m=-1: "));
        assert!(error("target.distance=1").contains("did you mean `distance_m`?"));
        assert!(error("target").contains("expected key=value"));
    }
}
