//! Waveforms of GHDL and Icarus Verilog, against their own text dumps, cell by cell.

use std::fs;
use std::path::Path;

use crate::common;

use super::{Cells, cells, convert, of_fst, read, same, through_gtkwave, tool};

/// A design in VHDL with signals of all types.
const VHDL: &str = include_str!("types.vhd");
/// One in Verilog.
const VERILOG: &str = include_str!("types.v");

/// Simulates the design in GHDL, which writes `t.vcd`, `t.fst` and `t.ghw`.
fn ghdl(folder: &Path) {
    fs::write(folder.join("types.vhd"), VHDL).unwrap();
    tool(folder, &["ghdl", "-a", "--std=08", "types.vhd"]);
    tool(folder, &["ghdl", "-e", "--std=08", "types"]);
    let dumps = ["--vcd=t.vcd", "--fst=t.fst", "--wave=t.ghw"];
    tool(folder, &[&["ghdl", "-r", "--std=08", "types"], &dumps[..]].concat());
}

/// Asserts that the cells of `names` are those of GHDL's text.
fn assert_as_ghdl(own: &Cells, theirs: &Cells, names: &[&str]) {
    for name in names {
        let name = format!("types.{name}");
        let changes = &theirs[&name];
        assert!(changes.len() > 1, "{name}: {changes:?}");
        assert_eq!(&own[&name], changes, "{name}");
    }
}

#[test]
fn a_ghw_file_converts_to_what_ghdl_writes_as_vcd() {
    let folder = common::empty();
    let folder = folder.path();
    ghdl(folder);
    let theirs = read(folder, "t.vcd");
    convert(folder, "t.ghw", "g.vcd");
    convert(folder, "t.ghw", "g.fst");
    convert(folder, "g.fst", "h.vcd");
    let names = ["b", "r", "i", "n", "u", "v", "up", "bt", "bv"];
    for own in [
        read(folder, "g.vcd"),
        through_gtkwave(folder, "g.vcd"),
        of_fst(folder, "g.fst"),
        read(folder, "h.vcd"),
    ] {
        assert_as_ghdl(&own, &theirs, &names);
    }
    // What GHDL leaves out of its VCD, by the assignments in the source.
    let own = read(folder, "g.vcd");
    let of = |name: &str| own[&format!("types.{name}")].clone();
    let at = |list: &[(u64, &str)]| -> Vec<(u64, String)> {
        list.iter().map(|(at, value)| (at * 1_000_000, (*value).to_owned())).collect()
    };
    assert_eq!(of("s"), at(&[(0, "00"), (1, "01"), (3, "10"), (4, "11")]));
    assert_eq!(of("c"), at(&[(0, "01100001"), (1, "01011010"), (3, "00100000")]));
    assert_eq!(of("q.s"), at(&[(0, "01"), (1, "11")]));
    assert_eq!(of("q.n")[1].1, "1".repeat(32));
    let text = fs::read_to_string(folder.join("g.vcd")).unwrap();
    assert!(text.contains(" 4 idle run \\'x\\' done 00 01 10 11 "), "names of states");
    convert(folder, "t.ghw", "g.csv");
    let csv = fs::read_to_string(folder.join("g.csv")).unwrap();
    let rows: Vec<csv::StringRecord> =
        csv::Reader::from_reader(csv.as_bytes()).records().map(Result::unwrap).collect();
    let header = csv::Reader::from_reader(csv.as_bytes()).headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|found| found == name).unwrap();
    let (state, character) = (column("types.s"), column("types.c"));
    let states: Vec<_> = rows.iter().map(|row| [&row[0], &row[state], &row[character]]).collect();
    assert_eq!(states[0], ["0", "idle", "'a'"]);
    assert_eq!(states[2], ["3000000", "'x'", "' '"]);
}

#[test]
fn ghdl_s_own_fst_converts_with_its_words() {
    let folder = common::empty();
    let folder = folder.path();
    ghdl(folder);
    convert(folder, "t.fst", "f.vcd");
    convert(folder, "f.vcd", "g.fst");
    // GHDL leaves scopes out of its FST.
    let theirs = of_fst(folder, "t.fst");
    let own = [read(folder, "f.vcd"), of_fst(folder, "g.fst"), through_gtkwave(folder, "f.vcd")];
    for own in own {
        for name in ["s", "c", "u", "v", "up", "bt", "bv", "b"] {
            let found = own.iter().find(|(own, _)| own.rsplit('.').next() == Some(name)).unwrap().1;
            let expected =
                theirs.iter().find(|(own, _)| own.rsplit('.').next() == Some(name)).unwrap().1;
            assert_eq!(found, expected, "{name}");
        }
    }
}

#[test]
fn icarus_s_dump_is_the_same_in_fst_and_back() {
    let folder = common::empty();
    let folder = folder.path();
    fs::write(folder.join("types.v"), VERILOG).unwrap();
    tool(folder, &["iverilog", "-g2012", "-o", "types.vvp", "types.v"]);
    tool(folder, &["vvp", "types.vvp"]);
    let theirs = read(folder, "icarus.vcd");
    assert!(theirs.len() > 10, "{:?}", theirs.keys());
    convert(folder, "icarus.vcd", "own.fst");
    convert(folder, "own.fst", "own.vcd");
    assert_eq!(read(folder, "own.vcd"), theirs);
    assert_eq!(of_fst(folder, "own.fst"), theirs);
    assert_eq!(cells(&tool(folder, &["fst2vcd", "own.fst"])).len(), theirs.len());
    same(folder, "icarus.vcd", "own.fst", distinct(folder));
}

/// Number of different signals in Icarus's dump.
fn distinct(folder: &Path) -> usize {
    let info = common::json(folder, &["wave", "info", "icarus.vcd", "--json"]);
    info["different_signals"].as_u64().unwrap() as usize
}
