//! `tofsim ila replay`: what a capture shows, simulated and compared with it.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common;

/// Probes of a capture that shows a whole frame and what comes of it.
const PROBES: [&str; 10] = [
    "vcsel_driver.start",
    "tdc.tdc_valid",
    "tdc.tdc_code",
    "frame_ctrl.shots",
    "frame_ctrl.acquire",
    "hist_valid",
    "hist_bin",
    "hist_count",
    "depth",
    "algo_done",
];

fn set_up(folder: &Path, head: &str, probes: &[&str]) {
    let probes = probes.iter().map(|probe| format!("[[probe]]\nsignal = \"{probe}\"\n"));
    let text = format!("description = \"A frame\"\nscenario = \"kc705\"\nframes = 3\n{head}\n");
    fs::write(folder.join("probes.toml"), text + &probes.collect::<String>()).unwrap();
}

/// Captures a frame of 300 shots with that set-up.
fn capture(folder: &Path, head: &str, probes: &[&str], set: &[&str]) {
    set_up(folder, head, probes);
    let sets = set.iter().flat_map(|set| ["-s", set]);
    let args = ["ila", "capture", "--probes", "probes.toml", "-o", "."];
    let shots = ["-s", "firmware.shots_per_frame=300"];
    common::stdout(
        folder,
        &[&args[..], &shots].concat().into_iter().chain(sets).collect::<Vec<_>>(),
    );
}

/// Replays a capture, and compares the two by the map and by the command that the replay prints.
#[track_caller]
fn replayed(folder: &Path, file: &str, options: &[&str]) -> Value {
    let map = ["--map", "probes.map.toml"];
    let args = [&["ila", "replay", file, "-o", "again/run.toml", "--json"], &map[..], options];
    let json = common::json(folder, &args.concat());
    let next = json["next"].as_str().unwrap().replace("'", "");
    let (next, align) = next.split_once(" --align ").unwrap_or((&next, ""));
    let next: Vec<&str> = next.split(' ').skip(1).collect();
    let align = if align.is_empty() { vec![] } else { vec!["--align", align] };
    for how in [&[][..], &align] {
        let output = common::output(folder, &[&next[..], how].concat());
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success() && text.ends_with("same\n"), "{how:?} {text}");
    }
    json
}

#[test]
fn a_frame_of_300_shots_is_the_same_again_in_every_format() {
    let folder = common::empty();
    let folder = folder.path();
    capture(folder, "depth = 4096", &PROBES, &[]);
    for format in ["csv", "vcd", "ila"] {
        let json = replayed(folder, &format!("probes.{format}"), &[]);
        assert_eq!(json["kind"], "photons");
        assert_eq!(json["shots_per_frame"], 300);
        assert!(json["entries"].as_u64().unwrap() > 400, "{json:#}");
    }
    let list = fs::read_to_string(folder.join("again/run.photons.csv")).unwrap();
    assert!(list.starts_with("# tofsim-record {"), "{list}");
    // A photon elsewhere is seen.
    fs::write(folder.join("again/run.photons.csv"), list.replacen("\n7,", "\n7,1", 1)).unwrap();
    let args =
        ["compare", "--scenario", "again/run.toml", "probes.csv", "--map", "probes.map.toml"];
    assert_eq!(common::output(folder, &args).status.code(), Some(1));
}

#[test]
fn a_part_of_a_frame_at_any_clock_and_with_a_capture_condition_is_the_same_again() {
    let mid = "depth = 1024\nposition = 16\ntrigger = \"start rising && frame_ctrl.shots == 100\"";
    let basic = "depth = 1024\nposition = 0\ntrigger = \"start\"\n\
        capture = \"start || tdc_valid || hist_valid\"";
    for (head, probes) in [
        (mid, &PROBES[..]),
        ("clock = \"clk_laser\"\ndepth = 8192", &PROBES),
        (basic, &PROBES),
        ("depth = 4096\nposition = 16\ntrigger = \"start rising\"", &PROBES[..3]),
    ] {
        let folder = common::empty();
        capture(folder.path(), head, probes, &[]);
        replayed(folder.path(), "probes.csv", &[]);
    }
}

#[test]
fn hits_without_a_code_are_placed_by_the_detector_s_output() {
    let folder = common::empty();
    let folder = folder.path();
    let head = "depth = 1024\nposition = 16\ntrigger = \"start rising && frame_ctrl.shots == 100\"";
    let probes = [&PROBES[..], &["tdc_stop"]].concat();
    capture(folder, head, &probes, &[]);
    let json = replayed(folder, "probes.ila", &[]);
    let text = json["notes"].to_string();
    assert!(text.contains("photons are placed by tdc_stop alone, to 4 ns"), "{text}");
}

