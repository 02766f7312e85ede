//! Waveforms as their users see them: read by `wellen` and by `vcd2fst`, which are not ours.

use std::path::Path;
use std::process::Command;

use crate::common;

mod channels;
mod row;
mod views;
mod wave;

pub use wave::{Changes, Wave};

fn run(folder: &Path, args: &[&str]) {
    common::stdout(folder, &[&["run", "-o", "."], args].concat());
}

/// Gaps between neighbours.
fn gaps(times: &[u64]) -> Vec<u64> {
    times.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

#[test]
fn clocks_rise_together_every_8_ns() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["--window", "2us..3us"]);
    let wave = Wave::open(&folder.path().join("kc705.vcd"));
    let (whole, half) = (wave.rises("clk_sys"), wave.rises("clk_laser"));
    assert!(whole.len() > 120);
    assert!(gaps(&whole).iter().all(|&gap| gap == 8_000));
    assert!(gaps(&half).iter().all(|&gap| gap == 4_000));
    assert!(whole.iter().all(|rise| half.contains(rise)));
    assert!(gaps(&wave.rises("clk_in")).iter().all(|&gap| gap == 5_000));
    assert!(gaps(&wave.falls("clk_sys")).iter().all(|&gap| gap == 8_000));
}

#[test]
fn the_laser_fires_2_ns_every_period_and_the_spad_is_reset_for_the_8_ns_before() {
    for (laser_freq, cycles) in [(0, 25), (1, 13), (2, 8), (3, 6)] {
        let folder = tempfile::tempdir().unwrap();
        let freq = format!("firmware.laser_freq={laser_freq}");
        run(
            folder.path(),
            &["--window", "shot:0..40", "-s", &freq, "-s", "firmware.shots_per_frame=50"],
        );
        let wave = Wave::open(&folder.path().join("kc705.vcd"));
        let (on, off) = (wave.rises("laser_on_lvds_p"), wave.falls("laser_on_lvds_p"));
        assert_eq!(on.len(), 40);
        assert!(gaps(&on).iter().all(|&gap| gap == cycles * 8_000), "{laser_freq}");
        assert!(on.iter().zip(&off).all(|(on, off)| off - on == 2_000));
        let clk_sys = wave.rises("clk_sys");
        assert!(on.iter().all(|rise| clk_sys.contains(rise)));
        assert_eq!(wave.falls("spad_rst"), on, "the reset ends with the laser edge");
        let reset = wave.rises("spad_rst");
        assert!(reset.iter().zip(&on).all(|(reset, on)| on - reset == 8_000));
        let pulse: Vec<_> = wave.rises("vcsel_driver.laser_pulse");
        assert!(pulse.iter().zip(&on).all(|(pulse, on)| on - pulse == 4_000));
        assert_eq!(wave.falls("laser_on_lvds_n"), on);
    }
}

#[test]
fn mode_1_never_resets_the_spad() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["--window", "shot:0..200", "-s", "firmware.mode=1"]);
    let wave = Wave::open(&folder.path().join("kc705.vcd"));
    assert!(wave.rises("spad_rst").is_empty() && wave.falls("spad_rst").is_empty());
    let stop = (wave.rises("tdc_stop"), wave.falls("tdc_stop"));
    assert!(stop.0.len() > 200, "the dead time lets it fire several times a shot");
    for rise in &stop.0[..200] {
        let fall = stop.1.iter().find(|fall| *fall > rise).unwrap();
        assert!((19_999..=20_001).contains(&(fall - rise)), "dead time {}", fall - rise);
    }
}

#[test]
fn the_estimator_takes_267_edges_with_enables_of_256_1_and_4_cycles() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["--window", "estimation", "-s", "firmware.shots_per_frame=100"]);
    let wave = Wave::open(&folder.path().join("kc705.vcd"));
    let start = wave.rises("algo_start")[0];
    let taken = start + 8_000;
    assert_eq!(wave.rises("algo_done"), [taken + 267 * 8_000]);
    let cycles = |name: &str| {
        let (rise, fall) = (wave.rises(name)[0], wave.falls(name)[0]);
        (fall - rise) / 8_000
    };
    assert_eq!(cycles("depth_estimator.estimator_ctrl.forward1_en"), 256);
    assert_eq!(cycles("depth_estimator.estimator_ctrl.tansig_en"), 1);
    assert_eq!(cycles("depth_estimator.estimator_ctrl.forward2_en"), 4);
    assert_eq!(cycles("hist_valid"), 256);
    let depth = common::json(
        folder.path(),
        &["run", "--json", "--waves", "none", "-s", "firmware.shots_per_frame=100"],
    );
    let depth = depth["frames"][0]["depth_raw"].as_str().unwrap().to_owned();
    let shown =
        wave.changes("depth").into_iter().rev().find(|(_, bits)| !bits.contains('x')).unwrap();
    assert_eq!(format!("{:09x}", u64::from_str_radix(&shown.1, 2).unwrap()), depth);
}

#[test]
fn nothing_moves_before_the_clocks_are_locked() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["--window", "0us..2us"]);
    let wave = Wave::open(&folder.path().join("kc705.vcd"));
    let locked = wave.rises("locked");
    assert_eq!(locked, [1_000_000]);
    for name in wave.vars.keys() {
        let name = name.strip_prefix("tof_top.").unwrap();
        let last = name.rsplit('.').next().unwrap();
        if ["clk_in", "tdc_stop", "locked"].contains(&last) {
            continue;
        }
        let early: Vec<_> =
            wave.changes(name).into_iter().filter(|(at, _)| *at > 0 && *at < 1_008_000).collect();
        assert_eq!(early, [], "{name}");
    }
    assert_eq!(wave.rises("clk_sys")[0], 1_008_000);
    assert_eq!(wave.rises("clk_laser")[0], 1_008_000);
    assert!(!wave.rises("tdc_stop").is_empty(), "ambient light falls from power-up on");
}

