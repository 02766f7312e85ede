//! Maps between the names and values of two sides: a TOML file, or the setup of a logic analyser.

use std::collections::BTreeMap;
use std::path::Path;

use regex::Regex;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use tofsim::error::{Result, read_text};
use tofsim::files::toml::Checked;
use tofsim::hierarchy::TOP;

use crate::ila::probes::below;
use crate::ila::read::digits;
use crate::ila::setup::ProbeEntry;
use crate::ila::{AnalyserSetup, Radix};

/// A map file. Its sides `a` and `b` are those of `tofsim compare A B`, or swapped if more names match that way.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(rename = "Map")]
pub struct SignalMap {
    /// Sampling clock of a waveform: a signal, sampled just before its rising edges, or a frequency and the time of
    /// the first edge such as `125MHz` or `125MHz + 2ns`.
    pub clock: Option<String>,
    /// Alignment of the sides: `start`, `trigger`, `edge SIGNAL`, `correlation`, `windows`, `offset N` in samples, or
    /// a time such as `offset 8ns`.
    pub align: Option<String>,
    /// Trigger condition for a waveform.
    pub trigger: Option<String>,
    /// Time before which a waveform is ignored.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0.0, max = 1e9), extend("unit" = "us"))]
    pub after_us: f64,
    /// Number of registers between the signals and the logic analyser.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0, max = 6), extend("unit" = "edges"))]
    pub input_stages: u64,
    /// Condition under which a bus accepts a word: the accepted words are compared, regardless of their times.
    pub beats: Option<String>,
    /// Condition under which a logic analyser stored a sample.
    pub qualified_by: Option<String>,
    /// Signal of a capture that counts clock cycles.
    pub time_from: Option<String>,
    /// Signals to exclude from the comparison, with wildcards * and ?.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ignore: Vec<String>,
    /// Changes of names, applied in this order before names are compared.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rename: Vec<Rename>,
    /// Explicit pairs of signals.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub signal: Vec<Rule>,
}

/// A change of names.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Rename {
    /// Regular expression to search for in names.
    pub pattern: String,
    /// Replacement of the match; `$1` is the first group.
    pub by: String,
    /// Side whose names are changed.
    pub side: Side,
}

/// Side whose names a rename changes.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// Both sides.
    #[default]
    Both,
    /// The first side, which is the reference.
    A,
    /// The second side, which is under test.
    B,
}

