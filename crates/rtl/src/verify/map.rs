//! Intended differences between a user's design and ours: a TOML file.

use std::collections::BTreeMap;
use std::path::Path;

use schemars::JsonSchema;
use serde::Deserialize;

use tofsim::error::{Input, Result, hint, read_text};
use tofsim::files::toml::Checked;
use tofsim::firmware::forward2::MOST_NEURONS;
use tofsim::kernel::sizes::Sizes;

use crate::golden::blocks::{self, BLOCKS};
use crate::golden::ports::Port;
use crate::golden::setting::{Constants, Setting};
use crate::golden::spec::Spec;

/// A map file.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RtlMap {
    /// Sizes of the design.
    pub design: Design,
    /// Deviations of each block, by the block's name here.
    pub block: BTreeMap<String, BlockMap>,
}

/// Sizes and constants that differ from ours.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Design {
    /// Whether the modules have parameters. Without, all that ours are told by parameters is a
    /// constant inside: what the scenario says, unless it stands here.
    pub parameters: bool,
    /// Shots of a frame, if they are a constant inside.
    #[schemars(range(min = 1, max = 16_777_215), extend("unit" = "shots"))]
    pub shots_per_frame: Option<u32>,
    /// Taps of the delay line, if not ours. With fewer, the stimulus leaves out what they cannot show.
    #[schemars(range(min = 4, max = 4096), extend("unit" = "taps"))]
    pub taps: Option<usize>,
    /// Words of the histogram. With fewer than ours, the stimulus keeps to those.
    #[schemars(range(min = 2, max = 65_536), extend("unit" = "words"))]
    pub bins: Option<usize>,
}

impl Default for Design {
    fn default() -> Self {
        Design { parameters: true, shots_per_frame: None, taps: None, bins: None }
    }
}

/// Deviations of a block.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct BlockMap {
    /// Name of their module, if not ours.
    pub module: Option<String>,
    /// Their name of each of our ports that has another.
    pub ports: BTreeMap<String, String>,
    /// Their name of each of our parameters that has another; an empty one is a constant inside.
    pub parameters: BTreeMap<String, String>,
    /// Our ports whose level is the other way round, as an active-low reset.
    pub invert: Vec<String>,
    /// Our outputs that are not compared; they need not exist.
    pub ignore: Vec<String>,
    /// Clock cycles that our outputs come later there (less than 0: earlier).
    #[schemars(with = "BTreeMap<String, ClockCycles>")]
    pub latency: BTreeMap<String, i64>,
    /// Their inputs that ours lacks, by their names, and the constant that each is tied to.
    pub tie: BTreeMap<String, u64>,
    /// Outputs that are compared only where another port of one bit is high in the reference, by our
    /// names or theirs.
    pub valid: BTreeMap<String, String>,
    /// After each reset so many lines are not compared: what a pipeline without reset takes to empty.
    #[schemars(range(max = 10_000), extend("unit" = "clock cycles"))]
    pub settle: u64,
    /// For histogram_builder: their output with all counts side by side, bin 0 in the low bits
    /// (thesis, Listing 6.1).
    pub counts: Option<String>,
    /// For depth_estimator: their input with the whole histogram, bin 0 in the low bits (thesis,
    /// Fig. 6.18). It is collected word by word, then `algo_start` is passed on.
    pub vector: Option<String>,
    /// Sizes, from the file's `design`.
    #[serde(skip)]
    #[schemars(skip)]
    pub(super) design: Design,
    /// The file, for messages.
    #[serde(skip)]
    #[schemars(skip)]
    pub(super) source: String,
}

/// A latency, as the schema has it.
#[derive(JsonSchema)]
#[schemars(inline)]
#[expect(dead_code, reason = "only its schema is of use")]
struct ClockCycles(
    #[schemars(range(min = -10_000, max = 10_000), extend("unit" = "clock cycles"))] i64,
);

impl RtlMap {
    /// Reads and checks a map file.
    ///
    /// # Errors
    /// When it cannot be read or names what there is not; the error has the place.
    pub fn read(path: &Path) -> Result<Self> {
        Self::parse(&path.display().to_string(), &read_text(path)?)
    }

