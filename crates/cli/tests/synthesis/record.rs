//! Tests of the recorded place and route in `docs/timing.json`, which `./check --timing` writes, against the Verilog,
//! the document about it, and the required contents.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::Duration;

use tofsim_rtl::timing::record::Record;
use tofsim_rtl::timing::versions::version;
use tofsim_rtl::timing::{self, BLOCKS, Measurement, TimedDesign, nextpnr};
use tofsim_rtl::verify::process::{Limits, YOSYS};

use crate::common;

use super::recorded::recorded;
use super::yosys;

/// What gives Yosys its scripts and the modules around blocks.
const SCRIPTS: &str = concat!(
    include_str!("../../../rtl/src/timing/block.rs"),
    include_str!("../../../rtl/src/timing/synthesis.rs"),
    include_str!("../../../rtl/src/timing/wrapper.rs"),
);

const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");

/// Hard blocks: block, type of the primitive, how many.
const EXPECTED: &[(&str, &str, u64)] = &[
    ("depth_estimator", "MULT18X18D", 10),
    ("depth_estimator", "DP16KD", 20),
    ("estimator_histogram", "MULT18X18D", 10),
    ("estimator_histogram", "DP16KD", 20),
    ("estimator_histogram", "TRELLIS_RAMW", 64),
    ("histogram_builder", "TRELLIS_RAMW", 64),
    ("tdc", "DP16KD", 1),
    ("centroid_estimator", "MULT18X18D", 3),
    ("centroid_estimator", "TRELLIS_RAMW", 32),
    ("vcsel_driver", "IOLOGIC", 1),
];

fn record() -> Record {
    Record::read(&Path::new(DOCS).join("timing.json")).unwrap().unwrap()
}

fn measurement<'a>(record: &'a Record, block: &str) -> &'a Measurement {
    record.blocks[block].ecp5.as_ref().unwrap()
}

#[test]
fn every_block_closes_its_clocks_on_an_ecp5_with_the_hard_blocks_it_should_have() {
    let record = record();
    for block in BLOCKS.iter().filter(|block| block.usual) {
        let measured = measurement(&record, block.name);
        assert!(measured.closes(), "{}: {:?}", block.name, measured.clocks);
        assert!(measured.clocks.values().all(|clock| clock.mhz.len() >= 3), "{}", block.name);
        for kind in ["MULT18X18D", "DP16KD", "TRELLIS_RAMW", "IOLOGIC"] {
            let expected = EXPECTED.iter().find(|it| (it.0, it.1) == (block.name, kind));
            let found = measured.cells.get(kind).copied();
            assert_eq!(found, expected.map(|it| it.2), "{kind} in {}", block.name);
        }
    }
}

#[test]
fn the_page_has_what_is_recorded() {
    let (path, record) = (Path::new(DOCS).join("timing.md"), record());
    let page = fs::read_to_string(&path).unwrap();
    let rows: Vec<_> = page.lines().map(|line| row(line, &record)).collect();
    let new = rows.join("\n") + "\n";
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(&path, &new).unwrap();
    }
    let how = "UPDATE_DOCS=1 cargo test -p tofsim-cli --test cli synthesis::record";
    assert!(page == new, "docs/timing.md is out of date: {how}");
    let measured = record.blocks.values().filter_map(|block| block.ecp5.as_ref());
    let clocks: usize = measured.map(|it| it.clocks.len()).sum();
    let shown = page.lines().filter(|line| cells(line).is_some());
    assert_eq!(shown.count(), clocks, "rows of the table");
}

/// Block, clock and what was before, of a row of the table.
fn cells(line: &str) -> Option<(&str, &str, &str)> {
    let cells: Vec<_> = line.split('|').map(str::trim).collect();
    let [_, block, clock, before, _, _, _, _, _] = cells[..] else { return None };
    Some((block.strip_prefix('`')?.strip_suffix('`')?, clock.trim_matches('`'), before))
}

/// A line of the page, with today's figures if it is a row of the table.
fn row(line: &str, record: &Record) -> String {
    let Some((block, clock, before)) = cells(line) else { return line.to_owned() };
    let measured = measurement(record, block);
    let speed = &measured.clocks[clock];
    let count = |kind: &str| measured.cells.get(kind).map_or(String::new(), |it| format!("{it} "));
    let [carries, memories, multipliers] = ["CCU2C", "DP16KD", "MULT18X18D"].map(count);
    format!(
        "| `{block}` | `{clock}` | {before} | {:.1} .. {:.1} | {carries}| {memories}| {multipliers}|",
        speed.worst(),
        speed.best()
    )
}

#[test]
#[ignore = "long: ./check --full"]
fn the_record_is_of_this_verilog() {
    let folder = common::empty();
    let maker = version(YOSYS, "-V", folder.path()).unwrap();
    let record = record();
    if record.tools["yosys"] != maker {
        // Another version makes other netlists; the record says which it was.
        return eprintln!("docs/timing.json is of {}, this is {maker}", record.tools["yosys"]);
    }
    let netlists = recorded("ecp5", SCRIPTS, &yosys::rtl_ref(), || netlists(folder.path()));
    for block in BLOCKS {
        let recorded = &measurement(&record, block.name).netlist;
        let netlist = &netlists[block.name];
        assert_eq!(netlist, recorded, "{}: docs/timing.md says how to place it", block.name);
    }
}

/// The digest of each block's netlist.
fn netlists(folder: &Path) -> BTreeMap<String, String> {
    let limits = Limits::new(Duration::from_secs(600));
    let rtl = timing::own(folder, &common::setup("kc705", &[])).unwrap();
    let design = TimedDesign { rtl: &rtl, folder, work: folder, limits };
    let digest = |block| nextpnr::digest(&design, block).unwrap();
    BLOCKS.iter().map(|block| (block.name.to_owned(), digest(block))).collect()
}
