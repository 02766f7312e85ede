//! The scripts that make a board's bitstream: they name what is there, and stop at a clock that is too slow.

use std::fs;
use std::process::{Command, Output};

use crate::common;
use crate::record::Inputs;

use super::{root, sound};

/// Runs the script for Vivado with commands that stand for Vivado's, those variables, and a routed design of those slacks
/// for setup and hold [ns].
fn vivado(setup_ns: f64, hold_ns: f64, variables: &[(&str, &str)]) -> (bool, String) {
    let folder = tempfile::tempdir().unwrap();
    let mut yosys = Command::new("yosys");
    yosys.current_dir(folder.path()).arg("-c");
    yosys.arg(root().join("crates/rtl/tests/board/vivado.tcl"));
    yosys.env("SCRIPT", root().join("rtl_ref/kc705.tcl"));
    yosys
        .env("OUT", folder.path().join("out"))
        .env("ILA", "")
        .env("SLACK", format!("max {setup_ns} min {hold_ns}"))
        .envs(variables.iter().copied());
    let Output { status, stdout, stderr } = yosys.output().expect("yosys: apt-get install yosys");
    let said = [stdout, stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    (status.success(), said.concat())
}

/// Commands that a Makefile would run.
fn make(name: &str, set: &[&str]) -> String {
    let mut make = Command::new("make");
    make.current_dir(root()).args(["-n", "-B", "-f"]).arg(format!("rtl_ref/{name}"));
    let done = make.args(set).output().expect("make: apt-get install make");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).unwrap()
}

#[test]
fn the_script_for_vivado_reads_all_and_writes_a_bitstream() {
    sound::passes("script for Vivado", &sources(), || {
        let (is_done, said) = vivado(0.012, 0.05, &[]);
        assert!(is_done, "{said}");
        let order = [
            "kc705.xdc",
            "synth_design -top kc705_top -part xc7k325tffg900-2",
            "kc705_chain.tcl",
            "route_design",
            "report_timing_summary",
            "write_bitstream -force",
        ];
        let places = order.map(|text| said.find(text));
        assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{places:?}: {said}");
    });
}

/// All that Yosys reads for it.
fn sources() -> Inputs {
    let inputs = Inputs::default()
        .version("yosys", "-V")
        .rust("checks", include_str!("scripts.rs"))
        .text("vivado.tcl", include_str!("vivado.tcl"));
    let rtl = root().join("rtl_ref");
    common::files(&rtl).iter().fold(inputs, |inputs, name| {
        let bytes = fs::read(rtl.join(name)).unwrap();
        if name.ends_with(".v") {
            inputs.verilog(name, &String::from_utf8(bytes).unwrap())
        } else {
            inputs.text(name, bytes)
        }
    })
}

#[test]
fn a_design_that_is_too_slow_or_too_fast_has_no_bitstream() {
    for (setup_ns, hold_ns) in [(-0.001, 0.05), (0.012, -0.001)] {
        let (is_done, said) = vivado(setup_ns, hold_ns, &[("UNREAD", "")]);
        assert!(!is_done && said.contains("does not meet its timing"), "{said}");
        assert!(!said.contains("write_bitstream"), "{said}");
    }
}

#[test]
fn the_makefiles_read_every_source() {
    let all = [
        make("ecp5.mk", &[]),
        make("kc705_openxc7.mk", &["CHIPDB=xc7k325t.bin", "PRJXRAY_DB=prjxray-db"]),
    ];
    let sources = common::files(&root().join("rtl_ref"));
    for commands in &all {
        for source in sources.iter().filter(|name| name.ends_with(".v")) {
            assert!(commands.contains(&format!(" rtl_ref/{source}")), "{source}: {commands}");
        }
    }
    let [ecp5, kc705] = all;
    assert!(ecp5.contains("--lpf rtl_ref/ecp5.lpf"), "{ecp5}");
    assert!(kc705.contains("--xdc rtl_ref/kc705.xdc"), "{kc705}");
}
