//! The clocks of a design, as tables and as JSON.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::{Value, json};

use tofsim_rtl::timing::block::required_mhz;
use tofsim_rtl::timing::nextpnr::ClockSpeed;
use tofsim_rtl::timing::record::{BlockTiming, Record};
use tofsim_rtl::timing::{Estimate, Measurement, TimedPath};

use crate::text::table::table;

use super::writer::Findings;

/// Columns of primitives of an ECP5.
const ECP5: [&str; 5] = ["TRELLIS_COMB", "TRELLIS_FF", "DP16KD", "MULT18X18D", "CCU2C"];
/// Columns of primitives of a Kintex-7, by the begin of the type's name.
const KINTEX7: [(&str, &[&str]); 7] = [
    ("RAMB36", &["RAMB36E1"]),
    ("RAMB18", &["RAMB18E1"]),
    ("RAM256", &["RAM256X1S"]),
    ("RAM128", &["RAM128X1"]),
    ("CARRY4", &["CARRY4"]),
    ("LUT", &["LUT", "INV"]),
    ("FF", &["FD"]),
];

/// The clocks of a design.
pub struct DesignTiming<'a> {
    /// Source of the design.
    pub rtl: &'a str,
    /// Measurements and estimates of each block.
    pub record: &'a Record,
}

impl Findings for DesignTiming<'_> {
    const SCHEMA: &'static str = "tofsim.timing/1";

    fn json(&self) -> Value {
        let Record { tools, blocks } = self.record;
        let closes = |block: &BlockTiming| block.ecp5.as_ref().map(Measurement::closes);
        let closes: BTreeMap<_, _> =
            blocks.iter().map(|(name, block)| (name, closes(block))).collect();
        json!({ "rtl": self.rtl, "tools": tools, "closes": closes, "blocks": blocks })
    }

    fn text(&self) -> String {
        text(self.record)
    }
}

/// Returns two tables, and the critical path of each block.
fn text(record: &Record) -> String {
    let mut text = String::new();
    let measured: Vec<_> = measured(record).collect();
    if !measured.is_empty() {
        let head = [
            "block", "clock", "worst", "best", "needed", "COMB", "FF", "DP16KD", "MULT18", "CCU2C",
        ];
        let rows =
            measured.iter().map(|(name, block, clock, speed)| ecp5_row(name, block, clock, speed));
        text += "ECP5, speed grade 8, placed and routed [MHz]\n";
        text += &format!("{}\n", table(head, rows, 2..));
    }
    let estimated: Vec<_> = estimated(record).collect();
    if !estimated.is_empty() {
        let mut head = vec!["block", "levels", "ns", "DSP48E1", "piped"];
        head.extend(KINTEX7.map(|(name, _)| name));
        let rows = estimated.iter().map(|(name, estimate)| kintex7_row(name, estimate));
        let gap = if text.is_empty() { "" } else { "\n" };
        text += &format!(
            "{gap}Kintex-7, an estimate: ns with 0.3, 0.6 and 0.9 ns for each routed net\n"
        );
        text += &format!("{}\n", table(head, rows, 1..));
    }
    for (name, _, clock, speed) in measured {
        path(&mut text, &format!("{name}, {clock}, ECP5"), &speed.path);
    }
    for (name, estimate) in estimated {
        path(&mut text, &format!("{name}, Kintex-7, estimate"), &estimate.path);
        if !estimate.unknown.is_empty() {
            let unknown: Vec<_> = estimate.unknown.iter().map(String::as_str).collect();
            let _ = writeln!(text, "  without: {}, whose delays are not known", unknown.join(", "));
        }
    }
    text
}

fn measured(record: &Record) -> impl Iterator<Item = (&str, &Measurement, &str, &ClockSpeed)> {
    let blocks =
        record.blocks.iter().filter_map(|(name, block)| Some((name, block.ecp5.as_ref()?)));
    blocks.flat_map(|(name, block)| {
        let clocks = block.clocks.iter();
        clocks.map(move |(clock, speed)| (name.as_str(), block, clock.as_str(), speed))
    })
}

fn estimated(record: &Record) -> impl Iterator<Item = (&str, &Estimate)> {
    record.blocks.iter().filter_map(|(name, block)| Some((name.as_str(), block.kintex7.as_ref()?)))
}

fn ecp5_row(name: &str, block: &Measurement, clock: &str, speed: &ClockSpeed) -> Vec<String> {
    let mhz = |mhz: f64| format!("{mhz:.1}");
    let mut row = vec![name.to_owned(), clock.to_owned(), mhz(speed.worst()), mhz(speed.best())];
    row.push(format!("{:.0}", required_mhz(clock)));
    row.extend(ECP5.map(|kind| block.cells.get(kind).copied().unwrap_or(0).to_string()));
    row
}

fn kintex7_row(name: &str, estimate: &Estimate) -> Vec<String> {
    let ns = estimate.ns.map(|ns| format!("{ns:.1}")).join(" / ");
    let mut row = vec![name.to_owned(), estimate.levels.to_string(), ns];
    row.extend([estimate.count("DSP48E1"), estimate.pipelined_dsps].map(|count| count.to_string()));
    let count = |begins: &[&str]| begins.iter().map(|begin| estimate.count(begin)).sum::<u64>();
    row.extend(KINTEX7.map(|(_, begins)| count(begins).to_string()));
    row
}

fn path(text: &mut String, what: &str, path: &TimedPath) {
    let TimedPath { from, to, ns, routing_ns, hops } = path;
    let _ = writeln!(text, "\n{what}: {ns:.2} ns, {routing_ns:.2} of it routing\n  {from} .. {to}");
    let rows = hops.iter().map(|hop| {
        let ns = |ns: f64| format!("{ns:.2}");
        [format!("  {}", hop.cell), ns(hop.cell_ns), hop.net.clone(), ns(hop.net_ns)]
    });
    let _ = writeln!(text, "{}", table(["  cell", "ns", "net", "ns"], rows, ..0));
}
