//! Waveforms and captures that were read wrong or refused without a reason, as their users met them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{self, cases};

use super::{csv, different, differing, refused, same, vcd, write};

/// Converts a VCD to FST with a tool that is not ours.
fn fst(folder: &Path, name: &str) -> String {
    let path = PathBuf::from(name).with_extension("fst").display().to_string();
    let done = Command::new("vcd2fst").args([name, &path]).current_dir(folder).output();
    let done = done.expect("vcd2fst is missing: apt-get install gtkwave");
    assert!(done.status.success(), "{done:?}");
    path
}

/// A VCD with one signal of a type, and a bit.
fn declared(kind: &str, body: &str) -> String {
    let head = "$timescale 1ns $end\n$scope module bench $end\n";
    format!(
        "{head}$var {kind} 1 ! state $end\n$var wire 1 \" go $end\n$upscope $end\n\
        $enddefinitions $end\n{body}"
    )
}

#[test]
fn nothing_but_the_result_is_on_standard_output() {
    let folder = cases(&["c01_attr_character.vcd"]);
    let vcd = "c01_attr_character.vcd";
    let json = same(folder.path(), &[vcd, vcd]);
    assert_eq!(json["signals"].as_array().unwrap().len(), 2);
    for attribute in ["misc 02 UNSIGNED 1036", "misc 02 SIGNED 1037", "misc 02 INTEGER 2058"] {
        let text = fs::read_to_string(folder.path().join(vcd)).unwrap();
        let text = text.replace("misc 02 CHARACTER 1039", attribute);
        write(folder.path(), "other.vcd", &text);
        same(folder.path(), &["other.vcd", vcd]);
    }
    // GHDL's FST files have the types `unsigned` and `std_logic`.
    let ghdl = Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures/tests/ghdl/counter");
    let [fst, vcd] = ["fst", "vcd"].map(|kind| ghdl.with_extension(kind).display().to_string());
    same(folder.path(), &[&fst, &vcd, "--all"]);
}

#[test]
fn states_of_vhdl_are_compared_by_value() {
    let folder = cases(&["c02_state_a.vcd", "c02_state_b.vcd"]);
    let folder = folder.path();
    let [a, b] = ["c02_state_a", "c02_state_b"].map(|name| format!("{name}.vcd"));
    let [fst_a, fst_b] = [&a, &b].map(|name| fst(folder, name));
    for [a, b] in [[&a, &b], [&fst_a, &fst_b], [&a, &fst_b]] {
        let json = different(folder, &[a, b]);
        assert_eq!(differing(&json), ["bench.state"]);
        let first = &json["first"]["first"];
        assert_eq!([&first["expected"], &first["got"]], ["RUN", "HALT"]);
    }
    same(folder, &[&a, &fst_a, "--all"]);
}

#[test]
fn a_map_gives_words_of_a_waveform_their_values() {
    let folder = cases(&["c02_state_a.vcd"]);
    let folder = folder.path();
    let bits = vcd("1ns", "bench", &[(2, "state"), (1, "go")], "#0\nb0 a\n0b\n#7\nb10 a\n1b\n");
    write(folder, "bits.vcd", &bits);
    let map =
        |run: u64| format!("[[signal]]\na = [\"state\"]\nstates = {{ IDLE = 0, RUN = {run} }}\n");
    write(folder, "map.toml", &map(2));
    write(folder, "wrong.toml", &map(3));
    let text = "c02_state_a.vcd";
    for sides in [[text, "bits.vcd"], ["bits.vcd", text]] {
        let json = same(folder, &[&sides[..], &["--map", "map.toml", "--all"]].concat());
        assert_eq!(json["signals"].as_array().unwrap().len(), 2);
        let json = different(folder, &[&sides[..], &["--map", "wrong.toml"]].concat());
        assert_eq!(differing(&json), ["bench.state"]);
    }
    let json = same(folder, &[text, "bits.vcd"]);
    let notes = json["notes"].to_string();
    assert!(notes.contains("its words are `IDLE`, `RUN`: the first side has words"), "{notes}");
}

#[test]
fn booleans_strings_and_long_words_are_compared_by_value() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "words.vcd", &declared("string", "#0\nsfalse !\n0\"\n#7\nstrue !\n1\"\n#9\n"));
    for (value, is_same) in [("1", true), ("0", false)] {
        let body = format!("#0\n0a\n0b\n#7\n{value}a\n1b\n#9\n");
        write(folder, "bits.vcd", &vcd("1ns", "bench", &[(1, "state"), (1, "go")], &body));
        let check = if is_same { same } else { different };
        check(folder, &["words.vcd", "bits.vcd"]);
    }
    let long =
        |end: &str| declared("string", &format!("#0\ns{}{end} !\n0\"\n#9\n", "a".repeat(300)));
    write(folder, "long.vcd", &long("b"));
    write(folder, "other.vcd", &long("c"));
    same(folder, &["long.vcd", "long.vcd"]);
    let json = different(folder, &["long.vcd", "other.vcd"]);
    assert_eq!(differing(&json), ["bench.state"]);
}