    fn parse(source: &str, text: &str) -> Result<Self> {
        let checked = Checked::parse::<RtlMap>(source, text)?;
        let mut map: RtlMap = checked.read()?;
        for (name, block) in &mut map.block {
            block.design = map.design.clone();
            block.source = source.to_owned();
            let Some(spec) = blocks::find(name) else {
                let names = BLOCKS.iter().map(|spec| spec.name);
                let fault = unknown("block", name, names);
                return Err(checked.fault(&format!("block.{name}"), fault).into());
            };
            block.check(spec, &|key, expected| {
                checked.fault(&format!("block.{name}.{key}"), expected)
            })?;
        }
        Ok(map)
    }

    /// The setting that the design's module of a block can be held to.
    pub fn fit(&self, spec: &Spec, setting: &Setting) -> Setting {
        let most =
            |latencies: &mut dyn Iterator<Item = i64>| latencies.max().unwrap_or(0).max(0) as u64;
        let all = self.block.values().flat_map(|block| block.latency.values());
        let own = self.block.get(spec.name).into_iter().flat_map(|block| block.latency.values());
        let design = &self.design;
        let empty = |block: &BlockMap| {
            let left_out = block.parameters.iter().filter(|(_, theirs)| theirs.is_empty());
            left_out.map(|(ours, _)| ours.clone()).collect()
        };
        let constants = if design.parameters {
            Constants::These(self.block.get(spec.name).map(empty).unwrap_or_default())
        } else {
            Constants::All
        };
        Setting {
            taps: design.taps.map_or(setting.taps, |taps| setting.taps.min(taps)),
            bins: design.bins.map_or(setting.bins, |bins| setting.bins.min(bins as u64)),
            slack: most(&mut all.copied()),
            lead: most(&mut own.map(|latency| -latency)),
            shots_per_frame: design.shots_per_frame,
            constants,
            reads_apart: self.block.get(spec.name).is_some_and(|block| block.reads_apart()),
            ..setting.clone()
        }
    }

    /// Returns the differences of a block: nothing but the design's sizes if the file does not name it.
    pub fn block(&self, name: &str) -> BlockMap {
        let design = self.design.clone();
        self.block.get(name).cloned().unwrap_or(BlockMap { design, ..BlockMap::default() })
    }
}

fn unknown<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str>) -> String {
    let (hint, known) = hint(name, known);
    format!("unknown {what}{hint}; expected one of {known}")
}

impl BlockMap {
    /// Checks that everything that is named exists in our block; `valid` has our names from then on.
    fn check(&mut self, spec: &Spec, fault: &dyn Fn(&str, String) -> Input) -> Result<()> {
        let ports = spec.ports(&Sizes { neurons: MOST_NEURONS as u32, ..Sizes::default() });
        // Each name of a port of ours: where it stands, and whether it has to be an output.
        let place = |table: &str, name: &str| format!("{table}.{name}");
        let named = (self.ports.keys().map(|name| (place("ports", name), name, false)))
            .chain(self.invert.iter().map(|name| ("invert".to_owned(), name, false)))
            .chain(self.ignore.iter().map(|name| ("ignore".to_owned(), name, true)))
            .chain(self.latency.keys().map(|name| (place("latency", name), name, true)));
        for (key, name, is_output) in named {
            let ports = ports.iter().filter(|port| port.output || !is_output);
            let known = ports.map(|port| port.name.as_str());
            if !known.clone().any(|other| other == name) {
                let what = if is_output { "output" } else { "port" };
                return Err(fault(&key, unknown(what, name, known)).into());
            }
        }
        self.valid = self.valid_by_our_names(spec, &ports, fault)?;
        let adapters = [
            ("counts", "histogram_builder", self.counts.is_some()),
            ("vector", "depth_estimator", self.vector.is_some()),
        ];
        for (key, block, is_set) in adapters {
            if is_set && spec.name != block {
                return Err(fault(key, format!("only {block} has this adapter")).into());
            }
        }
        if self.vector.is_some() && self.design.bins.is_some() {
            let expected =
                "expected no design.bins: the network has as many inputs as tdc.bins says";
            return Err(fault("vector", expected.to_owned()).into());
        }
        Ok(())
    }

