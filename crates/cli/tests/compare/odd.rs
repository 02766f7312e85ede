//! Set-ups that are a little odd, whose captures have to be the same as their run all the same.

use crate::common;

use super::{csv, different, findings, refused, same, vcd, write};

const SHORT: &str = "firmware.shots_per_frame=60";

/// Captures by a set-up, and compares every form with the run and with each other.
fn round_trip(set_up: &str, scenario: &str) {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "odd.toml", set_up);
    let set = ["-s", SHORT];
    let capture = ["ila", "capture", scenario, "--probes", "odd.toml", "-o", "."];
    common::stdout(folder, &[&capture[..], &set].concat());
    for form in ["csv", "vcd", "ila"] {
        let file = format!("odd.{form}");
        for map in ["odd.toml", "odd.map.toml"] {
            let args = ["--scenario", scenario, &file, "--map", map];
            same(folder, &[&args[..], &set].concat());
        }
        same(folder, &["odd.csv", &file]);
        same(folder, &["odd.vcd", &file]);
    }
}

fn probes(signals: &[&str]) -> String {
    signals.iter().map(|signal| format!("[[probe]]\nsignal = \"{signal}\"\n")).collect()
}

#[test]
fn a_condition_has_the_sign_of_the_signal_however_it_is_shown() {
    let shown = "[[probe]]\nname = \"p\"\nsignal = \"frame_ctrl.clear_addr\"\nradix = \"signed\"\n";
    round_trip(&format!("trigger = \"p >= 0x80\"\nposition = 0\n{shown}"), "kc705");
    round_trip(&format!("trigger = \"p > 240\"\nposition = 0\n{shown}"), "kc705");
    let sum = probes(&["depth_estimator.tansig.l1_in_5"]);
    let negative =
        "trigger = \"depth_estimator.tansig.l1_in_5 < 0\"\nposition = 0\narm_at_us = 1.6\n";
    round_trip(&format!("{negative}{sum}"), "estimator_validation");
    let other = probes(&["locked"]);
    round_trip(&format!("{negative}{other}"), "estimator_validation");
}

#[test]
fn a_trigger_may_be_a_slice_or_a_net_of_the_top() {
    let slice = "[[probe]]\nname = \"p\"\nsignal = \"frame_ctrl.shots[3:0]\"\n";
    round_trip(&format!("trigger = \"p changed && p != 0\"\n{slice}"), "kc705");
    let one = "[[probe]]\nname = \"p\"\nsignal = \"frame_ctrl.shots[1:1]\"\n";
    round_trip(&format!("trigger = \"p rising\"\n{one}"), "kc705");
    round_trip(&format!("trigger = \"laser_on || start\"\n{}", probes(&["start"])), "kc705");
}

#[test]
fn without_a_trigger_any_sample_triggers() {
    round_trip(&probes(&["frame_ctrl.clear_addr", "locked"]), "kc705");
}

#[test]
fn probes_may_differ_by_their_ranges_alone() {
    let slices =
        ["frame_ctrl.clear_addr[3:0]", "frame_ctrl.clear_addr[7:4]", "frame_ctrl.shots[0]"];
    let trigger = "position = 16\ntrigger = \"frame_ctrl.clear_addr == 0x80\"\n";
    round_trip(&format!("{trigger}{}", probes(&slices)), "kc705");
    let whole = ["frame_ctrl.clear_addr[3:0]", "frame_ctrl.clear_addr", "frame_ctrl.shots[0:0]"];
    round_trip(&format!("{trigger}{}", probes(&whole)), "kc705");
    round_trip(&format!("{trigger}{}", probes(&["tof_top.vcsel_driver.count"])), "kc705");
}

#[test]
fn a_capture_may_begin_before_its_input_stages_are_filled() {
    for (stages, position) in [(1, 8), (6, 8), (6, 2), (3, 0)] {
        let keys = format!("input_stages = {stages}\nposition = {position}\n");
        let signals = probes(&["locked", "frame_ctrl.clear_addr", "vcsel_driver.count"]);
        round_trip(&format!("{keys}trigger = \"rst == 0\"\n{signals}"), "kc705");
        let qualified = "trigger = \"locked\"\ncapture = \"frame_ctrl.clear_addr[0] == 0\"\n";
        round_trip(&format!("{keys}{qualified}{signals}"), "kc705");
    }
}

#[test]
fn a_free_clock_may_begin_at_power_up() {
    let keys = "clock = \"100MHz\"\ntrigger = \"rst == 0\"\nposition = 0\n";
    round_trip(&format!("{keys}{}", probes(&["rst", "locked", "frame_ctrl.clear_addr"])), "kc705");
}

#[test]
fn a_file_that_is_compared_is_not_written_over() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &vcd("1ns", "top", &[(1, "x")], "#0\n0a\n#5\n1a\n"));
    for output in [["--waves", "./a.vcd"], ["--junit", "a.vcd"]] {
        let error = refused(folder, &[&["a.vcd", "a.vcd"], &output[..]].concat());
        assert!(error.contains("expected another file"), "{error}");
    }
    same(folder, &["a.vcd", "a.vcd"]);
}

