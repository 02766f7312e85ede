//! VHDL: three blocks, synthesised by GHDL for `tofsim verify`, and under the benches in VHDL.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

use tofsim_rtl::golden::BLOCKS;

use crate::common;

const THEIRS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/vhdl");
const OWN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../rtl_ref");

/// The blocks, and a fault for each: a text and what stands in its place.
const FAULTS: [(&str, &str, &str); 3] = [
    ("coarse_counter", "count + 1", "count + 2"),
    ("forward2", "begins := Bias", "begins := (others => '0')"),
    ("histogram_builder", "Count <= std_logic_vector(ram", "Count <= not std_logic_vector(ram"),
];

/// Runs GHDL in a folder.
fn ghdl(folder: &Path, args: &[&str]) -> Output {
    let output = Command::new("ghdl").current_dir(folder).args(args).output();
    output.expect("ghdl is not on PATH; install it: apt-get install ghdl")
}

/// Runs the bench of a block in VHDL with one file.
fn bench(folder: &Path, block: &str, file: &Path, cycles: &str) -> Output {
    let args = ["vectors", block, "--language", "vhdl", "--cycles", cycles, "-o", "."];
    common::stdout(folder, &args);
    let (folder, top) = (folder.join(block), format!("tb_{block}"));
    let (own, file) = (format!("{top}.vhd"), file.to_str().unwrap());
    for step in [&["-i", "--std=08", &own, file][..], &["-m", "--std=08", &top]] {
        let output = ghdl(&folder, step);
        assert!(output.status.success(), "{block}: {}", String::from_utf8_lossy(&output.stderr));
    }
    ghdl(&folder, &["-r", "--std=08", &top])
}

fn verify(folder: &Path, rtl: &Path, args: &[&str]) -> Output {
    let rtl = rtl.to_str().unwrap();
    common::output(folder, &[&["verify", "--rtl", rtl, "--json"], args].concat())
}

fn planted(folder: &Path, (block, old, new): (&str, &str, &str)) -> PathBuf {
    let text = fs::read_to_string(format!("{THEIRS}/{block}.vhd")).unwrap();
    assert!(text.contains(old), "{old} is not in {block}.vhd");
    let path = folder.join(format!("{block}.vhd"));
    fs::write(&path, text.replace(old, new)).unwrap();
    path
}

#[test]
fn blocks_in_vhdl_pass_and_a_fault_is_found_at_the_same_cycle_by_both_ways() {
    for fault @ (block, ..) in FAULTS {
        let folder = common::empty();
        let args = ["--block", block, "--cycles", "1000"];
        let output = verify(folder.path(), Path::new(THEIRS), &args);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{block}: {error}");
        let file = PathBuf::from(format!("{THEIRS}/{block}.vhd"));
        let output = bench(folder.path(), block, &file, "1000");
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success(), "{block}: {text}");
        assert!(text.contains(&format!("tb_{block}: PASS, 1000 cycles, 0 mismatches")), "{text}");

        let folder = common::empty();
        let file = planted(folder.path(), fault);
        let output = verify(folder.path(), &file, &args);
        assert_eq!(output.status.code(), Some(1), "{block}");
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        let first = &report["blocks"][0]["first"];
        let output = bench(folder.path(), block, &file, "1000");
        assert!(!output.status.success());
        let text = String::from_utf8(output.stdout).unwrap();
        let begin = format!(
            "mismatch: cycle {}, time {} ps, {}: expected ",
            first["cycle"],
            first["time_ps"],
            first["signal"].as_str().unwrap()
        );
        assert!(text.contains(&begin), "{begin} is not in {text}");
        let mismatches = &report["blocks"][0]["mismatches"];
        let total = format!("tb_{block}: FAIL, 1000 cycles, {mismatches} mismatches");
        assert!(text.contains(&total), "{total} is not in {text}");
    }
}

