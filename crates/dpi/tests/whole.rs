//! Tests of the complete reference design with photons and all checkers, as in docs/bench.md.

use std::path::{Path, PathBuf};

use tofsim::Setup;

use super::common::{Run, compile, design, make, root, run, write};

const SHOTS: &[&str] = &["firmware.shots_per_frame=300"];

/// Returns the frames as the bench prints them.
fn frames(count: u64) -> String {
    let setup = Setup::load("kc705", SHOTS).unwrap();
    let frames = tofsim::Run::new(&setup).frames(count).unwrap();
    frames
        .iter()
        .map(|frame| format!("frame {}: depth {}\n", frame.index, frame.depth().to_bits()))
        .collect()
}

/// Returns the frames in a simulation's output.
fn printed(run: &Run) -> String {
    let lines = run.text.lines().filter(|line| line.starts_with("frame "));
    lines.map(|line| format!("{line}\n")).collect()
}

/// Returns the design with a fault in its frame controller: it leaves Clear one word too early.
fn faulty(folder: &Path) -> Vec<PathBuf> {
    let fault = ["(!(&clear_addr))", "(!(&clear_addr[BinBits-1:1]))"];
    with_fault(folder, "frame_ctrl.v", fault)
}

/// Returns the design with a text of one file replaced.
fn with_fault(folder: &Path, name: &str, [old, new]: [&str; 2]) -> Vec<PathBuf> {
    let mut files = design();
    files.retain(|path| !path.ends_with(name));
    let text = std::fs::read_to_string(root().join("rtl_ref").join(name)).unwrap();
    assert_eq!(text.matches(old).count(), 1);
    std::fs::write(folder.join(name), text.replace(old, new)).unwrap();
    files.push(folder.join(name));
    files
}

/// Returns the design with a module under another name, to which no checker is bound.
fn renamed(folder: &Path) -> Vec<PathBuf> {
    let [own, top] =
        [["module spad_control", "module other"], ["    spad_control #(", "    other #("]];
    let other = with_fault(folder, "spad_control.v", own);
    let top = with_fault(folder, "tof_top.v", top);
    let both =
        |path: &PathBuf| !["spad_control.v", "tof_top.v"].iter().any(|name| path.ends_with(name));
    let changed = [&other, &top].into_iter().flatten().filter(|path| path.starts_with(folder));
    design().into_iter().filter(both).chain(changed.cloned()).collect()
}

const MISMATCH: &str = "frame_ctrl: cycle ";

#[test]
#[ignore = "long: ./check --full"]
fn frames_of_the_reference_are_those_of_a_run_and_no_checker_objects() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), ("kc705", SHOTS), None);
    let files = [design(), vec![root().join("examples/bench/tb.sv")]].concat();
    let program = compile(folder.path(), "tb", &files, &["-GFrames=2"]);
    let run = run(&program, &root(), &["+tofsim_from_power_up"]);
    assert!(run.is_fine, "{}", run.text);
    assert_eq!(printed(&run), frames(2), "{}", run.text);
}

#[test]
#[ignore = "long: ./check --full"]
fn the_makefile_builds_and_a_fault_stops_it() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), ("kc705", SHOTS), Some(&["frame_ctrl", "tof_top"]));
    let run = make(folder.path(), "verilator", &faulty(folder.path()), "");
    assert!(!run.is_fine && run.text.contains(MISMATCH), "{}", run.text);
    assert!(run.text.contains("frame_ctrl is not as the model has it"), "{}", run.text);
    assert_eq!(printed(&run), "");
}

#[test]
#[ignore = "long: ./check --full"]
fn a_checker_that_is_bound_to_nothing_fails_the_run() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), ("kc705", SHOTS), Some(&["frame_ctrl", "spad_control"]));
    let run = make(folder.path(), "verilator", &renamed(folder.path()), "");
    assert_eq!(printed(&run), frames(1), "{}", run.text);
    assert!(
        !run.is_fine && run.text.contains("tofsim: spad_control: never compared: no such module"),
        "{}",
        run.text
    );
    assert!(run.text.contains("tofsim: frame_ctrl: compared "), "{}", run.text);
    assert!(run.text.contains("tofsim: 1 of 2 checkers compared nothing"), "{}", run.text);
}

#[test]
fn icarus_has_the_same_over_vpi() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), ("kc705", SHOTS), None);
    let run = make(folder.path(), "icarus", &design(), "+tofsim_from_power_up");
    assert!(run.is_fine, "{}", run.text);
    assert_eq!(printed(&run), frames(1), "{}", run.text);
    let compared = run.text.lines().filter(|line| line.contains(": compared ")).count();
    assert_eq!(compared, 20, "{}", run.text);
    let run = make(folder.path(), "icarus", &faulty(folder.path()), "");
    assert!(!run.is_fine && run.text.contains(MISMATCH), "{}", run.text);
    // What is unknown is not 0.
    let unknown = ["spad_sel <= spad_sel_next;", "spad_sel <= {39'bx, 1'b1};"];
    let unknown = with_fault(folder.path(), "spad_control.v", unknown);
    let run = make(folder.path(), "icarus", &unknown, "");
    let said = "spad_sel: expected 0000000001, got xxxxxxxxxx";
    assert!(!run.is_fine && run.text.contains(said), "{}", run.text);
    // Without a reset nothing is compared.
    let reset = ") spad_control (\n        .clk_sys(clk_sys),\n        .rst(";
    let [wired, open] = ["rst_sys)", "1'b0)"].map(|rst| [reset, rst].concat());
    let never = with_fault(folder.path(), "tof_top.v", [&wired, &open]);
    let run = make(folder.path(), "icarus", &never, "");
    assert!(
        !run.is_fine && run.text.contains("tofsim: spad_control: never compared"),
        "{}",
        run.text
    );
    assert!(run.text.contains("tofsim: 1 of 20 checkers compared nothing"), "{}", run.text);
    write(folder.path(), ("long", SHOTS), Some(&["frame_ctrl"]));
    let run = make(folder.path(), "icarus", &design(), "");
    let said = "frame_ctrl.clear_addr: the design has 8 bits, the scenario 10";
    assert!(!run.is_fine && run.text.contains(said), "{}", run.text);
}