#[test]
fn vcd_and_fst_hold_the_same_changes() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &[]);
    run(folder.path(), &["--waves", "fst"]);
    let vcd = Wave::open(&folder.path().join("kc705.vcd"));
    let fst = Wave::open(&folder.path().join("kc705.fst"));
    assert!(vcd.vars.keys().eq(fst.vars.keys()));
    for name in vcd.vars.keys() {
        let name = name.strip_prefix("tof_top.").unwrap();
        assert_eq!(vcd.changes(name), fst.changes(name), "{name}");
    }
}

#[test]
fn the_default_waveform_is_small_and_gtkwaves_converter_takes_it() {
    let folder = tempfile::tempdir().unwrap();
    common::stdout(folder.path(), &["run"]);
    let vcd = folder.path().join("waves/kc705.vcd");
    assert!(vcd.metadata().unwrap().len() < 5_000_000);
    let fst = folder.path().join("converted.fst");
    let converted = Command::new("vcd2fst").arg(&vcd).arg(&fst).output();
    let converted = converted.expect("vcd2fst is missing: apt-get install gtkwave");
    assert!(converted.status.success());
    let (ours, theirs) = (Wave::open(&vcd), Wave::open(&fst));
    for name in ["laser_on_lvds_p", "tdc_stop", "depth", "tdc.tdc_decoder.tdc_code"] {
        assert_eq!(ours.changes(name), theirs.changes(name), "{name}");
    }
    let names = common::files(&folder.path().join("waves"));
    assert!(names.contains(&"kc705.gtkw".to_owned()) && names.contains(&"kc705.sucl".to_owned()));
    let text = std::fs::read_to_string(&vcd).unwrap();
    for line in ["tofsim", "scenario kc705", "seed 1"] {
        assert!(text[..2_000].contains(line), "provenance: {line}");
    }
}

#[test]
fn signals_are_chosen_by_glob_and_the_ram_only_on_request() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["--signals", "tdc.*", "--signals", "histogram_builder.ram_1?"]);
    let wave = Wave::open(&folder.path().join("kc705.vcd"));
    assert!(wave.vars.contains_key("tof_top.tdc.tdc_decoder.n"));
    assert!(wave.vars.contains_key("tof_top.histogram_builder.ram_17"));
    assert!(!wave.vars.contains_key("tof_top.histogram_builder.ram_2"));
    assert!(!wave.vars.contains_key("tof_top.depth"));
    run(folder.path(), &[]);
    let wave = Wave::open(&folder.path().join("kc705.vcd"));
    assert!(!wave.vars.keys().any(|name| name.contains(".ram_")));
}

#[test]
fn the_control_timeline_takes_effect_two_edges_later_and_at_the_wrap() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["spad_validation"]);
    let wave = Wave::open(&folder.path().join("spad_validation.vcd"));
    let on = wave.rises("laser_on_lvds_p");
    let mut gaps = gaps(&on);
    gaps.dedup();
    assert_eq!(gaps, [200_000, 104_000, 64_000, 48_000]);
    assert_eq!(wave.rises("mode"), [10_100_000]);
    let synchronised = wave.rises("mode_sync");
    assert_eq!(synchronised, [10_112_000], "edges at 10.104 and 10.112 us");
    let resets = wave.rises("spad_rst");
    assert!(resets.iter().all(|&reset| reset <= synchronised[0]));
    assert!(on.iter().filter(|&&on| on > synchronised[0] + 48_000).count() > 30, "shots in MODE 1");
}

#[test]
fn the_viewer_opens_on_the_first_window() {
    let folder = tempfile::tempdir().unwrap();
    // GTKWave shows 2^-zoom units in 200 pixels; a window of 1000 pixels has to hold the span.
    for (scenario, from_ns, span_ns) in
        [("kc705", 3_088, 768), ("tdc_validation", 3_088, 240), ("spad_validation", 0, 14_000)]
    {
        run(folder.path(), &[scenario]);
        let text = std::fs::read_to_string(folder.path().join(format!("{scenario}.gtkw"))).unwrap();
        let line = |start: &str| text.lines().find_map(|line| line.strip_prefix(start)).unwrap();
        let begin: u64 = line("[timestart] ").parse().unwrap();
        assert!(begin.abs_diff(from_ns * 1000) < span_ns * 100, "{scenario} from {begin} ps");
        let zoom: f64 = line("*").split(' ').next().unwrap().parse().unwrap();
        let shown_ns = 5.0 * (-zoom).exp2() / 1000.0;
        let ratio = shown_ns / span_ns as f64;
        assert!((0.5..3.0).contains(&ratio), "{scenario} shows {shown_ns} ns");
    }
}

#[test]
fn an_oscillator_without_a_whole_period_is_found_again_late_in_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let pll = ["pll.input_hz=150000000", "pll.multiply=10", "pll.output_divide=12"];
    let pll: Vec<_> = pll.iter().flat_map(|set| ["-s", set]).collect();
    run(folder.path(), &[&["--window", "1400us..1401us", "--signals", "clk_*"], &pll[..]].concat());
    let wave = Wave::open(&folder.path().join("kc705.vcd"));
    let rises = wave.rises("clk_in");
    assert!(rises.len() > 140);
    for rise in rises {
        let edge = ((rise as f64 * 1e-12 * 150e6 - 0.5).round() + 0.5) / 150e6 * 1e12;
        assert!((rise as f64 - edge).abs() < 1.5, "{rise} ps, expected {edge}");
    }
    assert!(gaps(&wave.rises("clk_sys")).iter().all(|&gap| gap == 8_000));
}
