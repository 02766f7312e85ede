//! Tests of GHDL's waveforms against the VCD of the same run.

use std::path::{Path, PathBuf};

use tofsim_captures::compare::{Comparison, Options, compare};
use tofsim_captures::source::Source;

fn source(name: &str) -> Source {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name);
    Source::file(&path, None).unwrap()
}

fn compared(a: &str, b: &str) -> Comparison {
    compare(&source(a), &source(b), &Options::default()).unwrap()
}

/// Returns the known values of a signal with their times [ns].
fn changes(source: &Source, name: &str) -> Vec<(u64, u64)> {
    let named = source.signals.iter().find(|signal| signal.name.text == name);
    let id = named.unwrap_or_else(|| panic!("{name} is missing")).id;
    let mut cursor = source.read(&[id]).unwrap();
    let mut changes = Vec::new();
    while let Some(at) = cursor.peek().unwrap() {
        cursor.take(|_| ());
        changes.push((at / 1_000_000, cursor.state.value(0)[0]));
    }
    changes
}

#[test]
fn a_port_mapped_to_a_slice_has_the_bits_of_the_slice() {
    let result = compared("cases/c11_ghw_slice_port.vcd", "cases/c11_ghw_slice_port.ghw");
    assert!(result.is_same(), "{:?}", result.differences);
    assert_eq!((result.pairs.len(), result.unmatched.len()), (3, 0));
}

/// Made by `ghdl -r --std=08 shares --wave=shares.ghw --vcd=shares.vcd`.
#[test]
fn ports_that_join_bits_of_several_signals_equal_those_of_the_vcd() {
    let result = compared("ghdl/shares.vcd", "ghdl/shares.ghw");
    assert!(result.is_same(), "{:?}", result.differences);
    let ghw_only = 1 + 1 + 2 + 2 + 2 + 1;
    assert_eq!((result.pairs.len(), result.unmatched.len()), (10, ghw_only));
}

#[test]
fn records_arrays_and_states_have_the_values_of_the_design() {
    let shares = source("ghdl/shares.ghw");
    for (name, expected) in [
        ("shares.pair.high", vec![(0, 0), (5, 0b10), (10, 0b01)]),
        ("shares.pair.low", vec![(0, 0), (5, 0b0111), (10, 0b1000)]),
        ("shares.grid[0]", vec![(0, 0)]),
        ("shares.grid[1]", vec![(0, 0), (5, 0b001)]),
        ("shares.rows[2]", vec![(0, 0)]),
        ("shares.rows[1]", vec![(0, 0), (5, 0xa)]),
        ("shares.state", vec![(0, 0), (5, 1), (10, 2)]),
        ("shares.busy", vec![(0, 1), (5, 2)]),
        ("shares.is_on", vec![(0, 0), (5, 1), (10, 0)]),
        ("shares.count", vec![(0, 0), (5, 0xffff_fffe)]),
        ("shares.gap", vec![(0, 0), (5, 3_000_000_000)]),
        ("shares.ratio", vec![(0, 0), (5, 0.5f64.to_bits())]),
    ] {
        assert_eq!(changes(&shares, name), expected, "{name}");
    }
    assert_eq!(shares.end, Some(20_000_000));
}

#[test]
fn a_two_dimensional_array_is_read_row_by_row() {
    let grid = source("cases/c04_two_dimensions.ghw");
    assert_eq!(changes(&grid, "t2.g[0]"), [(0, 0)]);
    let toggles = [(0, 0), (3, 1), (9, 0), (15, 1)];
    assert_eq!(changes(&grid, "t2.g[1]"), toggles);
}
