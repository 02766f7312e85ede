//! The acquisition computer at work in mid-run, and photons where they are awkward.

use std::fs;

use crate::common::{frames, json, setup, stdout};

/// Shots of a frame in these tests; at 6 cycles a shot it takes 541 + 600 cycles.
const SHOTS: &str = "firmware.shots_per_frame=100";

/// The frames of kc705 with short frames and a control timeline.
fn with_control(control: &str, more: &[&str], count: u64) -> Vec<tofsim::sim::frames::Frame> {
    let control = format!("control={control}");
    frames(&setup("kc705", &[&[SHOTS, control.as_str()], more].concat()), count)
}

/// Instant of an edge of `clk_sys` [us].
fn edge_us(edge: u64) -> f64 {
    1.008 + 0.008 * edge as f64
}

#[test]
fn a_reset_of_the_frame_begins_it_again_and_its_depth_never_appears() {
    let undisturbed = with_control("[]", &[], 1)[0].frame_cycles;
    assert_eq!(undisturbed, 1141);
    for abandoned_at in [100, 500, 900, 1000, 1141] {
        let (on, off) = (edge_us(abandoned_at), edge_us(abandoned_at + 3));
        let control = format!("[{{at_us={on},dsp_rst=true}},{{at_us={off},dsp_rst=false}}]");
        let frame = &with_control(&control, &[], 1)[0];
        assert_eq!((frame.frame_cycles, frame.shots), (1141, 100), "{abandoned_at}");
        assert_eq!(frame.estimator_cycles, 267);
        assert!(frame.hits() <= 100, "the histogram was cleared");
    }
    let too_late = "[{at_us=11,dsp_rst=true},{at_us=11.1,dsp_rst=false}]";
    let pair = with_control(too_late, &[], 2);
    assert_eq!(pair[0], with_control("[]", &[], 1)[0], "a finished frame stays");
}

#[test]
fn the_estimator_waits_for_dsp_en_with_the_histogram_kept() {
    let free = &with_control("[]", &[], 1)[0];
    let held = &with_control("[{at_us=20,dsp_en=true}]", &["firmware.dsp_en=false"], 1)[0];
    assert_eq!((&held.histogram, held.depth()), (&free.histogram, free.depth()));
    let frame_end_us = edge_us(1 + held.frame_cycles);
    let expected = 20.0 + 0.008 * (1.0 + 2.0 + 1.0 + 267.0);
    assert!((frame_end_us - expected).abs() < 0.012, "{frame_end_us} us");
}

#[test]
fn without_the_laser_shots_go_on_in_the_dark() {
    let dark = ["firmware.laser_en=false", "target.distance_m=0.2", "target.reflectance=0.6"];
    let lit = &with_control("[]", &dark[1..], 1)[0];
    let frame = &with_control("[]", &dark, 1)[0];
    assert_eq!((frame.shots, frame.frame_cycles), (100, 1141));
    assert!(frame.hits() < 98 && lit.hits() > 98, "{} lit, {} dark", lit.hits(), frame.hits());
    let no_light =
        [dark.as_slice(), &["ambient.irradiance_w_m2_nm=0", "spad.dark_rate_hz=0"]].concat();
    assert_eq!(with_control("[]", &no_light, 1)[0].tdc_hits, 0);
}

#[test]
fn the_laser_stops_in_mid_run_and_shots_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let control = format!("control=[{{at_us={},laser_en=false}}]", edge_us(257 + 6 * 10 + 1));
    let signals = ["--signals", "laser_on", "--signals", "start"];
    let args = ["run", "-o", ".", "--window", "shot:0..100", "-s", SHOTS, "-s", &control];
    stdout(folder.path(), &[&args[..], &signals].concat());
    let vcd = fs::read_to_string(folder.path().join("kc705.vcd")).unwrap();
    let code = |name: &str| {
        let line =
            vcd.lines().find(|line| line.starts_with("$var") && line.contains(name)).unwrap();
        format!("1{}", line.split(' ').nth(3).unwrap())
    };
    let rises = |name: &str| {
        let rise = code(name);
        vcd.lines().filter(|line| *line == rise).count()
    };
    assert_eq!((rises(" laser_on "), rises(" start ")), (11, 100));
}

