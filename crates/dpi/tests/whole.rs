//! The whole reference design with photons and all checkers, as docs/bench.md has it.

use tofsim::{Run, Setup};

use super::common::{compile, design, root, run, write};

const SHOTS: &[&str] = &["firmware.shots_per_frame=300"];

/// Its frames as the bench prints them.
fn frames(count: u64) -> String {
    let setup = Setup::load("kc705", SHOTS).unwrap();
    let frames = Run::new(&setup).frames(count).unwrap();
    frames
        .iter()
        .map(|frame| format!("frame {}: depth {}\n", frame.index, frame.depth.get()))
        .collect()
}

#[test]
#[ignore = "long: ./check --full"]
fn frames_of_the_reference_are_those_of_a_run_and_no_checker_objects() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), ("kc705", SHOTS), None);
    let files = [design(), vec![root().join("examples/bench/tb.sv")]].concat();
    let program = compile(folder.path(), "tb", &files, &["-GFrames=2"]);
    let run = run(&program, &root(), &["+tofsim_from_power_up"]);
    assert!(run.is_fine, "{}", run.text);
    let printed: String = run
        .text
        .lines()
        .filter(|line| line.starts_with("frame "))
        .map(|line| format!("{line}\n"))
        .collect();
    assert_eq!(printed, frames(2), "{}", run.text);
}
