//! The firmware's Verilog, simulated with the same photons, against our waveform.

use std::fs;
use std::path::Path;
use std::process::Command;

use tofsim_rtl::verify::simulator::QUICK_TO_COMPILE;

use crate::common;

use super::same;

const SHORT: &str = "firmware.shots_per_frame=40";

/// Runs a program that has to succeed.
fn run(folder: &Path, program: &str, args: &[&str]) {
    let output = Command::new(program).current_dir(folder).args(args).output();
    let output = output.unwrap_or_else(|error| {
        panic!("{program}: {error}; `apt-get install iverilog verilator` installs it")
    });
    let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{program}: {text}");
}

/// The bench of a short frame, which dumps everything, and the Verilog.
fn bench(folder: &Path) -> Vec<String> {
    let args = ["vectors", "tof_top", "--scenario", "kc705", "-s", SHORT, "-o", "."];
    common::stdout(folder, &args);
    let bench = folder.join("tof_top/tb_tof_top.v");
    let text = fs::read_to_string(&bench).unwrap();
    let end = text.rfind("endmodule").unwrap();
    let dump = "initial begin $dumpfile(\"verilog.vcd\"); $dumpvars(0, tb_tof_top); end\n";
    fs::write(&bench, format!("{}{dump}{}", &text[..end], &text[end..])).unwrap();
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../rtl_ref");
    let sources = fs::read_dir(own).unwrap().map(|entry| entry.unwrap().path());
    let sources = sources.filter(|path| path.extension().is_some_and(|end| end == "v"));
    let names = sources.map(|path| path.display().to_string());
    ["tb_tof_top.v".to_owned()].into_iter().chain(names).collect()
}

fn compare(folder: &Path) {
    let args = ["run", "-s", SHORT, "--window", "0us..7.28us", "-o", "."];
    common::stdout(folder, &args);
    let json = same(folder, &["kc705.vcd", "tof_top/verilog.vcd"]);
    let names: usize = (json["signals"].as_array().unwrap().iter())
        .map(|signal| 1 + signal["aliases"].as_u64().unwrap() as usize)
        .sum();
    assert!(names >= 228, "{names} names came together");
    assert!(json["compared"].as_u64().unwrap() > 5000);
    let ours = json["unmatched"].as_array().unwrap().iter().filter(|name| name["side"] == "a");
    assert_eq!(ours.count(), 0, "{json:#}");
    same(folder, &["--scenario", "kc705", "-s", SHORT, "tof_top/verilog.vcd"]);
}

#[test]
fn in_icarus_it_is_the_same_without_a_map() {
    let folder = common::empty();
    let folder = folder.path();
    let sources = bench(folder);
    let sources: Vec<&str> = sources.iter().map(String::as_str).collect();
    let bench = folder.join("tof_top");
    run(
        &bench,
        "iverilog",
        &[&["-g2012", "-s", "tb_tof_top", "-o", "bench"], &sources[..]].concat(),
    );
    run(&bench, "vvp", &["-n", "bench"]);
    compare(folder);
}

#[test]
#[ignore = "long: ./check --full"]
fn in_verilator_it_is_the_same_without_a_map() {
    let folder = common::empty();
    let folder = folder.path();
    let sources = bench(folder);
    let sources: Vec<&str> = sources.iter().map(String::as_str).collect();
    let bench = folder.join("tof_top");
    let flags = ["--binary", "--timing", "--trace", "-Wno-fatal", "-Wno-lint", "-Mdir", "built"];
    let top = ["--top-module", "tb_tof_top"];
    run(&bench, "verilator", &[&flags[..], &QUICK_TO_COMPILE, &top, &sources].concat());
    run(&bench, "./built/Vtb_tof_top", &[]);
    compare(folder);
}