#[test]
fn a_change_of_rate_counts_from_the_next_wrap() {
    let at = edge_us(257 + 6 * 10 + 1);
    let frame = &with_control(&format!("[{{at_us={at},laser_freq=0}}]"), &[], 1)[0];
    assert_eq!(frame.frame_cycles, 541 + 6 * 11 + 25 * 89);
}

#[test]
fn a_reset_button_in_mid_run_starts_over() {
    let frame = &with_control("[{at_us=5,rst=true},{at_us=5.5,rst=false}]", &[], 1)[0];
    assert_eq!((frame.frame_cycles, frame.shots, frame.estimator_cycles), (1141, 100, 267));
}

#[test]
fn a_control_signal_that_changes_on_an_edge_is_seen_by_that_edge() {
    let folder = tempfile::tempdir().unwrap();
    for (late_fs, cycles) in [(0.0, 1), (1e-9, 2)] {
        let at_us = edge_us(40) + late_fs;
        let control = format!("control=[{{at_us={at_us},mode=1}}]");
        let args =
            ["run", "-o", ".", "--window", "1us..2us", "--signals", "mode_sync", "-s", SHOTS];
        stdout(folder.path(), &[&args[..], &["-s", &control]].concat());
        let vcd = fs::read_to_string(folder.path().join("kc705.vcd")).unwrap();
        let rise = vcd.lines().skip_while(|line| !line.starts_with("$enddefinitions"));
        let mut time = 0;
        let mut risen_at = None;
        for line in rise {
            match line.strip_prefix('#') {
                Some(stamp) => time = stamp.parse().unwrap(),
                None if line.starts_with('1') => risen_at = risen_at.or(Some(time)),
                None => {}
            }
        }
        let expected = (edge_us(40 + cycles) * 1e6).round() as u64;
        assert_eq!(risen_at, Some(expected), "{late_fs} us late");
    }
}

/// A run of photons from a list, as rows of the event file without header.
fn events(list: &str, more: &[&str]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("photons.csv"), format!("shot,arrival_ps\n{list}")).unwrap();
    let shots = list.lines().count() + 1;
    let scenario =
        format!("[firmware]\nshots_per_frame = {shots}\n[stimulus]\nphotons = \"photons.csv\"\n");
    fs::write(folder.path().join("list.toml"), scenario).unwrap();
    let args = ["run", "list.toml", "--waves", "none", "--events", "events.csv"];
    stdout(folder.path(), &[&args[..], more].concat());
    let rows = fs::read_to_string(folder.path().join("events.csv")).unwrap();
    rows.lines().skip(2).map(str::to_owned).collect()
}

#[test]
fn photons_on_the_ends_of_the_range_have_the_first_and_the_last_code() {
    let ideal = ["-s", "tdc.profile=ideal"];
    let rows =
        events("0,0\n1,0.001\n2,12.5\n3,25\n4,25.001\n5,6399.999\n6,6400\n7,6412.5\n", &ideal);
    let code = |row: usize| rows[row].split(',').nth(6).unwrap().to_owned();
    assert_eq!(code(0), "0", "on the laser edge");
    assert_eq!((code(1), code(2), code(3)), ("0".into(), "0".into(), "0".into()));
    assert_eq!(code(4), "1", "an arrival at the edge counts, so bins end with their end");
    assert_eq!((code(5), code(6)), ("255".into(), "255".into()));
    assert_eq!(code(7), "", "past the range");
    assert_eq!(rows[8], "0,8,,,,,,", "a shot without a photon");
}