#[test]
fn control_signals_change_when_they_did() {
    let folder = common::empty();
    let folder = folder.path();
    let control = "control=[{at_us=8.003,laser_freq=1},{at_us=12.5,mode=1},{at_us=20.003,laser_freq=3},\
        {at_us=24.003,dsp_rst=true},{at_us=24.5,dsp_rst=false}]";
    let pins = ["laser_freq", "mode", "dsp_rst_sync", "spad_rst"];
    let probes = [&PROBES[..5], &pins].concat();
    capture(
        folder,
        "depth = 8192",
        &probes,
        &[control, "target.reflectance=0", "ambient.irradiance_w_m2_nm=0", "spad.dark_rate_hz=0"],
    );
    let json = replayed(folder, "probes.ila", &[]);
    assert_eq!(json["control_changes"], 5);
    let text = fs::read_to_string(folder.join("again/run.toml")).unwrap();
    assert_eq!(text.matches("[[control]]").count(), 5, "{text}");
}

#[test]
fn a_list_of_codes_is_the_same_again() {
    let folder = common::empty();
    let folder = folder.path();
    common::stdout(folder, &["ila", "capture", "--probes", "fig_6_12", "-o", "."]);
    fs::rename(folder.join("fig_6_12.map.toml"), folder.join("probes.map.toml")).unwrap();
    let json = replayed(folder, "fig_6_12.csv", &[]);
    assert_eq!((&json["kind"], &json["entries"]), (&"codes".into(), &168.into()));
}

#[test]
fn the_estimator_reads_the_same_histogram_again() {
    let folder = common::empty();
    let folder = folder.path();
    let head = "depth = 1024\nposition = 16\ntrigger = \"FORWARD1_EN rising\"".to_owned();
    set_up(
        folder,
        &head.replace("FORWARD1_EN", "hist_valid"),
        &["hist_valid", "hist_bin", "hist_count", "depth"],
    );
    common::stdout(
        folder,
        &["ila", "capture", "estimator_validation", "--probes", "probes.toml", "-o", "."],
    );
    assert_eq!(replayed(folder, "probes.csv", &[])["kind"], "histogram");
}

#[test]
fn sums_of_the_hidden_layer_give_the_histogram_back() {
    let folder = common::empty();
    let folder = folder.path();
    common::stdout(folder, &["ila", "capture", "--probes", "fig_6_21", "-o", "."]);
    fs::rename(folder.join("fig_6_21.map.toml"), folder.join("probes.map.toml")).unwrap();
    assert_eq!(replayed(folder, "fig_6_21.ila", &[])["kind"], "histogram");
    let rows = |text: &str| -> Vec<String> {
        text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect()
    };
    let list = fs::read_to_string(folder.join("again/run.histogram.csv")).unwrap();
    let own = include_str!("../../../stimuli/histograms/kc705.csv");
    assert_eq!(rows(&list), rows(own));
    let other = ["-s", "estimator.network=ideal", "--map", "fig_6_21", "-o", "other/run.toml"];
    let args = [&["ila", "replay", "fig_6_21.ila"], &other[..]].concat();
    let error = common::refused(folder, &args);
    assert!(error.contains("are not of the scenario's network; set estimator.network"), "{error}");
}

#[test]
fn several_windows_are_the_same_again() {
    let folder = common::empty();
    let folder = folder.path();
    let head = "depth = 1024\nwindows = 4\nposition = 16\n\
        trigger = \"start rising && frame_ctrl.shots == 50\"";
    set_up(folder, head, &PROBES[..5]);
    let text = fs::read_to_string(folder.join("probes.toml")).unwrap();
    fs::write(folder.join("probes.toml"), text.replace("frames = 3", "frames = 9")).unwrap();
    let shots = ["-s", "firmware.shots_per_frame=300"];
    let args = ["ila", "capture", "--probes", "probes.toml", "-o", "."];
    common::stdout(folder, &[&args[..], &shots].concat());
    let json = replayed(folder, "probes.csv", &shots);
    assert_eq!((&json["offset"], &json["shots_per_frame"]), (&Value::Null, &Value::Null));
}

