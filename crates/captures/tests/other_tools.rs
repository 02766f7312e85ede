//! Tests of waveforms that other tools have written, against the text dumps that their designs print: every signal at
//! every instant. `other_tools/make` makes both again.

mod cells;
mod files;
mod list;
mod rows;
mod table;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use tofsim_captures::source::{Signal, Source};

use files::{Tool, Waveform};
use list::FILES;
use table::{Column, Kind, Table};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/other_tools")
}

/// Returns the signal of a column, whose range has to be the declared one.
fn signal<'a>(file: &Waveform, source: &'a Source, column: &Column) -> &'a Signal {
    let name = file.renamed(&column.name);
    let found: Vec<_> = source.signals.iter().filter(|signal| signal.name.text == name).collect();
    let [signal] = found[..] else {
        let names: Vec<&str> = source.signals.iter().map(|signal| &signal.name.text[..]).collect();
        panic!("{}: {name} {} times among {names:?}", file.name, found.len());
    };
    let expected = if file.has_ranges { column.range } else { None };
    assert_eq!(signal.range, expected, "{}: range of {name}", file.name);
    let is_cut = column.kind == Kind::Number && signal.width == 1;
    assert_eq!(is_cut, column.kind == Kind::Number && file.is_cut, "{}: {name}", file.name);
    signal
}

/// Compares a waveform with its text dump, and returns the number of cells.
fn compared(file: &Waveform) -> usize {
    let table = Table::read(&folder().join(file.design()).with_extension("txt"));
    let source = Source::file(&folder().join(file.name), None).unwrap();
    let columns = table.columns.iter().enumerate();
    let (lacking, columns): (Vec<_>, Vec<_>) = columns.partition(|(_, column)| file.lacks(column));
    let held: Vec<(usize, &Signal)> =
        columns.iter().map(|&(k, column)| (k, signal(file, &source, column))).collect();
    assert_eq!(lacking.len(), file.lacking, "{}: columns that it lacks", file.name);
    let known: BTreeSet<&str> = held.iter().map(|(_, signal)| &signal.name.text[..]).collect();
    let others: BTreeSet<&str> =
        source.signals.iter().map(|signal| &signal.name.text[..]).collect();
    let others: Vec<&str> = others.difference(&known).copied().collect();
    assert_eq!(others, file.others, "{}: signals without a column", file.name);
    let (expected, got) =
        (rows::printed(file, &table, &held), rows::read(file, &source, &table, &held));
    for (expected, got) in expected.iter().zip(&got) {
        for (k, &(column, _)) in held.iter().enumerate() {
            let (name, place) = (&table.columns[column].name, (expected.0, got.0));
            assert_eq!(expected.1[k], got.1[k], "{}: {name} at {place:?} fs", file.name);
        }
        assert_eq!(expected.0, got.0, "{}: time [fs]", file.name);
    }
    assert_eq!(expected.len(), got.len(), "{}: instants", file.name);
    held.len() * expected.len()
}

/// Compares the files of a tool, and returns the number of cells.
fn cells_of(tool: Tool) -> usize {
    FILES.iter().filter(|file| file.tool == tool).map(compared).sum()
}

#[test]
fn ghdl_s_waveforms_have_the_values_that_the_designs_print() {
    assert_eq!(cells_of(Tool::Ghdl), 1557);
}

#[test]
fn icarus_s_waveforms_have_the_values_that_the_designs_print() {
    assert_eq!(cells_of(Tool::Icarus), 1130);
}

#[test]
fn gtkwave_s_conversions_have_the_values_that_the_designs_print() {
    assert_eq!(cells_of(Tool::Gtkwave), 1195);
}

#[test]
fn verilator_s_waveforms_have_the_values_that_the_designs_print() {
    assert_eq!(cells_of(Tool::Verilator), 848);
}

#[test]
fn yosys_s_waveforms_have_the_values_that_icarus_prints() {
    assert_eq!(cells_of(Tool::Yosys), 462);
}

#[test]
fn a_vcd_without_a_time_scale_is_read_in_nanoseconds_with_a_note() {
    let [vcd, fst] = ["yosys_states.vcd", "yosys_states.fst"]
        .map(|name| Source::file(&folder().join(name), None).unwrap());
    assert_eq!(vcd.axis, fst.axis);
    assert_eq!(vcd.notes, ["has no $timescale: times are read as nanoseconds"]);
    assert!(fst.notes.is_empty());
}

#[test]
fn waveforms_of_python_s_tools_have_the_values_that_the_scripts_print() {
    assert_eq!(cells_of(Tool::Python), 510);
}

#[test]
fn forty_files_or_more_are_read_and_none_is_left_out() {
    let entries = fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    let is_waveform = |path: &PathBuf| {
        path.extension().is_some_and(|end| ["vcd", "fst", "ghw"].iter().any(|known| end == *known))
    };
    let found: BTreeSet<String> = entries
        .filter(is_waveform)
        .map(|path| path.file_name().unwrap().to_string_lossy().into_owned())
        .collect();
    let listed: BTreeSet<String> = FILES.iter().map(|file| file.name.to_owned()).collect();
    assert_eq!(found, listed);
    assert!(listed.len() == FILES.len() && FILES.len() >= 40, "{}", FILES.len());
}
