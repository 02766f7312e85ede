//! `tofsim dpi` writes what a bench needs, or says why not.

use crate::common::{empty, refused, stdout};

#[test]
fn a_folder_has_all_that_a_bench_needs() {
    let folder = empty();
    stdout(folder.path(), &["dpi", "-s", "firmware.shots_per_frame=300", "-o", "dpi"]);
    let read = |name: &str| std::fs::read_to_string(folder.path().join("dpi").join(name)).unwrap();
    assert!(read("tofsim_pkg.sv").contains(r#"Scenario = "kc705\nfirmware.shots_per_frame=300";"#));
    assert!(read("tofsim_checkers.sv").contains("module tofsim_tof_top #("));
    assert!(read("tofsim_photons.sv").contains("module tofsim_photons"));
    let binds = read("tofsim_bind.sv");
    assert!(binds.contains("bind tdc tofsim_tdc #("), "{binds}");
    // The KC705 has another estimator, and no codes of its own.
    assert!(!binds.contains("bind centroid_estimator") && !binds.contains("bind code_preload"));
    assert!(read("tofsim.h").contains("int tofsim_step("));
    assert!(read("tofsim_vpi.v").contains("module tofsim_attach;"));
    assert!(read("tofsim_vpi.c").contains("vlog_startup_routines"));
    assert!(read("Makefile").contains("NOT TRIED"));
}

#[test]
fn a_scenario_of_a_file_is_found_from_anywhere() {
    let folder = empty();
    std::fs::write(folder.path().join("own.toml"), "[target]\ndistance_m = 0.3\n").unwrap();
    stdout(folder.path(), &["dpi", "own.toml", "-b", "spad_control", "-o", "dpi"]);
    let text = std::fs::read_to_string(folder.path().join("dpi/tofsim_pkg.sv")).unwrap();
    let path = folder.path().join("own.toml").canonicalize().unwrap();
    assert!(text.contains(&format!("Scenario = \"{}\";", path.display())), "{text}");
    // Vectors are as wide as the block.
    assert!(text.contains("input bit [2:0] inputs, input bit [40:0] outputs"), "{text}");
}

#[test]
fn what_cannot_be_checked_is_refused_by_name() {
    let folder = empty();
    let said = |args: &[&str]| refused(folder.path(), &[&["dpi", "-o", "dpi"], args].concat());
    let fault = said(&["-b", "tdk"]);
    assert!(fault.contains("block = tdk: no such block (`tdc`?)"), "{fault}");
    let fault = said(&["-b", "histogram_preload"]);
    assert!(fault.contains("stimulus.histogram is not set"), "{fault}");
    let fault = said(&["-s", "tdc.setup_window_ps=10"]);
    assert!(fault.contains("tdc.setup_window_ps = 10: expected 0"), "{fault}");
    let fault = said(&["nowhere"]);
    assert!(fault.contains("nowhere: no such file or built-in scenario"), "{fault}");
    assert!(!folder.path().join("dpi").exists());
}

#[test]
fn a_file_of_an_override_is_found_from_anywhere() {
    let folder = empty();
    std::fs::write(folder.path().join("ph.csv"), "shot,arrival_ps\n0,3000\n").unwrap();
    let scenario = |args: &[&str]| {
        stdout(folder.path(), &[&["dpi", "-b", "spad_control", "-o", "dpi"], args].concat());
        let text = std::fs::read_to_string(folder.path().join("dpi/tofsim_pkg.sv")).unwrap();
        let line = text.lines().find(|line| line.contains("Scenario = ")).unwrap();
        line.split_once(" = ").unwrap().1.to_owned()
    };
    let path = folder.path().join("ph.csv").canonicalize().unwrap();
    let expected = format!(r#""kc705\nstimulus.photons=\"{}\"";"#, path.display());
    assert_eq!(scenario(&["-s", "stimulus.photons=ph.csv"]), expected);
    assert_eq!(scenario(&["-s", "tdc.profile=ideal"]), r#""kc705\ntdc.profile=ideal";"#);
    // A scenario's own files are seen from its folder.
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    std::fs::write(folder.path().join("sub/own.toml"), "[target]\ndistance_m = 0.3\n").unwrap();
    std::fs::rename(path, folder.path().join("sub/ph.csv")).unwrap();
    let found = scenario(&["sub/own.toml", "-s", "stimulus.photons=ph.csv"]);
    assert!(found.ends_with(r#"sub/own.toml\nstimulus.photons=ph.csv";"#), "{found}");
}

#[test]
fn blocks_are_chosen_or_left_out_and_each_is_there_once() {
    let folder = empty();
    let bound = |args: &[&str]| {
        stdout(folder.path(), &[&["dpi", "-o", "dpi"], args].concat());
        let text = std::fs::read_to_string(folder.path().join("dpi/tofsim_bind.sv")).unwrap();
        text.lines().filter(|line| line.ends_with(") tofsim_checker (")).count()
    };
    let all = bound(&[]);
    assert_eq!(bound(&["--without", "pll", "--without", "tof_top"]), all - 2);
    assert_eq!(bound(&["-b", "tdc", "-b", "frame_ctrl", "-b", "tdc"]), 2);
    let fault = refused(folder.path(), &["dpi", "-o", "dpi", "--without", "pl"]);
    assert!(fault.contains("--without: pl: no such block (`pll`?)"), "{fault}");
    let fault = refused(folder.path(), &["dpi", "-o", "dpi", "a\nb=c"]);
    assert!(fault.contains("no such file"), "{fault}");
    std::fs::write(folder.path().join("a\nb.toml"), "").unwrap();
    let fault = refused(folder.path(), &["dpi", "-o", "dpi", "a\nb.toml"]);
    assert!(fault.contains("without line ends"), "{fault}");
}
