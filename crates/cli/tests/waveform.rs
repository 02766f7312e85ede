//! Waveforms as their users see them: read by `wellen` and by `vcd2fst`, which are not ours.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use wellen::VarRef;
use wellen::simple::{Waveform, read};

use crate::common;

mod channels;

/// Changes of a signal: time [ps] and value as bits, most significant first.
type Changes = Vec<(u64, String)>;

struct Wave {
    waveform: Waveform,
    vars: BTreeMap<String, VarRef>,
}

impl Wave {
    fn open(path: &Path) -> Self {
        let mut waveform = read(path).unwrap();
        let hierarchy = waveform.hierarchy();
        let named = hierarchy.all_vars().map(|var| (hierarchy[var].full_name(hierarchy), var));
        let vars: BTreeMap<_, _> = named.collect();
        let signals: Vec<_> =
            vars.values().map(|&var| waveform.hierarchy()[var].signal_ref()).collect();
        waveform.load_signals(&signals);
        Wave { waveform, vars }
    }

    fn changes(&self, name: &str) -> Changes {
        let var = self.vars.get(&format!("tof_top.{name}")).or_else(|| self.vars.get(name));
        let var = *var.unwrap_or_else(|| panic!("no signal {name}"));
        let signal = self.waveform.get_signal(self.waveform.hierarchy()[var].signal_ref()).unwrap();
        let times = self.waveform.time_table();
        let changes = signal.iter_changes();
        changes.map(|(k, value)| (times[k as usize], value.to_bit_string().unwrap())).collect()
    }

    fn rises(&self, name: &str) -> Vec<u64> {
        self.edges(name, "0", "1")
    }

    fn falls(&self, name: &str) -> Vec<u64> {
        self.edges(name, "1", "0")
    }

    fn edges(&self, name: &str, from: &str, to: &str) -> Vec<u64> {
        let changes = self.changes(name);
        let pairs = changes.windows(2).filter(|pair| pair[0].1 == from && pair[1].1 == to);
        pairs.map(|pair| pair[1].0).collect()
    }
}

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
fn the_outputs_of_the_row_are_shown_and_the_or_of_those_on_the_tdc_is_tdc_stop() {
    for (keys, on_tdc) in [
        (["spad.on_tdc=3", "firmware.mode=0"], 14..17),
        (["spad.on_tdc=30", "firmware.mode=1"], 0..30),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let row = [
            "spad.row_outputs=30",
            "spad.crosstalk_probability=0.2",
            "firmware.shots_per_frame=40",
        ];
        let keys = [&keys[..], &row].concat();
        let set: Vec<_> = keys.iter().flat_map(|key| ["-s", *key]).collect();
        for format in ["vcd", "fst"] {
            run(
                folder.path(),
                &[&set[..], &["--waves", format, "--window", "shot:3..30"]].concat(),
            );
        }
        let path = |ending| folder.path().join("kc705").with_extension(ending);
        let [vcd, fst] = ["vcd", "fst"].map(|ending| Wave::open(&path(ending)));
        let names: Vec<_> = (0..30).map(|output| format!("spad_row.spad_out_{output}")).collect();
        let outputs: Vec<_> = names.iter().map(|name| vcd.changes(name)).collect();
        for (name, output) in names.iter().zip(&outputs) {
            assert_eq!(fst.changes(name), *output, "{name}");
            assert!(vcd.rises(name).len() > 3, "{name}");
        }
        let at = |changes: &Changes, time: u64| {
            let after = changes.partition_point(|(then, _)| *then <= time);
            changes[after - 1].1.clone()
        };
        let stop = vcd.changes("tdc_stop");
        let times = outputs.iter().chain([&stop]).flatten().map(|(time, _)| *time);
        for time in times {
            let levels = outputs[on_tdc.clone()].iter().map(|output| at(output, time));
            let levels: Vec<_> = levels.collect();
            let expected =
                ["1", "x", "0"].into_iter().find(|level| levels.iter().any(|l| l == level));
            assert_eq!(Some(&*at(&stop, time)), expected, "{time} ps: {levels:?}");
        }
        if keys[1] == "firmware.mode=0" {
            let unwired = vcd.rises(&names[2]).len() + vcd.rises(&names[28]).len();
            assert!(unwired > 10 && vcd.rises("tdc_stop").len() <= 27, "{unwired}");
        }
    }
}

#[test]
fn outputs_of_the_row_are_chosen_by_name_where_they_are_simulated() {
    let folder = tempfile::tempdir().unwrap();
    let some = ["--window", "shot:0..4", "--signals", "spad_out_1?", "--signals", "tdc_stop"];
    run(folder.path(), &[&["-s", "spad.row_outputs=30"], &some[..]].concat());
    let wave = Wave::open(&folder.path().join("kc705.vcd"));
    let row = wave.vars.keys().filter(|name| name.starts_with("spad_row."));
    assert_eq!(row.count(), 10);
    let views = std::fs::read_to_string(folder.path().join("kc705.gtkw")).unwrap();
    assert!(views.contains("-Row of SPADs\n") && views.contains(" spad_row.spad_out_15\n"));
    let error = common::refused(folder.path(), &[&["run"], &some[..]].concat());
    assert!(error.contains("spad_out_1?: matches no signal"), "{error}");
    run(folder.path(), &["--window", "shot:0..4", "-s", "spad.crosstalk_probability=0.5"]);
    let wave = Wave::open(&folder.path().join("kc705.vcd"));
    assert!(wave.vars.keys().all(|name| name.starts_with("tof_top.")));
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