#[test]
fn what_is_missing_is_said() {
    let folder = common::empty();
    let folder = folder.path();
    let replay = |file: &str, options: &[&str]| {
        common::refused(
            folder,
            &[&["ila", "replay", file, "-o", "again/run.toml"], options].concat(),
        )
    };
    common::stdout(folder, &["ila", "capture", "--probes", "fig_6_13", "-o", "."]);
    let error = replay("fig_6_13.ila", &["--map", "fig_6_13"]);
    assert!(error.contains("probe tdc.tdc_valid and tdc.tdc_code, or tdc_stop"), "{error}");
    capture(
        folder,
        "depth = 1024\nwindows = 4\nposition = 16\ntrigger = \"start rising\"",
        &PROBES[..3],
        &[],
    );
    let map = ["--map", "probes.map.toml"];
    let error = replay("probes.csv", &map);
    assert!(error.contains("probe frame_ctrl.shots"), "{error}");
    let error = replay("probes.csv", &[&map[..], &["--clock", "100MHz"]].concat());
    assert!(error.contains("expected clk_sys or clk_laser"), "{error}");
    capture(folder, "depth = 1024", &PROBES[1..3], &[]);
    let error = replay("probes.csv", &map);
    assert!(error.contains("probe vcsel_driver.start"), "{error}");
    capture(folder, "depth = 1024", &PROBES[5..8], &[]);
    let error = replay("probes.csv", &map);
    assert!(error.contains("256 of 256 words of the histogram are never read"), "{error}");
    fs::write(
        folder.join("wave.vcd"),
        "$timescale 1ns $end\n$var wire 1 ! a $end\n$enddefinitions $end\n#0\n0!\n",
    )
    .unwrap();
    let error = replay("wave.vcd", &[]);
    assert!(error.contains("expected a capture of a logic analyser"), "{error}");
    let error = common::refused(folder, &["ila", "replay", "probes.csv", "-o", "run"]);
    assert!(error.contains("expected a scenario file"), "{error}");
    assert!(!folder.join("again").exists());
}

#[test]
fn the_next_command_names_the_clock_that_the_map_does_not_have() {
    let files = ["c09_replay.csv", "c09_map_without_clock.toml"];
    let folder = common::cases(&files);
    let folder = folder.path();
    let args = ["--map", files[1], "--scenario", "histogram_validation", "-o", "again/run.toml"];
    let json = common::json(folder, &[&["ila", "replay", files[0], "--json"], &args[..]].concat());
    let next = json["next"].as_str().unwrap();
    assert!(next.contains(" --clock clk_sys"), "{next}");
    let (next, offset) = next.split_once(" --align '").unwrap();
    let align = ["--align", offset.trim_end_matches('\'')];
    let words: Vec<&str> = next.split(' ').skip(1).chain(align).collect();
    let output = common::output(folder, &words);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
}

#[test]
fn the_next_command_aligns_a_map_without_a_trigger() {
    let folder = common::empty();
    let folder = folder.path();
    let capture = ["ila", "capture", "estimator_validation", "--probes", "fig_6_21", "-o", "."];
    common::stdout(folder, &capture);
    let map = fs::read_to_string(folder.join("fig_6_21.map.toml")).unwrap();
    let lines = map.lines().filter(|line| !line.starts_with("trigger"));
    fs::write(folder.join("map.toml"), lines.collect::<Vec<_>>().join("\n")).unwrap();
    let replay = ["ila", "replay", "fig_6_21.csv", "--map", "map.toml", "-o", "again/run.toml"];
    let scenario = ["--scenario", "estimator_validation", "--json"];
    let json = common::json(folder, &[&replay[..], &scenario].concat());
    let next: Vec<&str> = json["next"].as_str().unwrap().split(' ').skip(1).collect();
    let output = common::output(folder, &next);
    assert_eq!(output.status.code(), Some(0), "{next:?} {output:?}");
}

#[test]
fn a_damaged_archive_is_noted_as_by_the_other_verbs() {
    let folder = common::empty();
    let folder = folder.path();
    capture(folder, "depth = 4096", &PROBES, &[]);
    let mut bytes = fs::read(folder.join("probes.ila")).unwrap();
    let name = b"waveform.dmp";
    let place = bytes.windows(name.len()).position(|window| window == name).unwrap();
    bytes[place + 80] ^= 1;
    fs::write(folder.join("damaged.ila"), bytes).unwrap();
    let note = "waveform.dmp is not used";
    let replay = ["ila", "replay", "damaged.ila", "--map", "probes.map.toml", "-o", "a/run.toml"];
    for args in [&["ila", "info", "damaged.ila"][..], &replay] {
        let json = common::json(folder, &[args, &["--json"]].concat());
        assert!(json["notes"].to_string().contains(note), "{args:?} {json:#}");
    }
}
