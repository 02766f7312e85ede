//! Captures as Vivado and chipscopy write them, by hand: what `ila info` says of them, and that they
//! compare with each other.

use std::path::Path;

use serde_json::Value;

use crate::common;

use super::{different, refused, same, write};

fn info(folder: &Path, name: &str) -> Value {
    common::json(folder, &["ila", "info", name, "--json"])
}

/// Two windows of four samples, each triggered at its second.
const VIVADO: &str = "$date\n        2023-Jun-14 11:47:05\n$end\n$version\n        Vivado v2022.2 (64-bit)\n\
    $end\n$timescale\n        1ps\n$end\n$scope module dut $end\n\
    $var reg 6 \" \\path/results_reg[4] [5:0] $end\n$var reg 1 ( top_i/<const0>_17 $end\n\
    $var reg 1 ) a/b [0:0] $end\n$var reg 1 * _TRIGGER $end\n$var reg 1 + _WINDOW $end\n\
    $var reg 1 , _GAP $end\n$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\nb10 \"\n0(\n1)\n0*\n1+\n\
    0,\n$end\n#1\nb11 \"\n1*\n#4\n1(\n0+\n#5\nb111111 \"\n0*\n#7\n0(\n";

/// The same as CSV.
const TABLE: &str = "Sample in Buffer,Sample in Window,TRIGGER,path/results_reg[4][5:0],\
    top_i/<const0>_17,a/b[0:0]\nRadix - UNSIGNED,UNSIGNED,UNSIGNED,HEX,HEX,HEX\n0,0,0,02,0,1\n\
    1,1,1,03,0,1\n2,2,0,03,0,1\n3,3,0,03,0,1\n4,0,0,03,1,1\n5,1,1,3f,1,1\n6,2,0,3f,1,1\n7,3,0,3f,0,1\n";

#[test]
fn a_vcd_s_marks_toggle_and_its_names_are_escaped() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "vivado", VIVADO);
    let found = info(folder, "vivado");
    assert_eq!(found["format"], "ILA VCD");
    assert_eq!((&found["samples"], &found["last_change"]), (&Value::Null, &7.into()));
    assert_eq!((&found["windows"], &found["triggers"]), (&2.into(), &2.into()));
    assert_eq!(found["window_starts"].to_string(), "[0,4]");
    assert_eq!(found["trigger_samples"].to_string(), "[1,5]");
    let probes: Vec<_> = (found["probes"].as_array().unwrap().iter())
        .map(|probe| (probe["name"].as_str().unwrap(), probe["width"].as_u64().unwrap()))
        .collect();
    let names = [("path/results_reg[4]", 6), ("top_i/<const0>_17", 1), ("a/b", 1)];
    assert_eq!(probes, names);
    assert!(found["unknown"].to_string().contains("number of samples"));
}

#[test]
fn one_capture_in_all_forms_is_the_same() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "vivado.vcd", VIVADO);
    write(folder, "table.csv", TABLE);
    write(folder, "windows.csv", &TABLE.replace('\n', "\r\n"));
    let legacy = TABLE.lines().filter(|line| !line.starts_with("Radix"));
    write(folder, "legacy.csv", &(legacy.collect::<Vec<_>>().join("\n") + "\n"));
    let names = ["vivado.vcd", "table.csv", "windows.csv", "legacy.csv"];
    for a in names {
        for b in names {
            let json = same(folder, &[a, b]);
            assert_eq!(
                (&json["compared"], json["signals"].as_array().unwrap().len()),
                (&8.into(), 3)
            );
        }
    }
    let found = info(folder, "legacy.csv");
    assert_eq!(found["format"], "ILA CSV without radix row");
    assert!(found["unknown"].to_string().contains("radix"), "{found:#}");
    write(folder, "other.csv", &TABLE.replace("6,2,0,3f", "6,2,0,3e"));
    let json = different(folder, &["vivado.vcd", "other.csv"]);
    assert_eq!(json["first"]["first"]["window"], 1);
    assert_eq!(json["first"]["first"]["at"].to_string(), "[6.0,6.0]");
}