    /// Returns, by our names, the port that has to be high where an output is compared.
    fn valid_by_our_names(
        &self,
        spec: &Spec,
        ports: &[Port],
        fault: &dyn Fn(&str, String) -> Input,
    ) -> Result<BTreeMap<String, String>> {
        let ours = |name: &str| {
            let renamed =
                || self.ports.iter().find(|(_, theirs)| *theirs == name).map(|(ours, _)| ours);
            let own = ports.iter().find(|port| port.name == name);
            own.or_else(|| ports.iter().find(|port| Some(&port.name) == renamed()))
        };
        // A level that a line of the vectors has.
        let is_level = |port: &&Port| {
            let is_driven = port.name.starts_with("clk") || port.name == "tdc_stop";
            let is_glued = spec.is_glued(&port.name);
            port.width == 1 && (port.output || !is_driven && !is_glued)
        };
        let mut valid = BTreeMap::new();
        for (key, level) in &self.valid {
            let place = format!("valid.{key}");
            let names = |ports: &mut dyn Iterator<Item = &Port>| {
                ports.map(|port| port.name.clone()).collect::<Vec<_>>()
            };
            let Some(output) = ours(key).filter(|port| port.output) else {
                let known = names(&mut ports.iter().filter(|port| port.output));
                let what = unknown("output", key, known.iter().map(String::as_str));
                return Err(fault(&place, what).into());
            };
            let Some(level) = ours(level).filter(is_level) else {
                let known = names(&mut ports.iter().filter(is_level));
                let what = unknown("port of one bit", level, known.iter().map(String::as_str));
                return Err(fault(&place, what).into());
            };
            valid.insert(output.name.clone(), level.name.clone());
        }
        Ok(valid)
    }

    /// Returns whether nothing is read while something is counted: where `count` is compared only while
    /// something is read, or all counts are there at once.
    fn reads_apart(&self) -> bool {
        self.counts.is_some() || self.valid.get("count").is_some_and(|level| level == "read_en")
    }

    /// Their module.
    pub fn module<'a>(&'a self, ours: &'a str) -> &'a str {
        self.module.as_deref().unwrap_or(ours)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(text: &str) -> String {
        RtlMap::parse("map.toml", text).unwrap_err().to_string()
    }

    #[test]
    fn a_map_names_what_there_is() {
        let text = "[design]\ntaps = 700\n[block.forward1]\nmodule = \"hidden\"\n\
            invert = [\"rst\"]\nports = { clk_sys = \"clk\" }\nlatency = { l1_in_0 = 2 }\n";
        let map = RtlMap::parse("map.toml", text).unwrap();
        assert_eq!(map.block["forward1"].module("forward1"), "hidden");
        assert_eq!(map.block["forward1"].design.taps, Some(700));
    }

    #[test]
    fn what_there_is_not_is_refused_with_its_place() {
        let error = fault("[block.forward1.ports]\nclk_124 = \"clk\"\n");
        assert!(error.starts_with("map.toml:2:"), "{error}");
        assert!(error.contains("unknown port (`clk_sys`?)"), "{error}");
        let error = fault("[block.forwrd1]\nmodule = \"a\"\n");
        assert!(error.contains("unknown block (`forward1`?)"), "{error}");
        let error = fault("[block.forward1]\nmodul = \"a\"\n");
        assert!(error.contains("did you mean `module`?"), "{error}");
        let error = fault("[block.forward1]\nignore = [\"count\"]\n");
        assert!(error.contains("unknown output"), "{error}");
        let error = fault("[block.forward1]\ncounts = \"H\"\n");
        assert!(error.contains("only histogram_builder has this adapter"), "{error}");
        let error = fault("[design]\nbins = 128\n[block.depth_estimator]\nvector = \"H\"\n");
        assert!(error.contains("expected no design.bins"), "{error}");
    }
}
