//! A grid as the command line or a file has it.

use std::path::Path;

use toml_edit::{Item, Table, Value};

use tofsim::error::{Input, Result, read_text};
use tofsim::files::toml::{Checked, assign};
use tofsim::scenario::Scenario;

use super::axis::Axis;
use super::grid::{DISTANCE, Grid, GridPurpose, IRRADIANCE, REFLECTANCE};

/// The option, as errors name it.
const OPTION: &str = "--grid";

/// Another way to say what [`IRRADIANCE`] says.
const ILLUMINANCE: &str = "ambient.illuminance_klux";

/// Grid that an option names.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum GridOption {
    /// The thesis's of the purpose.
    #[default]
    Thesis,
    /// One of the thesis's.
    ThesisOf(GridPurpose),
    /// One's own.
    Own(Vec<Axis>),
}

impl GridOption {
    /// From every `--grid` of the command line: `thesis`, `train` or `test`, the path of a TOML file,
    /// or `KEY=VALUES` as often as one likes.
    ///
    /// # Errors
    /// When an axis is none ([`Axis::parse`]), or a name does not stand alone.
    pub fn parse(options: &[String]) -> Result<Self> {
        match options.iter().map(String::as_str).collect::<Vec<_>>()[..] {
            [] | ["thesis"] => return Ok(GridOption::Thesis),
            ["train"] => return Ok(GridOption::ThesisOf(GridPurpose::Training)),
            ["test"] => return Ok(GridOption::ThesisOf(GridPurpose::Test)),
            _ => {}
        }
        let mut axes = Vec::new();
        for option in options {
            if option.contains('=') {
                axes.push(Axis::parse(OPTION, option)?);
            } else {
                axes.extend(file(option)?);
            }
        }
        if axes.iter().any(|axis| axis.key == ILLUMINANCE) {
            let expected = format!("expected {IRRADIANCE}, which it stands for");
            return Err(Input::new(OPTION, expected).field(ILLUMINANCE).into());
        }
        Ok(GridOption::Own(axes))
    }

    /// The same for a scenario: without an option, the scene of an array is its own.
    ///
    /// # Errors
    /// As [`GridOption::parse`], and when one of the thesis's grids is named for an array.
    pub fn parse_for(options: &[String], scenario: &Scenario) -> Result<Self> {
        let is_array = scenario.array.count() > 1;
        if is_array && options.is_empty() {
            return Ok(GridOption::Own(Vec::new()));
        }
        match GridOption::parse(options)? {
            GridOption::Own(axes) => Ok(GridOption::Own(axes)),
            _ if is_array => {
                let expected = "expected KEY=... or no grid: the thesis's scenes are those of a single pixel, and \
                    the scenario has an array";
                Err(Input::new(OPTION, expected).value(options.join(" ")).into())
            }
            thesis => Ok(thesis),
        }
    }

    /// The keys that it overrides.
    pub fn keys(&self) -> Vec<&str> {
        match self {
            GridOption::Own(axes) => axes.iter().map(|axis| &*axis.key).collect(),
            _ => vec![DISTANCE, REFLECTANCE, IRRADIANCE],
        }
    }

    /// Checks that no override of the command line sets a key of the grid.
    ///
    /// # Errors
    /// Naming the first that does.
    pub fn check_overrides(&self, overrides: &[String]) -> Result<()> {
        for assignment in overrides {
            let mut table = Table::new();
            assign::<Scenario>(&mut table, "-s", assignment)?;
            let says =
                |key: &&str| has(&table, key) || (*key == IRRADIANCE && has(&table, ILLUMINANCE));
            if let Some(key) = self.keys().into_iter().find(says) {
                let own = match self {
                    GridOption::Own(_) => "",
                    _ => "; another grid is an option, such as --grid target.distance_m=0.9",
                };
                let expected = format!("the grid has the values of {key}{own}");
                return Err(Input::new(format!("-s {assignment}"), expected).into());
            }
        }
        Ok(())
    }

    /// The grid for a purpose; what it does not have is the scenario's.
    ///
    /// # Errors
    /// When it is too large.
    pub fn grid(&self, scenario: &Scenario, purpose: GridPurpose) -> Result<Grid> {
        let purpose = match self {
            GridOption::Own(axes) => return Grid::own(axes, scenario, purpose),
            GridOption::ThesisOf(purpose) => *purpose,
            GridOption::Thesis => purpose,
        };
        Ok(match purpose {
            GridPurpose::Training => Grid::training(),
            GridPurpose::Test => Grid::test(),
        })
    }
}

/// Whether a table has a value at a dotted key.
fn has(table: &Table, key: &str) -> bool {
    let mut parts = key.split('.');
    let first = parts.next().and_then(|part| table.get(part));
    parts.fold(first, |item, part| item?.get(part)).is_some()
}

