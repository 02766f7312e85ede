//! Tests of the start and end of a comparison of waveforms, and of the times it reports.

use std::fs;
use std::path::Path;

use crate::common;

use super::waveforms::counting;
use super::{different, differing, same, vcd, write};

#[test]
fn the_first_instant_left_out_is_that_of_until() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &counting("1ns", 5, "top", 7));
    write(folder, "b.vcd", &counting("1ns", 5, "top", 39));
    same(folder, &["a.vcd", "b.vcd", "--until", "35ns"]);
    same(folder, &["a.vcd", "b.vcd", "--until", "34.5ns"]);
    different(folder, &["a.vcd", "b.vcd", "--until", "35.5ns"]);
}

#[test]
fn what_stands_at_the_begin_is_compared_there() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &counting("1ns", 5, "top", 7));
    write(folder, "b.vcd", &counting("1ns", 5, "top", 39));
    let at = |after: &str| {
        let json = different(folder, &["a.vcd", "b.vcd", "--after", after]);
        json["first"]["first"]["at"][0].clone()
    };
    assert_eq!(at("35ns"), 35000.0);
    assert_eq!(at("35.5ns"), 40000.0);
    same(folder, &["a.vcd", "b.vcd", "--after", "45ns"]);
    same(folder, &["a.vcd", "b.vcd", "--after", "40.5ns"]);
}

#[test]
fn a_file_that_ends_within_an_instant_is_said_to_end_there() {
    let folder = common::empty();
    let folder = folder.path();
    let whole = counting("1ns", 5, "top", 7);
    write(folder, "a.vcd", &whole);
    write(folder, "b.vcd", whole.split_once("b1011 b\n").unwrap().0);
    for files in [["a.vcd", "b.vcd"], ["b.vcd", "a.vcd"]] {
        let json = different(folder, &files);
        assert!(json["differences"].to_string().contains("at 55 ns"), "{json:#}");
    }
}

#[test]
fn a_file_ends_with_its_last_time_wherever_that_stands() {
    let folder = common::empty();
    let folder = folder.path();
    for (name, seventh) in [("a.vcd", 7), ("b.vcd", 39)] {
        let text = counting("1ns", 5, "top", seventh);
        let (head, rest) = text.split_once("\n#5\n").unwrap();
        write(folder, name, &format!("{head} #5 {}", rest.replace('\n', " ")));
    }
    let json = different(folder, &["a.vcd", "b.vcd"]);
    assert_eq!(json["first"]["first"]["at"][0], 35000.0);
    let plain = counting("1ns", 5, "top", 7);
    write(folder, "plain.vcd", &plain);
    write(folder, "comment.vcd", &format!("{plain}$comment\n#500\n$end\n"));
    same(folder, &["a.vcd", "plain.vcd"]);
    same(folder, &["comment.vcd", "plain.vcd"]);
}

#[test]
fn a_file_that_does_not_say_its_end_is_read_to_it() {
    let ghw = Path::new(env!("CARGO_MANIFEST_DIR")).join("../captures/tests/ghdl/counter.ghw");
    let whole = fs::read_to_string(ghw.with_extension("vcd")).unwrap();
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "cut.vcd", whole.rsplit_once("#100000000\n").unwrap().0);
    for (files, text) in [
        (["cut.vcd", ghw.to_str().unwrap()], "first side ends at 95 ns, the second at 200 ns"),
        ([ghw.to_str().unwrap(), "cut.vcd"], "first side ends at 200 ns, the second at 95 ns"),
    ] {
        let json = different(folder, &files);
        assert!(json["differences"].to_string().contains(text), "{json:#}");
        assert!(differing(&json).is_empty());
    }
}

#[test]
fn each_side_s_place_is_told_in_its_own_time() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "ns.vcd", &counting("1ns", 5, "top", 7));
    write(folder, "fs.vcd", &counting("100 fs", 50_003, "top", 39));
    let at = |args: &[&str]| different(folder, args)["first"]["first"]["at"].to_string();
    assert_eq!(at(&["ns.vcd", "fs.vcd"]), "[35000.0,35000.0]");
    let body =
        |late: u64, x: u64| format!("#0\nb1 a\n#{}\nb{x:b} a\n#{}\nb0 a\n", 10 + late, 30 + late);
    write(folder, "a.vcd", &vcd("1ns", "top", &[(4, "x")], &body(0, 2)));
    write(folder, "b.vcd", &vcd("1ns", "top", &[(4, "x")], &body(7, 3)));
    assert_eq!(at(&["a.vcd", "b.vcd", "--align", "offset 7ns"]), "[10000.0,17000.0]");
    let early = ["b.vcd", "a.vcd", "--align", "offset -7ns", "--after", "12ns"];
    assert_eq!(at(&early), "[17000.0,10000.0]");
}

#[test]
fn an_edge_begins_at_a_known_value_and_may_be_the_first_instant() {
    let folder = common::empty();
    let folder = folder.path();
    let variables = [(1, "go")];
    let a = vcd("1ns", "top", &variables, "#0\nxa\n#3\n0a\n#10\n1a\n#30\n0a\n");
    write(folder, "a.vcd", &a);
    write(folder, "b.vcd", &vcd("1ns", "top", &variables, "#0\n0a\n#17\n1a\n#37\n0a\n"));
    same(folder, &["a.vcd", "b.vcd", "--align", "edge go", "--x", "any"]);
    same(folder, &["a.vcd", "b.vcd", "--align", "edge go", "--after", "10ns"]);
}

#[test]
fn a_waveform_of_both_sides_ends_with_its_last_difference() {
    let folder = common::empty();
    let folder = folder.path();
    let variables = [(2, "x"), (1, "y")];
    let body = |x: &str, y: u8| format!("#0\nb00 a\n0b\n#10\n{y}b\n#20\nb{x} a\n");
    write(folder, "a.vcd", &vcd("1ns", "top", &variables, &body("1x", 0)));
    write(folder, "b.vcd", &vcd("1ns", "top", &variables, &body("1z", 1)));
    different(folder, &["a.vcd", "b.vcd", "--signals", "x", "--waves", "both.vcd"]);
    let text = fs::read_to_string(folder.join("both.vcd")).unwrap();
    let (_, last) = text.split_once("#20000\n").unwrap();
    assert_eq!(last, "b1x !\nb1z \"\n1#\n1$\n");
    different(folder, &["a.vcd", "b.vcd", "--waves", "both.vcd"]);
    let commands = fs::read_to_string(folder.join("both.sucl")).unwrap();
    assert!(commands.ends_with("marker_set first 10000\ncursor_set 10000\n"), "{commands}");
    let save = fs::read_to_string(folder.join("both.gtkw")).unwrap();
    assert!(save.contains("[savefile] \"both.gtkw\"\n"), "{save}");
    assert!(save.contains("[timestart] 9375\n"), "{save}");
}
