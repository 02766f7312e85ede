//! A part of a waveform.

use std::fs;

use crate::common::{self, stdout};

use super::{Cells, of_fst, read};

const WAVE: &str = "$timescale 1 ns $end\n$scope module t $end\n$var wire 1 ! a $end\n\
    $var wire 4 # n [3:0] $end\n$var real 64 r r $end\n$var real 64 q q $end\n\
    $var event 1 e e $end\n$upscope $end\n$enddefinitions $end\n\
    #0\n1!\nb1 #\n1e\n#10\n0!\nr2.5 r\n#20\nb10 #\n1e\n#30\n1!\n1e\n#40\nbx #\nr1 q\n#50\n";

fn cut(to: &str, args: &[&str]) -> Cells {
    let folder = common::empty();
    let folder = folder.path();
    fs::write(folder.join("a.vcd"), WAVE).unwrap();
    stdout(folder, &[&["wave", "cut", "a.vcd", "-o", to], args].concat());
    if to.ends_with(".fst") { of_fst(folder, to) } else { read(folder, to) }
}

fn changes(of: &[(&str, &[(u64, &str)])]) -> Cells {
    let changes = |list: &[(u64, &str)]| list.iter().map(|(at, v)| (*at, v.to_string())).collect();
    of.iter().map(|(name, list)| (format!("t.{name}"), changes(list))).collect()
}

#[test]
fn a_part_begins_with_the_values_at_its_start_and_ends_before_its_end() {
    let real = format!("{:x}", 2.5f64.to_bits());
    let expected = changes(&[
        ("a", &[(15, "0"), (30, "1")]),
        ("n", &[(15, "0001"), (20, "0010")]),
        ("r", &[(15, &real)]),
        ("e", &[(20, "1")]),
    ]);
    assert_eq!(cut("b.vcd", &["--after", "15ns", "--until", "40ns"]), expected);
    let fst = cut("b.fst", &["--after", "15ns", "--until", "40ns"]);
    assert_eq!(fst["t.n"], expected["t.n"]);
    assert_eq!(fst["t.a"], expected["t.a"]);
    assert_eq!(fst["t.r"], expected["t.r"]);
    assert!(!fst.contains_key("t.q"), "{fst:?}");
}

#[test]
fn events_before_the_start_are_no_part_of_it() {
    let none = cut("b.vcd", &["--after", "35ns", "--signals", "e", "--signals", "a"]);
    assert_eq!(none, changes(&[("a", &[(35, "1")])]));
    let first = cut("b.vcd", &["--after", "30ns", "--signals", "e"]);
    assert_eq!(first, changes(&[("e", &[(30, "1")])]));
    // Another signal has a change at the start, but no event occurs there.
    let other = cut("b.vcd", &["--after", "40ns", "--signals", "e", "--signals", "n"]);
    assert_eq!(other, changes(&[("n", &[(40, "xxxx")])]));
    let folder = common::empty();
    fs::write(folder.path().join("a.vcd"), WAVE).unwrap();
    let count = |args: &[&str]| {
        let args = [&["wave", "stats", "a.vcd", "--json", "--signals", "e"], args].concat();
        common::json(folder.path(), &args)["signals"][0]["changes"].as_u64()
    };
    assert_eq!(count(&[]), Some(3));
    assert_eq!((count(&["--after", "20ns"]), count(&["--after", "21ns"])), (Some(2), Some(1)));
}

#[test]
fn a_part_that_begins_at_a_change_has_the_new_value() {
    let found = cut("b.vcd", &["--after", "20ns", "--signals", "t.[ne]"]);
    let expected = changes(&[("n", &[(20, "0010"), (40, "xxxx")]), ("e", &[(20, "1")])]);
    assert_eq!(found, expected);
    let found = cut("b.vcd", &["--after", "45ns", "--ignore", "q", "--ignore", "r"]);
    assert_eq!(found, changes(&[("a", &[(45, "1")]), ("n", &[(45, "xxxx")])]));
}
