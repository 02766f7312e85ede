//! Medians, spreads and ratios, as tables or JSON.

use std::env;

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, Table};
use serde::Serialize;
use serde_json::{Value, json};

use crate::contender::{Contender, Work};
use crate::rounds::Measured;
use crate::{Result, icarus, verilator, versions};

const PHOTONS_OF_PEERS: &str = "in memory";
const PHOTONS_OF_TOFSIM: &str = "drawn on the fly";

/// Results to print.
pub struct Report {
    notes: Vec<String>,
    pinned: String,
    measured: Vec<(u8, Vec<Measured>)>,
}

/// tofsim and the fastest model of Verilator at the same kind of work.
#[derive(Serialize)]
struct Row {
    work: Work,
    laser_freq: u8,
    /// Median [ms a frame].
    tofsim_ms: f64,
    /// Median [ms a frame].
    verilator_ms: f64,
    ratio: f64,
}

/// A peer's timings.
#[derive(Serialize)]
struct Peer<'a> {
    simulator: &'a str,
    variant: &'a str,
    work: Work,
    laser_freq: u8,
    /// Median [ms a frame].
    ms: f64,
    min_ms: f64,
    max_ms: f64,
    timings: usize,
    shots: u64,
}

impl Report {
    /// Creates a report without timings.
    pub fn new(notes: Vec<String>, pinned: String) -> Self {
        Report { notes, pinned, measured: Vec::new() }
    }

    /// Adds the timings at a laser rate.
    pub fn add(&mut self, laser_freq: u8, measured: &[Measured]) {
        self.measured.push((laser_freq, measured.to_vec()));
    }

    /// Prints the report to stdout; beside JSON, notes go to stderr.
    pub fn print(&self, json: bool) -> Result<()> {
        let notes = self.notes.iter().chain([&self.pinned]);
        if json {
            notes.for_each(|note| eprintln!("peers: {note}"));
            println!("{}", serde_json::to_string_pretty(&self.json())?);
            return Ok(());
        }
        for (laser_freq, measured) in &self.measured {
            println!("\nlaser_freq {laser_freq}, ms a frame of 30,000 shots");
            println!("{}", table(measured));
        }
        println!("\nVerilator's fastest model over tofsim");
        println!("{}", self.ratios());
        println!(
            "photons: peers {PHOTONS_OF_PEERS}, tofsim {PHOTONS_OF_TOFSIM}; {}",
            versions::cpu()
        );
        notes.for_each(|note| println!("{note}"));
        Ok(())
    }

    fn rows(&self) -> Vec<Row> {
        let rows = self.measured.iter().flat_map(|(laser_freq, measured)| {
            Work::ALL.into_iter().map(|work| {
                let tofsim_ms = best(measured, work, |peer| peer.is_none());
                let verilator_ms = best(measured, work.of_peer(), is_verilator);
                let ratio = verilator_ms / tofsim_ms;
                Row { work, laser_freq: *laser_freq, tofsim_ms, verilator_ms, ratio }
            })
        });
        rows.collect()
    }

    fn peers(&self) -> Vec<Peer<'_>> {
        let all = self.measured.iter().flat_map(|(laser_freq, measured)| {
            measured.iter().filter_map(|measured| Peer::new(*laser_freq, measured))
        });
        all.collect()
    }

    fn ratios(&self) -> Table {
        let mut table = plain(&["laser_freq", "work", "tofsim", "verilator", "ratio"]);
        for row in self.rows() {
            table.add_row([
                row.laser_freq.to_string(),
                row.work.name().to_string(),
                digits(row.tofsim_ms),
                digits(row.verilator_ms),
                digits(row.ratio),
            ]);
        }
        right(table, 2)
    }

    fn json(&self) -> Value {
        json!({
            "versions": versions::json(),
            "flags": flags(),
            "cpu": versions::cpu(),
            "pinned": self.pinned,
            "photons": { "peers": PHOTONS_OF_PEERS, "tofsim": PHOTONS_OF_TOFSIM },
            "notes": self.notes,
            "rows": self.rows(),
            "peers": self.peers(),
        })
    }
}

impl<'a> Peer<'a> {
    fn new(laser_freq: u8, measured: &'a Measured) -> Option<Self> {
        let &Contender { simulator, variant, work, shots, .. } = measured.peer.as_ref()?;
        let (ms, min_ms, max_ms) = (measured.median(), measured.min(), measured.max());
        let timings = measured.count();
        Some(Peer { simulator, variant, work, laser_freq, ms, min_ms, max_ms, timings, shots })
    }
}

fn flags() -> Value {
    json!({
        "verilator": verilator::COMMON,
        "verilator OPT_FAST": verilator::OPT_FAST,
        "profile-guided": verilator::PROFILE_GUIDED,
        "iverilog": icarus::OPTIONS,
        "RUSTFLAGS": env::var("RUSTFLAGS").unwrap_or_default(),
    })
}

fn is_verilator(peer: Option<&Contender>) -> bool {
    peer.is_some_and(|peer| peer.simulator == "verilator")
}

/// Returns the shortest median among the selected contenders at a kind of work [ms].
fn best(measured: &[Measured], work: Work, of: impl Fn(Option<&Contender>) -> bool) -> f64 {
    let same = |one: &&Measured| one.work == work && of(one.peer.as_ref());
    measured.iter().filter(same).map(Measured::median).fold(f64::NAN, f64::min)
}

fn table(measured: &[Measured]) -> Table {
    let mut table = plain(&["work", "simulator", "median", "min", "max", "times tofsim"]);
    let mut measured: Vec<_> = measured.iter().collect();
    measured.sort_by_key(|measured| measured.work);
    for one in &measured {
        let ours = measured.iter().find(|other| other.peer.is_none() && other.work == one.work);
        let ours = ours.map_or(f64::NAN, |ours| ours.median());
        table.add_row([
            one.work.name().to_string(),
            one.name(),
            digits(one.median()),
            digits(one.min()),
            digits(one.max()),
            digits(one.median() / ours),
        ]);
    }
    right(table, 2)
}

fn plain(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING).set_header(header);
    table
}

/// Right-aligns the columns from `from` on.
fn right(mut table: Table, from: usize) -> Table {
    for column in table.column_iter_mut().skip(from) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// Formats a number with three significant digits.
fn digits(value: f64) -> String {
    let decimals =
        if value >= 100.0 { 0 } else { (2.0 - value.log10().floor()).clamp(0.0, 6.0) as usize };
    format!("{value:.decimals$}")
}
