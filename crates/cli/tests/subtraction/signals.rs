//! Tests of the firmware's signals in dark and lit frames.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

use tofsim::sim::frames::Frame;
use tofsim::sim::run::Observers;
use tofsim::sim::setup::Setup;
use tofsim::sim::shot_recorder::Shot;
use tofsim::sim::{Run, Stepping};

use crate::common::{empty, json, setup, stdout};

use super::{PAIRS, edge_us};

/// Instants at which each of the signals of a VCD rises or falls, with the new level; those of a name
/// in several modules once [ps].
fn changes(vcd: &str, names: &[&str]) -> BTreeMap<String, BTreeSet<(u64, bool)>> {
    let name_of = |line: &str| {
        let fields: Vec<_> = line.split(' ').collect();
        names.contains(fields.get(4)?).then(|| (fields[3].to_owned(), fields[4].to_owned()))
    };
    let vars = vcd.lines().filter(|line| line.starts_with("$var"));
    let names: BTreeMap<_, _> = vars.filter_map(name_of).collect();
    let mut changes: BTreeMap<_, BTreeSet<_>> = BTreeMap::new();
    let mut now = 0;
    for line in vcd.lines().skip_while(|line| !line.starts_with("$enddefinitions")) {
        if let Some(time) = line.strip_prefix('#') {
            now = time.parse().unwrap();
        } else if let Some(name) = line.get(1..).and_then(|code| names.get(code))
            && let Some(level) = ["0", "1"].iter().position(|&level| line.starts_with(level))
        {
            changes.entry(name.clone()).or_default().insert((now, level == 1));
        }
    }
    changes
}

#[test]
fn the_dark_frame_has_no_laser_edge_and_laser_en_changes_between_frames() {
    let folder = empty();
    let names =
        ["laser_en", "laser_en_sync", "laser_pulse", "laser_on", "start", "algo_done", "acquire"];
    let run = [
        "run",
        "--estimator",
        "subtraction",
        "--frames",
        "2",
        "-o",
        ".",
        "--window",
        "0us..26.04us",
    ];
    let mut args = [&run[..], &["-s", "firmware.shots_per_frame=80"]].concat();
    // Of the laser driver's port of that name, only the pin.
    let path = |name| if name == "laser_en" { "tof_top.laser_en" } else { name };
    names.iter().for_each(|name| args.extend(["--signals", path(name)]));
    stdout(folder.path(), &args);
    let vcd = fs::read_to_string(folder.path().join("kc705.vcd")).unwrap();
    let changes = changes(&vcd, &names);
    let rises = |name: &str| -> Vec<u64> {
        changes[name].iter().filter(|(_, level)| *level).map(|(at, _)| *at).collect()
    };
    let ends = rises("algo_done");
    assert_eq!(ends.len(), 4);
    let frame_of = |at: u64| ends.iter().position(|&end| at < end).unwrap();
    for (name, per_frame) in
        [("start", [40, 40, 40, 40]), ("laser_pulse", [0, 40, 0, 40]), ("laser_on", [0, 40, 0, 40])]
    {
        let mut found = [0; 4];
        rises(name).into_iter().for_each(|at| found[frame_of(at)] += 1);
        assert_eq!(found, per_frame, "{name}");
    }
    // The pin answers each depth 101 ns later, two edges before which the firmware sees it.
    let levels: Vec<_> = changes["laser_en"].iter().map(|(_, level)| *level).collect();
    assert_eq!(levels, [false, true, false, true]);
    for (end, (at, _)) in ends.iter().zip(changes["laser_en"].iter().skip(1)) {
        assert_eq!(at - end, 101_000);
    }
    let acquires = &changes["acquire"];
    for (at, _) in &changes["laser_en_sync"] {
        let before = acquires.iter().rfind(|(change, _)| change <= at);
        assert!(before.is_none_or(|(_, acquires)| !acquires), "no change while shots go on");
    }
}