#[test]
fn a_photon_soon_after_the_laser_edge_is_not_of_the_shot_before() {
    for slow in [&[][..], &["-s", "firmware.laser_freq=0"]] {
        let rows = events("1,1000\n1,2000\n1,3000\n3,0\n", slow);
        assert!(rows[1].starts_with("0,1,1000.000,") && rows[3].starts_with("0,3,0.000,"));
        assert_eq!((&*rows[0], &*rows[2]), ("0,0,,,,,,", "0,2,,,,,,"));
    }
}

#[test]
fn a_hit_at_the_edge_of_the_next_start_belongs_to_the_old_shot() {
    let mode_1 = ["-s", "firmware.mode=1"];
    let rows = events("0,45000\n1,28000\n", &mode_1);
    let coarse = |row: usize| rows[row].split(',').nth(5).unwrap().to_owned();
    assert!(rows[0].starts_with("0,0,45000.000,"), "{}", rows[0]);
    assert!(rows[1].starts_with("0,1,28000.000,"), "{}", rows[1]);
    assert_eq!((coarse(0), coarse(1)), ("5".into(), "3".into()));
}

#[test]
fn the_dead_time_of_mode_1_swallows_photons_and_mode_0_has_one_a_shot() {
    let photons = "0,1000\n0,4000\n0,22000\n1,2000\n";
    let first = |rows: Vec<String>| -> Vec<String> {
        rows.iter().map(|row| row.split(',').nth(2).unwrap().to_owned()).collect()
    };
    let mode_0 = first(events(photons, &[]));
    assert_eq!(mode_0[..2], ["1000.000", "2000.000"]);
    let mode_1 = first(events("0,1000\n0,35000\n1,2000\n", &["-s", "firmware.mode=1"]));
    assert_eq!(mode_1[..2], ["1000.000", ""], "dead from 35 to 55 ns, over the photon at 50 ns");
}

#[test]
fn jitter_moves_edges_and_hardly_the_depth() {
    let folder = tempfile::tempdir().unwrap();
    let jitter = ["-s", "pll.jitter_rms_ps=7.7"];
    let run = json(folder.path(), &[&["run", "--json", "--waves", "none"], &jitter[..]].concat());
    let quiet = json(folder.path(), &["run", "--json", "--waves", "none"]);
    let depth_m = |run: &serde_json::Value| run["frames"][0]["depth_m"].as_f64().unwrap();
    assert_ne!(run["frames"][0]["histogram"], quiet["frames"][0]["histogram"]);
    assert!((depth_m(&run) - depth_m(&quiet)).abs() < 0.01);
    stdout(folder.path(), &[&["run", "-o", ".", "--signals", "clk_sys"], &jitter[..]].concat());
    let vcd = fs::read_to_string(folder.path().join("kc705.vcd")).unwrap();
    let off = vcd.lines().filter_map(|line| line.strip_prefix('#')?.parse::<u64>().ok());
    assert!(off.filter(|ps| ps % 1000 != 0).count() > 50, "edges off the nanosecond");
}

#[test]
fn a_low_that_no_edge_samples_is_no_gap_between_hits() {
    let rows = events("0,45000\n1,20000\n", &["-s", "firmware.mode=1"]);
    let fields: Vec<_> = rows[1].split(',').collect();
    assert_eq!(
        (fields[2], fields[4]),
        ("20000.000", ""),
        "low from 65 to 68 ns, edges at 64 and 72"
    );
}

#[test]
fn the_arrival_is_that_of_the_avalanche_which_had_reached_the_chain() {
    let quick = ["-s", "firmware.mode=1", "-s", "spad.dead_time_ns=5"];
    let rows = events("0,1000\n0,7000\n", &quick);
    assert!(rows[0].starts_with("0,0,1000.000,"), "{}", rows[0]);
    let code = rows[0].split(',').nth(6).unwrap();
    assert_eq!(code, "40", "a bin of 25 ps at 1 ns");
}
