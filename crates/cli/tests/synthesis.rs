//! The reference RTL as 7-series primitives: which, how many, and that they still do the same.
//!
//! `UPDATE_DOCS=1 cargo test -p tofsim-cli --test cli synthesis -- --include-ignored` writes the record of Yosys's
//! results and the table in `docs/resources.md` anew.

mod arrays;
mod cells;
mod clocks;
mod decoders;
mod gates;
mod glass;
mod record;
mod recorded;
mod rounding;
mod spacing;
mod yosys;

use std::collections::BTreeMap;
use std::fs;

use cells::{Cells, table};

use tofsim::firmware::depth_estimator::datapath::Datapath;
use tofsim::network::{Network, mem};
use tofsim_learn::quantize::Cost;

const RESOURCES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/resources.md");
const BEGIN: &str = "<!-- resources -->";
const END: &str = "<!-- end -->";

/// Module, begin of the primitive's name, how many.
const EXPECTED: &[(&str, &str, u64)] = &[
    ("carry_chain", "CARRY4", 200),
    ("carry_chain", "FD", 800),
    ("centroid_estimator", "DSP48E1", 3),
    ("ddr_output", "ODDR", 1),
    ("depth_estimator", "DSP48E1", 10),
    ("forward1", "DSP48E1", 8),
    ("forward2", "DSP48E1", 2),
    ("histogram_builder", "RAM256X1S", 16),
    ("likelihood_estimator", "DSP48E1", 8),
    ("lvds_output", "OBUFDS", 1),
    ("pll", "PLLE2_BASE", 1),
    ("tof_top", "DSP48E1", 10),
    ("tof_top", "RAM256X1S", 16),
    ("kc705_top", "DSP48E1", 11),
    ("kc705_top", "IBUFDS", 1),
    ("kc705_top", "OBUFDS", 1),
    ("kc705_top", "ODDR", 1),
    ("kc705_top", "PLLE2_BASE", 1),
    ("kc705_top", "RAM256X1S", 16),
];

/// The top of another part's board.
const ECP5_TOP: &str = "ecp5_top";

/// Modules around the whole carry chain.
const WITH_CHAIN: [&str; 3] = ["tdc", "tof_top", "kc705_top"];

#[test]
#[ignore = "long: ./check --full"]
fn every_block_synthesises_to_the_primitives_it_should() {
    let sources = yosys::rtl_ref();
    let modules: BTreeMap<_, _> = yosys::modules(&sources)
        .filter(|module| *module != ECP5_TOP)
        .map(|module| (module.to_owned(), Cells::of(&sources, module)))
        .collect();
    for (module, cells) in &modules {
        assert!(cells.odd().is_empty(), "{module} has {:?}", cells.odd());
    }
    for (module, primitive, count) in EXPECTED {
        assert_eq!(modules[*module].count(primitive), *count, "{primitive} in {module}");
    }
    for module in WITH_CHAIN {
        assert_eq!(modules[module].chain, 200, "CARRY4 of the chain in {module}");
    }

    let old = fs::read_to_string(RESOURCES).unwrap();
    let (before, rest) = old.split_once(BEGIN).unwrap();
    let (_, after) = rest.split_once(END).unwrap();
    let new = format!("{before}{BEGIN}\n\n{}\n{END}{after}", table(&modules));
    let maker = &modules["kc705_top"].maker;
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(RESOURCES, &new).unwrap();
    } else if old.contains(&format!("| {maker} |")) {
        let how =
            "UPDATE_DOCS=1 cargo test -p tofsim-cli --test cli synthesis -- --include-ignored";
        assert!(old == new, "docs/resources.md is out of date: {how}");
    } else {
        // Each version of Yosys comes to other numbers of LUTs; the primitives above hold for all.
        eprintln!("the table in docs/resources.md is another version's than {maker}'s");
    }
}

#[test]
fn sixteen_neurons_take_eighteen_multipliers() {
    let mut sources = yosys::rtl_ref();
    let network = Network::builtin("uniform-16").unwrap().unwrap();
    for rom in mem::depth_estimator(&network.params(&Default::default())) {
        sources.insert(rom.name.into_owned(), rom.text);
    }
    let command = "chparam -set Neurons 16 depth_estimator";
    let cells = Cells::with(&sources, "depth_estimator", "depth_estimator.16", command);
    assert!(cells.odd().is_empty(), "{:?}", cells.odd());
    assert_eq!(cells.count("DSP48E1"), 16 + 2);
    assert_eq!(cells.count("RAMB36E1"), u64::from(Cost::of(&Datapath::THESIS, 16).ramb36));
}

#[test]
fn no_hit_comes_in_the_two_cycles_that_the_histogram_takes_for_another() {
    for source in ["code_preload", "tdc"] {
        assert!(spacing::is_proven(source, 2), "{source}");
        assert!(!spacing::is_proven(source, 5), "{source}: the proof says too much");
    }
}

#[test]
#[ignore = "long: ./check --full"]
fn the_synthesised_core_does_what_the_rust_model_does() {
    assert_eq!(gates::compare(&yosys::rtl_ref()), "Pass");
}