#[test]
fn photons_of_a_dark_frame_are_ambient_or_no_photons_at_all() {
    let folder = empty();
    let keys = ["-s", "firmware.shots_per_frame=4000", "-s", "spad.dark_rate_hz=1e7"];
    for name in ["events.csv", "events.parquet"] {
        stdout(folder.path(), &[&PAIRS, &keys[..], &["--events", name]].concat());
    }
    let text = fs::read_to_string(folder.path().join("events.csv")).unwrap();
    assert!(text.lines().nth(1).unwrap().ends_with(",code,bin,laser_en"));
    let mut found: BTreeMap<(u64, &str), u64> = BTreeMap::new();
    for row in text.lines().skip(2) {
        let fields: Vec<_> = row.split(',').collect();
        let frame = fields[0].parse().unwrap();
        assert_eq!(fields[8], if frame == 1 { "1" } else { "0" }, "{row}");
        *found.entry((frame, fields[3])).or_default() += 1;
    }
    let of = |frame, cause| found.get(&(frame, cause)).copied().unwrap_or(0);
    assert_eq!(of(0, "signal"), 0);
    assert!(of(1, "signal") > 300, "{found:?}");
    for frame in [0, 1] {
        assert!(of(frame, "ambient") > 500 && of(frame, "dark") > 10, "{found:?}");
    }
    let run = json(folder.path(), &[&PAIRS, &keys[..], &["--json"]].concat());
    assert_eq!(run["frames"][0]["shots"], 2000);
    let file = fs::File::open(folder.path().join("events.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let rows = reader.get_row_iter(None).unwrap().map(|row| {
        let row = row.unwrap();
        let field =
            |name: &str| row.get_column_iter().find(|(known, _)| *known == name).unwrap().1.clone();
        (field("frame"), field("laser_en"))
    });
    let expected = (0..4000).map(|k| (Field::Long(k / 2000), Field::Bool(k >= 2000)));
    assert!(rows.eq(expected));
}

fn paired_frames(setup: &Setup, stepping: Option<Stepping>) -> Vec<Frame> {
    let mut frames = Vec::new();
    let mut take = |frame: &Frame| {
        frames.push(frame.clone());
        Ok(())
    };
    let mut see = |_: &Shot| Ok(());
    let watch = Observers { frames: Some(&mut take), ..Observers::default() };
    match stepping {
        None => Run::new(setup).observe(4, Observers { shots: Some(&mut see), ..watch }),
        Some(stepping) => Run::new(setup).stepping(stepping).observe(4, watch),
    }
    .unwrap();
    frames
}

#[test]
fn frames_alternate_however_a_run_is_stepped_and_an_abandoned_one_begins_again_as_it_was() {
    // 20 shots of 6 cycles: a frame takes 661 cycles to `algo_done`, and the next begins one later.
    let mut controls = vec!["[]".to_owned(), "[{at_us=8,laser_freq=1}]".to_owned()];
    for edge in [3, 100, 300, 661, 662, 663, 664, 670, 674, 675, 676, 700, 950] {
        let (on, off) = (edge_us(edge), edge_us(edge + 2));
        controls.push(format!("[{{at_us={on},dsp_rst=true}},{{at_us={off},dsp_rst=false}}]"));
        controls.push(format!("[{{at_us={on},rst=true}},{{at_us={off},rst=false}}]"));
    }
    for control in controls {
        let keys = [
            "firmware.dark_frames=true",
            "firmware.shots_per_frame=40",
            "target.distance_m=0.1",
            "target.reflectance=0.6",
            "ambient.irradiance_w_m2_nm=0",
            &format!("control={control}"),
        ];
        let setup = setup("kc705", &keys);
        let in_full = paired_frames(&setup, None);
        for stepping in [Stepping::EveryCycle, Stepping::SkipIdle, Stepping::LeapShots] {
            assert_eq!(paired_frames(&setup, Some(stepping)), in_full, "{stepping:?}, {control}");
        }
        for frame in &in_full {
            let lit = frame.index % 2 == 1;
            assert_eq!((frame.laser_en, frame.shots), (lit, 20), "{control}");
            // 39 photons a shot reach the detector from so near, and none without the laser.
            assert_eq!(frame.hits() > 15, lit, "{control}: {} hits", frame.hits());
        }
    }
}

#[test]
fn a_logic_analyser_sees_the_laser_of_lit_frames_only() {
    let folder = empty();
    let set_up = "clock = \"clk_laser\"\ndepth = 1024\nposition = 0\ntrigger = \"vcsel_driver.laser_pulse rising\"\n\
        [[probe]]\nsignal = \"vcsel_driver.laser_pulse\"\n[[probe]]\nsignal = \"laser_en\"\n";
    fs::write(folder.path().join("ila.toml"), set_up).unwrap();
    let keys = ["-s", "firmware.dark_frames=true", "-s", "firmware.shots_per_frame=80"];
    let args =
        ["ila", "capture", "kc705", "--probes", "ila.toml", "-o", "out", "--frames", "2", "--json"];
    let capture = json(folder.path(), &[&args[..], &keys].concat());
    // The dark frame: 256 of Clear, 40 shots of 6 cycles, Drain, the estimator, and Clear again.
    let first_us = capture["trigger_times_us"][0].as_f64().unwrap();
    let lit_us = edge_us(1 + 782 + 256 + 6);
    assert!((first_us - lit_us).abs() < 0.05, "{first_us} {lit_us}");
}
