//! What cannot be read or written is refused, and leaves no file.

use std::fs;

use crate::common;

use super::refused;

const HEAD: &str = "$timescale 1 ps $end\n$scope module t $end\n$var wire 1 ! a $end\n\
    $var string 1 s s $end\n$upscope $end\n$enddefinitions $end\n";

#[test]
fn a_wrong_part_or_name_is_refused_with_what_was_expected() {
    let folder = common::empty();
    let folder = folder.path();
    fs::write(folder.join("a.vcd"), format!("{HEAD}#0\n0!\n#90\n1!\n")).unwrap();
    let told = |args: &[&str], expected: &str| {
        let error = refused(folder, args);
        assert!(
            error.split_whitespace().collect::<Vec<_>>().join(" ").contains(expected),
            "{error}"
        );
    };
    told(&["convert", "a.vcd", "-o", "b.txt"], "--output: b.txt: expected a name that ends in");
    told(&["convert", "a.vcd", "-o", "no/b.vcd"], "no/b.vcd");
    told(&["convert", "none.vcd", "-o", "b.vcd"], "none.vcd");
    let cut = ["cut", "a.vcd", "-o", "b.vcd"];
    told(&[&cut[..], &["--signals", "x"]].concat(), "a.vcd: none of its 2 signals is chosen");
    told(
        &[&cut[..], &["--after", "1ns"]].concat(),
        "--after: expected a time in a.vcd, which ends at 0.09 ns",
    );
    told(
        &[&cut[..], &["--after", "9ps", "--until", "9ps"]].concat(),
        "--until: expected a time after",
    );
    told(&[&cut[..], &["--after", "9"]].concat(), "expected a time, as 10us or 8.5ns");
    told(&[&cut[..], &["--signals", "["]].concat(), "--signals: [: expected a pattern");
}

#[test]
fn a_damaged_file_and_a_value_that_a_format_cannot_have_leave_no_output() {
    let folder = common::empty();
    let folder = folder.path();
    fs::write(folder.join("a.vcd"), format!("{HEAD}#0\n0!\n#9\nbq !\n")).unwrap();
    for to in ["b.vcd", "b.fst", "b.csv", "b.json"] {
        let error = refused(folder, &["convert", "a.vcd", "-o", to]);
        assert!(error.contains("a.vcd:10:1: a = bq: expected the digits"), "{error}");
    }
    fs::write(folder.join("long.vcd"), format!("{HEAD}#7\ns{} s\n", "word".repeat(50))).unwrap();
    let error = refused(folder, &["convert", "long.vcd", "-o", "b.fst"]);
    assert!(error.contains("long.vcd: t.s = ") && error.contains("128 bytes"), "{error}");
    assert!(error.contains("tofsim wave cut --ignore"), "{error}");
    let many: String = (0..5000).map(|at| format!("#{at}\n{}!\n", at % 2)).collect();
    fs::write(folder.join("many.vcd"), format!("{HEAD}{many}")).unwrap();
    let error = refused(folder, &["convert", "many.vcd", "-o", "b.json"]);
    assert!(error.contains("4096 instants at most") && error.contains("wave cut"), "{error}");
}

#[test]
fn a_capture_has_no_times_for_a_waveform() {
    let folder = common::empty();
    let folder = folder.path();
    let capture = "Sample in Buffer,Sample in Window,TRIGGER,n[3:0]\nRadix - UNSIGNED,UNSIGNED,\
        UNSIGNED,HEX\n0,0,0,a\n1,1,1,b\n2,2,0,b\n";
    fs::write(folder.join("a.csv"), capture).unwrap();
    let error = refused(folder, &["convert", "a.csv", "-o", "b.vcd"]);
    assert!(error.contains("is a capture without times"), "{error}");
    let error = refused(folder, &["cut", "a.csv", "-o", "b.csv", "--after", "1ns"]);
    assert!(error.contains("--after: expected a waveform"), "{error}");
    common::stdout(folder, &["wave", "convert", "a.csv", "-o", "b.csv"]);
    let csv = fs::read_to_string(folder.join("b.csv")).unwrap();
    assert_eq!(csv, "sample,n\n0,10\n1,11\n2,11\n");
}

#[test]
fn a_capture_without_radices_is_read_in_the_radix_given() {
    let folder = common::empty();
    let folder = folder.path();
    let capture = "Sample in Buffer,Sample in Window,TRIGGER,n[7:0]\n0,0,1,10\n1,1,0,11\n";
    fs::write(folder.join("a.csv"), capture).unwrap();
    let values = |radix: &str| {
        common::stdout(folder, &["wave", "convert", "a.csv", "-o", "b.csv", "--radix", radix]);
        let csv = fs::read_to_string(folder.join("b.csv")).unwrap();
        csv.lines().skip(1).map(|row| row.split_once(',').unwrap().1.to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(values("hex"), ["16", "17"]);
    assert_eq!(values("unsigned"), ["10", "11"]);
    assert_eq!(values("binary"), ["2", "3"]);
}
