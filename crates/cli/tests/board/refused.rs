//! Boards and options that cannot be used.

use crate::common::{empty, files, refused};

use super::device::{Device, Faults, HeldFrame, Registers};
use super::{SET, board, healthy, is_off, registers, results, simulated};

#[test]
fn a_board_of_other_parameters_is_refused_with_both_sides_named() {
    let folder = empty();
    let device = healthy();
    for verb in ["run", "calibrate", "watch"] {
        let error = refused(folder.path(), &board(verb, &device, &[]));
        let hash = format!("{:#018x}", device.state().registers.parameters_hash);
        let expected = format!("tofsim: {}: parameters_hash = {hash}: expected 0x", device.port);
        let error = error.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(error.starts_with(&expected), "{verb}: {error}");
        assert!(error.contains("that of scenario kc705: name the scenario"), "{verb}: {error}");
    }
    assert_eq!(device.state().registers.lit, 0);
}

#[test]
fn an_unplugged_board_is_an_error_and_leaves_no_files() {
    let folder = empty();
    let path = folder.path();
    let faults = Faults { unplugged_after: Some(25), ..Faults::default() };
    let device = Device::on_terminal(registers(results(&simulated(path))), faults);
    let args = ["--laser", "--frames", "100", "-o", "out", "--csv", "--npy", "--parquet"];
    let error = refused(path, &board("run", &device, &[&args[..], &SET].concat()));
    assert!(error.contains(&format!("{}: ", device.port)), "{error}");
    assert!(error.contains("the connection is lost"), "{error}");
    assert_eq!(files(&path.join("out")), [""; 0]);
}

#[test]
fn a_laser_that_goes_off_in_a_run_is_an_error_with_its_reason() {
    let folder = empty();
    let path = folder.path();
    let frames = results(&simulated(path));
    let shut = Registers { interlock_open: true, ..registers(frames) };
    let device = Device::on_terminal(shut, Faults::default());
    let error = refused(path, &board("run", &device, &[&["--laser"], &SET[..]].concat()));
    assert!(error.contains("arm = 0: expected 1 after arming"), "{error}");
    assert!(error.contains("interlock"), "{error}");
    assert!(is_off(&device));
}

#[test]
fn devices_that_are_silent_or_others_are_named_with_register_and_expectation() {
    let folder = empty();
    let silent = Faults { silent: true, ..Faults::default() };
    let device = Device::on_terminal(registers(vec![HeldFrame::default()]), silent);
    let error = refused(folder.path(), &board("info", &device, &[]));
    assert!(error.contains("identity: no answer within 0.3 s, expected 24 bytes"), "{error}");
    let other = Registers { identity: 7, ..registers(vec![HeldFrame::default()]) };
    let device = Device::on_terminal(other, Faults::default());
    let error = refused(folder.path(), &board("set", &device, &["mode=1"]));
    assert!(error.contains("identity = 0x00000007: expected 0x746f6673"), "{error}");
    let error = refused(folder.path(), &["board", "info", "--port", "nowhere"]);
    assert!(error.contains("nowhere: cannot open it: No such file or directory"), "{error}");
}

#[test]
fn what_cannot_be_set_is_refused_before_the_board_is_opened() {
    let folder = empty();
    let set = |assignment: &str| {
        refused(folder.path(), &["board", "set", assignment, "--port", "nowhere"])
    };
    let unknown = set("laser_frequ=1");
    assert!(unknown.contains("board set: laser_frequ: unknown name (`laser_freq`?)"), "{unknown}");
    assert!(unknown.contains("expected one of laser_en, dsp_en,"), "{unknown}");
    assert!(set("depth=1").contains("board set: depth: read-only register; expected one of"));
    assert!(set("mode=2").contains("board set: mode = 2: expected a whole number from 0 to 1"));
    assert!(set("mode=x").contains("mode = x: expected a whole number"));
    assert!(set("mode").contains("board set: mode: expected KEY=VALUE"));
    let armed = set("arm=0x4c415352");
    assert!(armed.contains("arm = 1279349586: expected 0: the firmware disarms"), "{armed}");
}

#[test]
fn options_and_scenarios_that_no_board_can_have_are_refused() {
    let folder = empty();
    let run = |args: &[&str]| {
        refused(folder.path(), &[&["board", "run", "--port", "nowhere"], args].concat())
    };
    assert!(run(&["--csv"]).contains("--output"), "a format needs a folder");
    assert!(run(&["--frames", "0"]).contains("--frames"));
    assert!(run(&["--timeout", "0"]).contains("expected seconds, 0.01 to 86400"));
    assert!(run(&["--baud", "7"]).contains("--baud"));
    let pairs = run(&["-s", "firmware.dark_frames=true"]);
    assert!(pairs.contains("firmware.dark_frames = true: expected false: a board"), "{pairs}");
    let changes = run(&["-s", "control=[{at_us=1,mode=0}]"]);
    assert!(changes.contains("control = 1 changes: expected none"), "{changes}");
    let held = run(&["-s", "firmware.dsp_en=false"]);
    assert!(held.contains("firmware.dsp_en = false: expected true: no frame ends"), "{held}");
    let missing = refused(folder.path(), &["board", "run"]);
    assert!(missing.contains("--port"), "{missing}");
}