#[test]
fn a_pair_that_is_compared_nowhere_is_not_the_same() {
    let folder = common::empty();
    let folder = folder.path();
    let rows: Vec<_> = (0..20).map(|k| format!("{},{k:02x}", k % 2)).collect();
    write(folder, "a.csv", &csv("x,n[7:0]", "HEX,HEX", 0, &rows));
    let json = different(folder, &["a.csv", "a.csv", "--latency", "n=500"]);
    assert!(json["differences"].to_string().contains("n: no sample has both sides"), "{json:#}");
    let error = refused(folder, &["a.csv", "a.csv", "--latency", "n=99999999999"]);
    assert!(error.contains("expected 65536 samples at most"), "{error}");
    let error = refused(folder, &["a.csv", "a.csv", "--until", "5ns"]);
    assert!(error.contains("captures have no times"), "{error}");
    write(folder, "never.csv", &csv("x,n[7:0]", "HEX,HEX", 0, &["0,01".into(), "0,02".into()]));
    let json = same(folder, &["never.csv", "never.csv", "--valid", "n=x"]);
    assert!(json["notes"].to_string().contains("it is never valid"), "{json:#}");
}

#[test]
fn options_choose_among_the_map_s_signals_too() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.csv", &csv("x,y", "HEX,HEX", 0, &["0,0".into(), "1,1".into()]));
    write(folder, "b.csv", &csv("x_1,y_1", "HEX,HEX", 0, &["0,1".into(), "1,1".into()]));
    let map = "[[signal]]\na = [\"x\"]\nb = [\"x_1\"]\n[[signal]]\na = [\"y\"]\nb = [\"y_1\"]\n";
    write(folder, "map.toml", map);
    let args = ["a.csv", "b.csv", "--map", "map.toml"];
    different(folder, &args);
    same(folder, &[&args[..], &["--signals", "x"]].concat());
    same(folder, &[&args[..], &["--ignore", "y_1"]].concat());
}

#[test]
fn a_side_without_a_trigger_s_mark_is_different() {
    let folder = common::empty();
    let folder = folder.path();
    let rows = ["0".to_owned(), "1".to_owned(), "0".to_owned()];
    write(folder, "a.csv", &csv("x", "HEX", 1, &rows));
    write(folder, "b.csv", &csv("x", "HEX", 9, &rows));
    let json = different(folder, &["a.csv", "b.csv"]);
    let text = json["differences"].to_string();
    assert!(text.contains("trigger at sample 1 of the first, none of the second"), "{text}");
}

#[test]
fn a_vcd_cut_off_in_a_time_stamp_is_refused() {
    let folder = common::empty();
    let folder = folder.path();
    let whole = vcd("1ns", "top", &[(1, "x")], "#0\n0a\n#500\n1a\n#1000\n0a\n#20");
    write(folder, "a.vcd", &whole);
    let error = refused(folder, &["a.vcd", "a.vcd"]);
    assert!(error.contains("a.vcd:12:1: time goes back from 1000 to 20"), "{error}");
    write(folder, "b.vcd", &whole.replace("#20", "#x"));
    let error = refused(folder, &["b.vcd", "b.vcd"]);
    assert!(error.contains("expected a time behind #"), "{error}");
}

#[test]
fn one_wrong_value_among_changes_is_named_too() {
    let folder = common::empty();
    let folder = folder.path();
    let wave = |value: u8| {
        vcd("1ns", "top", &[(4, "n")], &format!("#0\nb1 a\n#5\nb{value:b} a\n#9\nb0 a\n"))
    };
    write(folder, "a.vcd", &wave(6));
    write(folder, "b.vcd", &wave(7));
    let json = different(folder, &["a.vcd", "b.vcd"]);
    assert_eq!(findings(&json), ["flipped bit"]);
}

#[test]
fn only_valid_places_are_counted() {
    let folder = common::empty();
    let folder = folder.path();
    let wave = |n: u8| {
        let body = format!("#0\n0a\nb1 b\n#5\nb{n:b} b\n#9\n1a\nb10 b\n#12\nb11 b\n");
        vcd("1ns", "top", &[(1, "ok"), (4, "n")], &body)
    };
    write(folder, "a.vcd", &wave(6));
    write(folder, "b.vcd", &wave(7));
    different(folder, &["a.vcd", "b.vcd"]);
    let json = same(folder, &["a.vcd", "b.vcd", "--valid", "n=ok"]);
    let compared = json["signals"].as_array().unwrap().iter().find(|s| s["name"] == "top.n");
    assert_eq!(compared.unwrap()["compared"], 2);
}

#[test]
fn text_beside_numbers_does_not_keep_a_file_from_being_read() {
    let folder = common::empty();
    let folder = folder.path();
    let rows = ["\"_\",0".to_owned(), "\"Active\",1".to_owned()];
    write(folder, "a.csv", &csv("axi,x", "HEX,HEX", 0, &rows));
    let info = common::json(folder, &["ila", "info", "a.csv", "--json"]);
    assert_eq!((&info["samples"], &info["probes"][0]["text"]), (&2.into(), &true.into()));
    same(folder, &["a.csv", "a.csv", "--ignore", "axi"]);
}

#[test]
fn what_cannot_be_meant_is_refused_by_its_option() {
    let folder = common::empty();
    let folder = folder.path();
    write(folder, "a.vcd", &vcd("1ns", "top", &[(1, "x")], "#0\n0a\n#5\n1a\n"));
    let error = |more: &[&str]| refused(folder, &[&["a.vcd", "a.vcd"], more].concat());
    assert!(error(&["--clock", "0MHz"]).contains("a frequency from 1 kHz"));
    assert!(error(&["--map", "nosuch"]).starts_with("tofsim: --map: nosuch"));
    assert!(error(&["--tolerance", "x=-1"]).contains("whole number from 0"));
    write(folder, "map.toml", "[[signal]]\na = [\"x\"]\ndont_care = \"0x4\"\n");
    assert!(error(&["--map", "map.toml"]).contains("dont_care = 0x4: expected 1 bits at most"));
}
