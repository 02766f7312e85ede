//! The Verilog in `rtl_ref/` mirrors the Rust in `src/firmware/`: files, ports and house rules.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use tofsim::firmware::forward2::MOST_NEURONS;
use tofsim::firmware::registers::map;
use tofsim::hierarchy::{Kind, every_entry_of};
use tofsim::kernel::sizes::{Size, Sizes};
use tofsim_rtl::golden::BLOCKS;
use tofsim_rtl::golden::ports::Port;
use tofsim_rtl::verify::interface::PortShape;
use tofsim_rtl::verify::process::Limits;
use tofsim_rtl::verify::{Rtl, Simulator};

use crate::common;

/// Vendor primitives, and the only file that may instantiate each.
const PRIMITIVES: &[(&str, &[&str])] = &[
    ("CARRY4", &["carry_chain"]),
    ("PLLE2", &["pll"]),
    ("BUFG", &["pll"]),
    ("ODDR", &["ddr_output"]),
    ("OBUFDS", &["lvds_output"]),
    ("IBUFDS", &["kc705_top"]),
    ("CCU2C", &["carry_chain"]),
    ("EHXPLLL", &["pll"]),
    ("ODDRX1F", &["ddr_output"]),
    ("LUT2", &["ring_oscillator"]),
    ("LUT4", &["ring_oscillator"]),
];

fn root() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// Stems of the files in a folder of the repository, without those that have no twin by design.
fn stems(folder: &str, end: &str, alone: &str) -> Vec<String> {
    let files = common::files(&root().join(folder));
    let stems = files.iter().filter_map(|name| name.strip_suffix(end));
    stems.filter(|stem| *stem != alone).map(str::to_owned).collect()
}

/// The modules that are no tops of a board, and none that only boards have: the ring oscillator's twin belongs to the
/// photons' source.
fn modules() -> Vec<String> {
    let mut modules = stems("rtl_ref", ".v", "kc705_top");
    modules.retain(|name| name != "ecp5_top" && name != "ring_oscillator");
    modules
}

/// Name and text of every Verilog file.
fn sources() -> Vec<(String, String)> {
    let text = |stem: &str| fs::read_to_string(root().join(format!("rtl_ref/{stem}.v"))).unwrap();
    stems("rtl_ref", ".v", "").into_iter().map(|stem| (stem.clone(), text(&stem))).collect()
}

type Ports = BTreeMap<String, PortShape>;

fn vector(output: bool, width: u32) -> PortShape {
    PortShape { output, width, words: None }
}

/// Ports for the most neurons, with a calibration, a host, a cover glass, a second target, a second column and a second bank; all else is as large as by default.
fn sizes() -> Sizes {
    let (columns, banks) = (2, 2);
    let with_all = Sizes {
        calibrates: true,
        hosted: true,
        has_glass: true,
        has_second: true,
        columns,
        banks,
        ..Sizes::default()
    };
    Sizes { neurons: MOST_NEURONS as u32, ..with_all }
}

/// Ports of each module as Rust has them; a module with several instances has one name for all.
fn rust_ports() -> BTreeMap<String, Ports> {
    let mut modules = BTreeMap::<String, Ports>::new();
    let entries = every_entry_of(&sizes()).into_iter();
    for entry in entries.filter(|entry| entry.kind != Kind::Internal) {
        let instance = entry.scope.rsplit('.').next().unwrap();
        let module = match instance {
            _ if instance.starts_with("reset_sync_") => "reset_sync",
            "second_bank" => "histogram_builder",
            _ => instance,
        };
        let port = vector(entry.kind == Kind::Output, entry.signal.width);
        let known = modules.entry(module.to_owned()).or_default();
        let before = known.insert(entry.signal.name.clone(), port);
        assert!(before.is_none_or(|before| before == port), "{}", entry.path());
    }
    modules
}

#[test]
fn every_rust_module_has_a_verilog_twin_and_the_other_way_round() {
    let rust = stems("src/firmware", ".rs", "mod");
    assert_eq!(modules(), rust, "rtl_ref/*.v on the left, src/firmware/*.rs on the right");
}