/// The axes of a file: a key of the scenario each, with a text as the command line has it, a number or
/// a list of numbers.
fn file(path: &str) -> Result<Vec<Axis>> {
    if !path.ends_with(".toml") {
        let expected =
            "expected thesis, train, test, KEY=FROM..TO:STEP, KEY=A,B,C, or a .toml file";
        return Err(Input::new(OPTION, expected).value(path).into());
    }
    let checked = Checked::syntax(path, &read_text(Path::new(path))?)?;
    let mut axes = Vec::new();
    collect(path, "", checked.table().iter(), &mut axes)?;
    if axes.is_empty() {
        Err(Input::new(path, "expected keys of the scenario with their values").into())
    } else {
        Ok(axes)
    }
}

fn collect<'a>(
    source: &str,
    above: &str,
    items: impl Iterator<Item = (&'a str, &'a Item)>,
    axes: &mut Vec<Axis>,
) -> Result<()> {
    for (key, item) in items {
        let key = if above.is_empty() { key.to_owned() } else { format!("{above}.{key}") };
        if let Some(table) = item.as_table_like() {
            collect(source, &key, table.iter(), axes)?;
            continue;
        }
        let text = item.as_value().and_then(values).ok_or_else(|| {
            let expected = "expected \"FROM..TO:STEP\", a number or a list of numbers";
            Input::new(source, expected).field(&key)
        })?;
        axes.push(Axis::parse(source, &format!("{key}={text}"))?);
    }
    Ok(())
}

/// Values as the command line has them.
fn values(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.value().clone()),
        Value::Integer(number) => Some(number.value().to_string()),
        // As it was typed, to the last digit.
        Value::Float(_) => Some(value.to_string().trim().replace('_', "")),
        Value::Array(list) => {
            let each = list.iter().map(|value| match value {
                Value::Integer(_) | Value::Float(_) => values(value),
                _ => None,
            });
            each.collect::<Option<Vec<_>>>().map(|each| each.join(","))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(options: &[&str]) -> Result<GridOption> {
        let options: Vec<_> = options.iter().map(|&option| option.to_owned()).collect();
        GridOption::parse(&options)
    }

    fn refused(option: GridOption, set: &str) -> Option<String> {
        option.check_overrides(&[set.to_owned()]).err().map(|error| error.to_string())
    }

    #[test]
    fn the_thesis_is_the_default_and_has_names() {
        assert_eq!(parse(&[]).unwrap(), GridOption::Thesis);
        assert_eq!(parse(&["thesis"]).unwrap(), GridOption::Thesis);
        let grid = |name, purpose| {
            parse(&[name]).unwrap().grid(&Scenario::default(), purpose).unwrap().name
        };
        assert_eq!(grid("thesis", GridPurpose::Test), "test");
        assert_eq!(grid("train", GridPurpose::Test), "train");
        let error = parse(&["tset"]).unwrap_err().to_string();
        assert!(error.contains("--grid: tset: expected thesis, train, test, KEY="), "{error}");
        assert!(parse(&["thesis", "target.distance_m=1"]).is_err());
    }

    #[test]
    fn a_file_says_the_same_as_options_do() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("grid.toml");
        let write = |text: &str| std::fs::write(&path, text).unwrap();
        let from_file = || parse(&[path.to_str().unwrap()]);
        write(
            "[target]\ndistance_m = \"0.1..0.3:0.1\"\nreflectance = [0.1, 0.5]\n\
             [firmware]\nshots_per_frame = 15_000\n",
        );
        let options = [
            "target.distance_m=0.1..0.3:0.1",
            "target.reflectance=0.1,0.5",
            "firmware.shots_per_frame=15000",
        ];
        assert_eq!(from_file().unwrap(), parse(&options).unwrap());
        for (text, expected) in [
            ("target.distance_m = true", "target.distance_m: expected \"FROM..TO:STEP\""),
            ("target.distance_m = [[1]]", "target.distance_m: expected \"FROM..TO:STEP\""),
            ("target.distance_m = 1001", "a number from 0.001 to 1000.0"),
            ("", "expected keys of the scenario"),
            ("a", "grid.toml:1:2"),
        ] {
            write(text);
            let error = from_file().unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }

    #[test]
    fn an_override_of_what_the_grid_has_is_refused_by_name() {
        let light = refused(GridOption::Thesis, "ambient.illuminance_klux=14").unwrap();
        assert!(light.contains("the grid has the values of ambient.irradiance_w_m2_nm"), "{light}");
        let error = parse(&["ambient.illuminance_klux=1,2"]).unwrap_err().to_string();
        assert!(error.contains("expected ambient.irradiance_w_m2_nm"), "{error}");
        let error = refused(GridOption::Thesis, "target.distance_m=0.9").unwrap();
        let expected =
            "-s target.distance_m=0.9: the grid has the values of target.distance_m; another";
        assert!(error.starts_with(expected), "{error}");
        assert!(refused(GridOption::Thesis, "target={reflectance=0.2}").is_some());
        assert!(refused(GridOption::Thesis, "ambient . irradiance_w_m2_nm = 0").is_some());
        assert_eq!(refused(GridOption::Thesis, "spad.pdp=0.02"), None);
        let own = parse(&["spad.pdp=0.01,0.02"]).unwrap();
        assert_eq!(refused(own.clone(), "target.distance_m=0.9"), None);
        assert!(refused(own, "spad.pdp=0.02").unwrap().contains("the values of spad.pdp"));
    }
}