/// A pair of signals, or how to compare a signal.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Rule {
    /// Name on the first side, or several slices such as `x[7:4]` to concatenate, highest first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub a: Vec<String>,
    /// Name on the second side. Without it, the rule applies to a signal that is matched by name.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub b: Vec<String>,
    /// Whether the value is in two's complement.
    pub signed: Option<bool>,
    /// Number of fraction bits.
    #[schemars(range(min = 0, max = 1024), extend("unit" = "bits"))]
    pub fraction: Option<u32>,
    /// Bits to exclude from the comparison, such as `0xf0`.
    pub dont_care: Option<String>,
    /// Whether the second side is inverted.
    #[serde(skip_serializing_if = "is_default")]
    pub invert: bool,
    /// Latency of the second side [samples]; negative if it is earlier.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = -65_536, max = 65_536), extend("unit" = "samples"))]
    pub latency: i64,
    /// Largest deviation of a number that is not a difference.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(range(min = 0), extend("unit" = "LSB"))]
    pub tolerance: u64,
    /// One-bit signal of the first side; the pair is compared only where it is 1.
    pub valid: Option<String>,
    /// Values of words, such as `{ idle = 0, run = 1 }`, if one side has words and the other bits.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub states: BTreeMap<String, u64>,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl SignalMap {
    /// Reads and checks a map file.
    ///
    /// # Errors
    /// If it cannot be read or is invalid; with the position.
    pub fn read(path: &Path) -> Result<SignalMap> {
        SignalMap::parse(&path.display().to_string(), &read_text(path)?)
    }

    /// Parses a map from the text of `source`.
    ///
    /// # Errors
    /// If it is invalid; with the position.
    pub fn parse(source: &str, text: &str) -> Result<SignalMap> {
        let checked = Checked::parse::<SignalMap>(source, text)?;
        let map: SignalMap = checked.read()?;
        for (k, rename) in map.rename.iter().enumerate() {
            if let Err(error) = Regex::new(&rename.pattern) {
                let reason = error.to_string();
                let reason = reason.lines().last().unwrap_or_default().trim().to_owned();
                return Err(checked.fault(&format!("rename.{k}.pattern"), reason).into());
            }
        }
        for (k, rule) in map.signal.iter().enumerate() {
            if rule.a.is_empty() || (rule.b.is_empty() && rule.a.len() > 1) {
                let fault = checked.fault(
                    &format!("signal.{k}"),
                    "expected `a`, a signal's name, and `b` if it is joined",
                );
                return Err(fault.into());
            }
            if let Some(mask) = &rule.dont_care
                && parse_mask(mask).is_none()
            {
                let expected = "expected bits as `0xf0`";
                return Err(checked.fault(&format!("signal.{k}.dont_care"), expected).into());
            }
        }
        Ok(map)
    }

    /// Creates the map for a logic analyser's setup: signals of the simulation on the first side, probes on the
    /// second.
    pub fn of(set_up: &AnalyserSetup) -> SignalMap {
        let file = &set_up.file;
        let clock = if file.clock.starts_with("clk_") {
            format!("{TOP}.{}", file.clock)
        } else {
            file.clock.clone()
        };
        let probes = file.probe.iter().map(|probe| Rule {
            a: vec![format!("{TOP}.{}", below(&probe.signal.replace('/', ".")))],
            b: vec![shown(probe)],
            ..Rule::default()
        });
        SignalMap {
            clock: Some(clock),
            align: Some("trigger".to_owned()),
            trigger: Some(file.trigger.clone().unwrap_or_else(|| "always".to_owned())),
            after_us: file.arm_at_us,
            input_stages: file.input_stages,
            qualified_by: file.capture.clone(),
            signal: probes.collect(),
            ..SignalMap::default()
        }
    }

    /// Formats the map as a file.
    pub fn to_toml(&self) -> String {
        // Every value here has a form in TOML.
        toml::to_string(self).unwrap_or_default()
    }
}

/// Returns the name of a probe in a capture.
fn shown(probe: &ProbeEntry) -> String {
    let below = below(&probe.signal).replace('.', "/");
    let single = below.strip_suffix(']').and_then(|text| {
        let (high, low) = text.rsplit_once('[')?.1.split_once(':')?;
        (high == low).then(|| text.replace(&format!("[{high}:{low}"), &format!("[{low}]")))
    });
    probe.name.clone().unwrap_or(single.unwrap_or(below))
}

/// Parses the bits of a mask, least significant word first.
pub(super) fn parse_mask(text: &str) -> Option<Vec<u64>> {
    let text = text.strip_prefix("0x")?.replace('_', "");
    let bits = digits::read(text.as_bytes(), Radix::Hex, 4 * text.len() as u32).ok()?;
    bits.is_known().then_some(bits.value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_is_read_as_it_is_written() {
        let text = "clock = \"clk_laser\"\nalign = \"trigger\"\n\n[[signal]]\n\
            a = [\"vcsel_driver.laser_pulse\"]\nb = [\"VCSEL_ON\"]\n";
        let map = SignalMap::parse("map.toml", text).unwrap();
        assert_eq!(map.to_toml(), text);
    }

    #[test]
    fn a_fault_has_its_place() {
        let fault = |text: &str| SignalMap::parse("map.toml", text).unwrap_err().to_string();
        let error = fault("[[rename]]\npattern = \"(\"\nby = \"\"\n");
        assert!(error.starts_with("map.toml:2:11: rename.0.pattern"), "{error}");
        let error = fault("[[signal]]\na = [\"x\"]\ndont_care = \"f0\"\n");
        assert!(error.contains("map.toml:3:"), "{error}");
        assert!(error.contains("expected bits as `0xf0`"), "{error}");
        let error = fault("[[signal]]\nb = [\"x\"]\n");
        assert!(error.contains("expected `a`"), "{error}");
        let error = fault("[[signal]]\na = [\"x\"]\nlatancy = 2\n");
        assert!(error.contains("did you mean `latency`?"), "{error}");
    }

    #[test]
    fn masks_may_be_of_any_width() {
        assert_eq!(parse_mask("0x1_00000000_0000000f"), Some(vec![0xf, 1]));
        assert_eq!(parse_mask("0x"), None);
        assert_eq!(parse_mask("f0"), None);
    }
}