#[test]
fn every_module_has_golden_vectors() {
    let mut blocks: Vec<_> = BLOCKS.iter().map(|spec| spec.name).collect();
    blocks.sort_unstable();
    assert_eq!(modules(), blocks, "rtl_ref/*.v on the left, golden::BLOCKS on the right");
}

#[test]
fn ports_widths_and_directions_are_the_same() {
    let folder = common::empty();
    let rtl = Rtl::folder(&root().join("rtl_ref")).unwrap();
    let limits = Limits::new(Duration::from_secs(60));
    let rust = rust_ports();
    assert!(rust.keys().eq(&modules()), "{:?}", rust.keys());
    for (module, ours) in &rust {
        let interface = |parameters: &[(&str, u64)]| {
            Simulator::Icarus.interface(folder.path(), module, parameters, &rtl, &limits).unwrap()
        };
        let name = Size::Neurons.name();
        let has_neurons = interface(&[]).parameters.contains(name);
        let neurons = has_neurons.then_some((name, MOST_NEURONS as u64));
        let verilog = interface(neurons.as_slice()).ports;
        let names: BTreeSet<_> = ours.keys().chain(verilog.keys()).collect();
        for name in names {
            let (left, right) = (verilog.get(name), ours.get(name));
            assert_eq!(left, right, "{name} of {module}: Verilog on the left, Rust on the right");
        }
    }
    for spec in BLOCKS {
        let port = |port: Port| (port.name, vector(port.output, port.width));
        let vectors: Ports = spec.ports(&sizes()).into_iter().map(port).collect();
        assert_eq!(rust[spec.name], vectors, "ports of the golden block {}", spec.name);
    }
}

/// Words of a name, each with a capital.
fn camel(name: &str) -> String {
    let capital = |word: &str| word[..1].to_uppercase() + &word[1..];
    name.split('_').map(capital).collect()
}

#[test]
fn the_addresses_of_the_registers_are_those_of_the_map() {
    let registers = map::ALL.iter().map(|register| (register.name, register.address));
    let memories = map::MEMORIES.iter().map(|memory| (memory.name, memory.address));
    let expected = registers.chain(memories).map(|(name, address)| {
        let bits = map::ADDRESS_BITS;
        format!("localparam [{}:0] {}At = {bits}'h{address:04x};", bits - 1, camel(name))
    });
    let text = fs::read_to_string(root().join("rtl_ref/registers.v")).unwrap();
    let found = text.lines().map(str::trim).filter(|line| line.contains("At = "));
    assert_eq!(found.collect::<Vec<_>>(), expected.collect::<Vec<_>>());
    for (name, value) in [("IdentityValue", map::IDENTITY_VALUE), ("ArmKey", map::ARM_KEY)] {
        assert!(text.contains(&format!("{name} = 32'h{value:08x}")), "{name}: {value:x}");
    }
    let version = format!("MapVersionValue = 32'd{}", map::MAP_VERSION_VALUE);
    assert!(text.contains(&version), "{version}");
}

#[test]
fn every_file_has_one_module_a_timescale_and_no_implicit_nets() {
    for (stem, text) in sources() {
        let head: Vec<_> = text.lines().take(2).collect();
        let expected = ["`timescale 1ps / 1fs", "`default_nettype none"];
        assert_eq!(head, expected, "the first two lines of rtl_ref/{stem}.v");
        let modules = text.lines().filter_map(|line| line.strip_prefix("module "));
        let modules: Vec<_> = modules.filter_map(|rest| rest.split([' ', '(']).next()).collect();
        assert_eq!(modules, [&stem], "modules in rtl_ref/{stem}.v");
    }
}

#[test]
fn vendor_primitives_stay_in_their_files() {
    for (stem, text) in sources() {
        for (primitive, files) in PRIMITIVES {
            let allowed = files.contains(&stem.as_str());
            let found = text.contains(primitive);
            assert_eq!(found, allowed, "{primitive} in rtl_ref/{stem}.v");
        }
    }
}
