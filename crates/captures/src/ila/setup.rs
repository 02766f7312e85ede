//! Probe configurations: TOML files, and overrides from the command line.

use std::fmt::Display;
use std::path::Path;

use schemars::JsonSchema;
use serde::Deserialize;
use strum::IntoStaticStr;

use tofsim::error::{Error, Input, Result, hint, read_text};
use tofsim::files::toml::Checked;

use super::builtin;
use super::capture::Radix;

/// Contents of a configuration file.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(rename = "File")]
pub struct AnalyserSetupFile {
    /// Name of the capture and of its files [default: the file's name].
    pub name: Option<String>,
    /// Description of the capture.
    pub description: String,
    /// Default scenario.
    pub scenario: String,
    /// Overrides of the scenario's keys, such as `target.distance_m=0.3`.
    pub set: Vec<String>,
    /// Default number of frames to simulate at most.
    #[schemars(range(min = 1, max = 1_000_000), extend("unit" = "frames"))]
    pub frames: u64,
    /// Sampling clock: `clk_sys`, `clk_laser`, `clk_in`, or a free-running clock such as `100MHz + 250ps`, with
    /// frequency and time of the first rising edge.
    pub clock: String,
    /// Buffer depth in samples, a power of two.
    #[schemars(range(min = 1024, max = 131_072), extend("unit" = "samples"))]
    pub depth: u64,
    /// Number of windows, each with its own trigger. A window has the largest power of two of samples with which all
    /// windows fit.
    #[schemars(range(min = 1, max = 131_072), extend("unit" = "windows"))]
    pub windows: u64,
    /// Samples of a window before its trigger [default: half of them].
    #[schemars(range(min = 0, max = 131_071), extend("unit" = "samples"))]
    pub position: Option<u64>,
    /// Trigger condition, over names of probes and paths of signals [default: any sample].
    pub trigger: Option<String>,
    /// Condition under which a sample is stored [default: always].
    pub capture: Option<String>,
    /// Time from power-up at which the analyser is armed. Earlier samples are ignored.
    #[schemars(range(min = 0.0, max = 1e9), extend("unit" = "us"))]
    pub arm_at_us: f64,
    /// Number of registers between the signals and the analyser: samples are delayed by as many edges.
    #[schemars(range(min = 0, max = 6), extend("unit" = "edges"))]
    pub input_stages: u64,
    /// Probes, first one in the lowest bits of a sample.
    pub probe: Vec<ProbeEntry>,
}

impl Default for AnalyserSetupFile {
    fn default() -> Self {
        AnalyserSetupFile {
            name: None,
            description: String::new(),
            scenario: tofsim::scenario::DEFAULT.to_owned(),
            set: Vec::new(),
            frames: 1,
            clock: "clk_sys".to_owned(),
            depth: 1024,
            windows: 1,
            position: None,
            trigger: None,
            capture: None,
            arm_at_us: 0.0,
            input_stages: 0,
            probe: Vec::new(),
        }
    }
}

/// A probe.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProbeEntry {
    /// Name in the capture [default: the signal's path with slashes].
    #[serde(default)]
    pub name: Option<String>,
    /// Path of a signal below `tof_top`, or a slice of it: `tdc.tdc_decoder.n[7:4]`.
    pub signal: String,
    /// Radix of its values.
    #[serde(default)]
    pub radix: RadixWord,
}

/// Radix of a probe's values, as a configuration states it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, IntoStaticStr, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "UPPERCASE")]
pub enum RadixWord {
    /// The radix that suits the signal.
    #[default]
    Auto,
    /// Hexadecimal.
    Hex,
    /// Two's complement, decimal.
    Signed,
    /// Decimal.
    Unsigned,
    /// Octal.
    Octal,
    /// Binary.
    Binary,
}

impl RadixWord {
    /// Returns the radix of this name, unless it is to suit the signal.
    pub fn radix(self) -> Option<Radix> {
        <&str>::from(self).parse().ok()
    }
}