#[test]
#[ignore = "long: ./check --full"]
fn blocks_in_vhdl_pass_under_verilator_with_all_their_vectors() {
    for (block, ..) in FAULTS {
        let folder = common::empty();
        let args = ["--block", block, "--simulator", "verilator"];
        let output = verify(folder.path(), Path::new(THEIRS), &args);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn a_block_in_vhdl_works_in_a_design_in_verilog() {
    let folder = common::empty();
    for file in ["tdc", "tdc_latch", "tdc_decoder", "carry_chain"] {
        fs::copy(format!("{OWN}/{file}.v"), folder.path().join(format!("{file}.v"))).unwrap();
    }
    let args = ["--block", "tdc.default", "--cycles", "2000"];
    for (old, new, status) in [("", "", 0), ("count + 1", "count + 2", 1)] {
        planted(folder.path(), ("coarse_counter", old, new));
        let output = verify(folder.path(), folder.path(), &args);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{error}");
    }
}

#[test]
#[ignore = "long: ./check --full"]
fn the_bench_of_every_block_runs_and_finds_an_entity_that_does_nothing() {
    let folder = common::empty();
    for spec in BLOCKS {
        // The only way to its ports and generics is through the files that any user has.
        let block = spec.name;
        common::stdout(folder.path(), &["vectors", block, "--cycles", "300", "-o", "."]);
        let ports = fs::read_to_string(folder.path().join(block).join("ports.json")).unwrap();
        let file = folder.path().join(format!("{block}.vhd"));
        fs::write(&file, idle(&serde_json::from_str(&ports).unwrap())).unwrap();
        let output = bench(folder.path(), block, &file, "300");
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(!output.status.success(), "{block}: {text}");
        assert!(text.contains("mismatch: cycle "), "{block}: {text}");
        assert!(text.contains(&format!("tb_{block}: FAIL, 300 cycles, ")), "{block}: {text}");
    }
}

/// An entity with those ports and generics, which drives nothing.
fn idle(described: &Value) -> String {
    let list = |items: Vec<String>| items.join(";\n    ");
    let port = |port: &Value| {
        let direction = if port["direction"] == "output" { "out" } else { "in" };
        let kind = match port["width"].as_u64().unwrap() {
            1 => "std_logic".to_owned(),
            width => format!("std_logic_vector({} downto 0)", width - 1),
        };
        format!("{} : {direction} {kind}", port["name"].as_str().unwrap())
    };
    let generic = |(name, value): (&String, &Value)| {
        format!("{name} : {}", if value.is_string() { "string" } else { "integer" })
    };
    let block = described["block"].as_str().unwrap();
    let ports = list(described["ports"].as_array().unwrap().iter().map(port).collect());
    let generics = list(described["parameters"].as_object().unwrap().iter().map(generic).collect());
    let generics = match generics.as_str() {
        "" => String::new(),
        generics => format!("  generic (\n    {generics}\n  );\n"),
    };
    format!(
        "library ieee;\nuse ieee.std_logic_1164.all;\n\nentity {block} is\n{generics}  port (\n    \
         {ports}\n  );\nend entity;\n\narchitecture idle of {block} is\nbegin\nend architecture;\n"
    )
}

#[test]
fn what_cannot_be_checked_is_refused_with_the_reason() {
    let folder = common::empty();
    let refused = |fault: (&str, &str, &str), args: &[&str]| {
        let file = planted(folder.path(), fault);
        let all = [&["verify", "--rtl", file.to_str().unwrap(), "--block", fault.0], args];
        common::refused(folder.path(), &all.concat())
    };
    let error = refused(("forward2", "W2File", "Weight_File"), &[]);
    assert!(error.contains("module forward2, parameter W2File: no such parameter"), "{error}");
    let error = refused(("coarse_counter", "elsif start", "elsif stat"), &[]);
    assert!(error.contains("coarse_counter.vhd:29:13") && error.contains("\"stat\""), "{error}");
    let error = refused(("coarse_counter", "end if", "fi"), &[]);
    assert!(error.contains("coarse_counter.vhd:"), "{error}");
    let error = refused(("coarse_counter", "window  : out", "windo   : out"), &[]);
    assert!(error.contains("coarse_counter.vhd:"), "{error}");
    let error = refused(("coarse_counter", "", ""), &["--registers"]);
    assert!(error.contains("expected a module in Verilog"), "{error}");
    let file = format!("{THEIRS}/coarse_counter.vhd");
    let args = ["verify", "--rtl", &file, "--block", "coarse_counter"];
    // The simulator is there, GHDL is not.
    for tool in ["iverilog", "vvp"] {
        fs::write(folder.path().join(tool), "").unwrap();
    }
    let output = common::tofsim(folder.path(), &args).env("PATH", folder.path()).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(error.contains("apt-get install ghdl"), "{error}");
    let error = common::refused(folder.path(), &["verify", "--rtl", &file, "--cycle-counts"]);
    assert!(error.contains("expected Verilog sources only"), "{error}");
}