/// Chipscopy: marks are pulses, `_WINDOW` begins at 0, identifiers at `!`, the last sample is written.
const CHIPSCOPY: &str = "$version\n\tchipscopy\n$end\n$timescale\n\t1ps\n$end\n$scope module dut $end\n\
    $var reg 8 ! n [7:0] $end\n$var reg 1 ) _TRIGGER $end\n$var reg 1 * _WINDOW $end\n\
    $var reg 1 + _GAP $end\n$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\nb1 !\n0)\n0*\n0+\n$end\n\
    #1\n1)\n#2\nb10 !\n0)\n#3\n1*\n#4\n1)\n#5\n0)\nb11 !\n";

#[test]
fn chipscopy_s_marks_are_pulses() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "chipscopy.vcd", CHIPSCOPY);
    let found = info(folder, "chipscopy.vcd");
    assert_eq!(found["window_starts"].to_string(), "[0,3]");
    assert_eq!(found["trigger_samples"].to_string(), "[1,4]");
    let rows = "0,0,0,01\n1,1,1,01\n2,2,0,02\n3,0,0,02\n4,1,1,02\n5,2,0,03\n";
    let head = "Sample in Buffer,Sample in Window,TRIGGER,n[7:0]\nRadix - UNSIGNED,UNSIGNED,UNSIGNED,HEX\n";
    write(folder, "table.csv", &format!("{head}{rows}"));
    same(folder, &["chipscopy.vcd", "table.csv"]);
    let unnamed = CHIPSCOPY.replace("\tchipscopy\n", "\tsomething else\n");
    write(folder, "unnamed.vcd", &unnamed);
    same(folder, &["unnamed.vcd", "table.csv"]);
}

#[test]
fn a_trigger_at_the_first_sample_is_seen() {
    let folder = common::empty();
    let folder = folder.path();
    let early = VIVADO.replace("0*\n1+", "1*\n1+").replace("b11 \"\n1*", "b11 \"");
    write(folder, "early.vcd", &early);
    assert_eq!(info(folder, "early.vcd")["trigger_samples"].to_string(), "[0,5]");
}

#[test]
fn samples_in_a_gap_are_not_compared() {
    let folder = common::empty();
    let folder = folder.path();
    let head = "Sample in Buffer,Sample in Window,TRIGGER,";
    let radices = "Radix - UNSIGNED,UNSIGNED,UNSIGNED,HEX\n";
    let rows = "0,0,0,0,01\n1,1,1,0,02\n2,2,0,1,XX\n3,3,0,0,04\n";
    write(folder, "gap.csv", &format!("{head}GAP,n[7:0]\n{radices}{rows}"));
    let rows = "0,0,0,01\n1,1,1,02\n2,2,0,77\n3,3,0,04\n";
    write(folder, "other.csv", &format!("{head}n[7:0]\n{radices}{rows}"));
    assert_eq!(info(folder, "gap.csv")["gaps"], 1);
    let json = same(folder, &["gap.csv", "other.csv"]);
    assert_eq!(json["compared"], 3);
}

#[test]
fn a_capture_without_samples_has_nothing_to_compare() {
    let folder = common::empty();
    let folder = folder.path();
    let head: String = TABLE.lines().take(2).map(|line| format!("{line}\n")).collect();
    write(folder, "empty.csv", &head);
    let found = info(folder, "empty.csv");
    assert_eq!((&found["samples"], &found["windows"]), (&0.into(), &0.into()));
    let error = refused(folder, &["empty.csv", "empty.csv"]);
    assert!(error.contains("nothing to compare"), "{error}");
}

#[test]
fn what_is_no_capture_is_said_to_be_what_it_is() {
    let folder = common::empty();
    let folder = folder.path();
    let plain = super::vcd("1ns", "top", &[(1, "x")], "#0\n0a\n");
    write(folder, "plain.vcd", &plain);
    let error = common::refused(folder, &["ila", "info", "plain.vcd"]);
    assert!(
        error.contains("plain.vcd: is a waveform (VCD), not a logic analyser's capture"),
        "{error}"
    );
}