/// A probe configuration, with the positions of its keys for error messages.
pub struct AnalyserSetup {
    /// Name of the capture and of its files.
    pub name: String,
    /// Values of the file.
    pub file: AnalyserSetupFile,
    checked: Checked,
    overridden: Vec<(&'static str, &'static str)>,
}

impl AnalyserSetup {
    /// Loads a built-in configuration by name, or a file by path.
    ///
    /// # Errors
    /// If there is none, or a key or value is invalid; with the position.
    pub fn load(name: &str) -> Result<Self> {
        if let Some(text) = builtin::set_up(name) {
            return Self::parse(name, &format!("set-up {name}"), text);
        }
        let path = Path::new(name);
        if !path.exists() && !name.contains(['/', '.']) {
            let (hint, names) = hint(name, builtin::SET_UPS.iter().map(|(name, _)| *name));
            let expected = format!(
                "no such file or built-in probe configuration{hint}; expected a path or one of {names}"
            );
            return Err(Input::new("--probes", expected).value(name).into());
        }
        let text = read_text(path)?;
        let stem = path.file_stem().map_or(name.into(), |stem| stem.to_string_lossy());
        Self::parse(&stem, name, &text)
    }

    /// Parses a configuration from the text of `source`; `stem` is the default name.
    ///
    /// # Errors
    /// If a key or value is invalid; with the position.
    pub fn parse(stem: &str, source: &str, text: &str) -> Result<Self> {
        let checked = Checked::parse::<AnalyserSetupFile>(source, text)?;
        let file: AnalyserSetupFile = checked.read()?;
        let name = file.name.clone().unwrap_or_else(|| stem.to_owned());
        let set_up = AnalyserSetup { name, file, checked, overridden: Vec::new() };
        let known = |c: char| c.is_alphanumeric() || "_-.".contains(c);
        if set_up.name.is_empty() || set_up.name.starts_with('.') || !set_up.name.chars().all(known)
        {
            let expected = "expected a name of letters, digits, `_`, `-` and `.`, for its files";
            return Err(set_up.fault("name", &set_up.name, expected));
        }
        Ok(set_up)
    }

    /// Overrides the value of a key, stored in `place`, by the value of `option`.
    pub fn override_with<T: Into<U>, U>(
        &mut self,
        key: &'static str,
        option: &'static str,
        value: Option<T>,
        place: impl FnOnce(&mut AnalyserSetupFile) -> &mut U,
    ) {
        let Some(value) = value else { return };
        *place(&mut self.file) = value.into();
        self.overridden.push((key, option));
    }

    /// Creates an error for a key, at its position in the file or with the option that overrides it.
    pub fn fault(&self, key: &str, value: impl Display, expected: impl Display) -> Error {
        match self.option(key) {
            Some(option) => Input::new(option, expected).value(value).into(),
            None => {
                let fault = self.checked.fault(key, expected);
                let value = fault.value.clone().unwrap_or_else(|| value.to_string());
                fault.value(value).into()
            }
        }
    }

    /// Adds the position of a key to an error within its text.
    pub fn fault_within(&self, key: &str, error: Error) -> Error {
        match (self.option(key), error) {
            (None, Error::Input(inner)) => {
                let mut fault = self.checked.fault(key, &inner.expected);
                // The text begins behind a quote.
                let column = inner.place.map_or(0, |(_, column)| column);
                fault.place = fault.place.map(|(line, begin)| (line, begin + column));
                Input { value: inner.value, ..fault }.into()
            }
            (_, error) => error,
        }
    }

    /// Returns the origin of a key's value: the option, or the key itself.
    pub fn origin<'a>(&self, key: &'a str) -> &'a str
    where
        'static: 'a,
    {
        self.option(key).unwrap_or(key)
    }

    fn option(&self, key: &str) -> Option<&'static str> {
        self.overridden.iter().find(|(known, _)| *known == key).map(|(_, option)| *option)
    }
}