#[test]
fn blanks_of_a_vcd_do_not_change_it() {
    let folder = cases(&["c03_lines.vcd", "c03_one_line.vcd"]);
    let folder = folder.path();
    let json = same(folder, &["c03_lines.vcd", "c03_one_line.vcd", "--all"]);
    assert_eq!(json["compared"], 2);
    let text = fs::read_to_string(folder.join("c03_lines.vcd")).unwrap();
    for blank in ["\t", "\n", "\r\n", "  "] {
        write(folder, "blank.vcd", &text.replace(" [1:0]", &format!("{blank}[1:0]")));
        let json = same(folder, &["c03_lines.vcd", "blank.vcd", "--all"]);
        assert_eq!(json["signals"][0]["other"], json["signals"][0]["name"]);
    }
    for (from, to) in [("$end\n#0", "$end\t#0"), ("$end\n#0", "$end $comment a $end #0")] {
        write(folder, "line.vcd", &text.replace(from, to));
        same(folder, &["c03_lines.vcd", "line.vcd", "--all"]);
    }
}

#[test]
fn the_waveform_of_both_sides_has_times_below_a_picosecond() {
    let folder = common::empty();
    let folder = folder.path();
    let body = |last: u64| format!("#0\n0a\n#100\n1a\n#250\n0a\n#{last}\n1a\n#1500\n");
    write(folder, "a.vcd", &vcd("1fs", "top", &[(1, "x")], &body(700)));
    write(folder, "b.vcd", &vcd("1fs", "top", &[(1, "x")], &body(701)));
    different(folder, &["a.vcd", "b.vcd", "--waves", "both.vcd"]);
    let both = fs::read_to_string(folder.join("both.vcd")).unwrap();
    assert!(both.contains("$timescale 1 fs $end"), "{both}");
    for time in [0, 100, 250, 700, 701] {
        assert!(both.contains(&format!("\n#{time}\n")), "{time}: {both}");
    }
    let view = fs::read_to_string(folder.join("both.gtkw")).unwrap();
    assert!(view.contains(" 700\n"), "{view}");
}

#[test]
fn ghdl_s_slices_and_arrays_equal_its_vcd() {
    let slice = ["c11_ghw_slice_port.vcd", "c11_ghw_slice_port.ghw"];
    let folder = cases(&[&slice[..], &["c04_two_dimensions.ghw"]].concat());
    same(folder.path(), &[&slice[..], &["--all"]].concat());
    let grid = "c04_two_dimensions.ghw";
    assert_eq!(same(folder.path(), &[grid, grid])["signals"].as_array().unwrap().len(), 3);
}

#[test]
fn a_view_of_a_capture_is_found_under_the_name_in_its_vcd() {
    let names = ["c14_view_names.csv", "c14_view_names.vcd"];
    let folder = cases(&names);
    let json = same(folder.path(), &names);
    assert_eq!(json["signals"].as_array().unwrap().len(), 2);
    let rows: Vec<String> = (0..4).map(|k| format!("{k},{k}")).collect();
    for [a, b] in [["v<1>[1:0]", "v_1_[1:0]"], ["core/a-b[1:0]", "core/a_b[1:0]"]] {
        for (name, head) in [("a.csv", a), ("b.csv", b)] {
            write(folder.path(), name, &csv(&format!("n[2:0],{head}"), "HEX,HEX", 0, &rows));
        }
        same(folder.path(), &["a.csv", "b.csv"]);
    }
}

#[test]
fn words_on_a_real_are_words() {
    let folder = cases(&["c16_real_with_words.vcd"]);
    let folder = folder.path();
    let words = "c16_real_with_words.vcd";
    same(folder, &[words, words, "--all"]);
    let text = fs::read_to_string(folder.join(words)).unwrap();
    write(folder, "other.vcd", &text.replace("sshut", "sajar"));
    let json = different(folder, &[words, "other.vcd"]);
    let first = &json["first"]["first"];
    assert_eq!([&first["expected"], &first["got"]], ["shut", "ajar"]);
}

#[test]
fn a_vcd_that_cannot_be_read_is_refused_with_line_and_signal() {
    let folder = common::empty();
    let folder = folder.path();
    for (text, expected) in [
        (
            declared("real", "#0\nsopen !\n0\"\n#8\nr0.5 !\n"),
            "bad.vcd:11:1: state = r0.5: expected a word, as at other times",
        ),
        (
            declared("wire", "#0\n0!\n0\"\n#8\nr0.5 !\n"),
            "bad.vcd:11:1: state = r0.5: expected bits",
        ),
        (
            declared("wire", "#0\nb011 !\n").replace("wire 1 !", "wire 2 !"),
            "bad.vcd:8:1: state = b011: expected 2 bits at most, not 3",
        ),
        (declared("wire", "#0\nb2 !\n"), "bad.vcd:8:1: state = b2: expected the digits 0, 1, x"),
        (declared("wire", "#0\npD 6 6 !\n"), "bad.vcd:8:1: pD: expected a value, a time or $end"),
        (
            declared("port", "#0\npD 6 6 !\n"),
            "bad.vcd:3:1: state = port: is of an extended VCD ($dumpports)",
        ),
        (
            declared("wire", "#0\n").replace("$upscope", "$timescale 1ps $end\n$upscope"),
            "bad.vcd:5:1: $timescale = 1ps: expected one time scale, and line 1 has it",
        ),
        (
            declared("wire", "#0\n").replace("1ns", "1parsec"),
            "bad.vcd:1:1: $timescale = 1parsec: expected a number and one of zs, as, fs",
        ),
    ] {
        write(folder, "bad.vcd", &text);
        let error = refused(folder, &["bad.vcd", "bad.vcd"]).replace('\n', " ");
        assert!(error.contains(expected), "{expected}: {error}");
    }
}
