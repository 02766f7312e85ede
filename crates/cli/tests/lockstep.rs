//! Rust and Verilog do the same, clock by clock: each block alone, the whole with short frames and
//! under random control, and full frames at every laser rate.

pub mod recorded;

use serde_json::Value;

use tofsim_rtl::golden::BLOCKS;
use tofsim_rtl::verify::task::DEFAULT;

use crate::common;

use recorded::{LOCKSTEP, Passed};

/// Lines of a block's own bench, at least.
const CYCLES: u64 = 20_000;

/// A frame of a hundredth of the shots.
const SHORT: [&str; 2] = ["-s", "firmware.shots_per_frame=300"];

/// Configurations that take Icarus more than five seconds each: `./check --full` runs them.
const SLOW: [&str; 16] = [
    "depth_estimator.neurons_31",
    "forward1.neurons_16",
    "forward1.neurons_31",
    "likelihood_estimator.late",
    "tansig.neurons_31",
    "tdc.reordered",
    "tdc_decoder.calibrated",
    "tdc_decoder.count_stages_2",
    "tdc_decoder.reordered",
    "tof_top.clocks",
    "tof_top.count_stages_2",
    "tof_top.histogram",
    "tof_top.likelihood",
    "tof_top.neurons_16",
    "tof_top.reordered",
    "tof_top.two",
];

/// The reports of a `verify` that has to pass; `check` names it.
pub fn verified(check: &str, args: &[&str]) -> Vec<Value> {
    let folder = common::empty();
    let output = common::output(folder.path(), &[&["verify", "--json"], args].concat());
    let text = String::from_utf8(output.stdout).unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let reports: Value = serde_json::from_str(&text).unwrap_or_else(|_| panic!("{errors}"));
    assert_eq!(output.status.code(), Some(0), "{check}: {text}{errors}");
    assert_eq!(reports["passed"], true);
    let blocks = reports["blocks"].as_array().unwrap().clone();
    for block in &blocks {
        assert_eq!((&block["verdict"], &block["mismatches"]), (&"pass".into(), &0.into()));
    }
    blocks
}

/// Every block in each of its configurations.
fn configurations() -> impl Iterator<Item = String> {
    BLOCKS.iter().flat_map(|spec| {
        let others = spec.configurations.iter().map(|other| other.name);
        [DEFAULT].into_iter().chain(others).map(|name| format!("{}.{name}", spec.name))
    })
}

/// Blocks that compute for thousands of cycles before there is a result.
const LATE: [&str; 2] = ["likelihood_estimator", "tof_top"];
/// Lines that show those what they do with unknown values, and the others [clock cycles].
const FEW: [&str; 2] = ["16000", "5000"];

/// Those of these configurations that are late, and the others, each with its number of lines.
fn late_and_early(names: &[String]) -> impl Iterator<Item = (Vec<String>, &'static str)> {
    let is_late = |name: &String| LATE.iter().any(|late| name.starts_with(late));
    let (late, early) = names.iter().cloned().partition(is_late);
    [late, early].into_iter().zip(FEW)
}

/// Verifies these configurations in Icarus, from power-up on, when no register is known yet. Verilator sees all that
/// comes later, for a fraction of the time.
fn pass_in_icarus(names: &[String]) {
    for (names, cycles) in late_and_early(names) {
        recorded::verified("icarus", &names, &["--cycles", cycles]);
    }
}

#[test]
fn every_block_passes_in_icarus() {
    let quick: Vec<_> = configurations().filter(|name| !SLOW.contains(&&**name)).collect();
    pass_in_icarus(&quick);
}

#[test]
#[ignore = "long: ./check --full"]
fn every_slow_configuration_passes_in_icarus() {
    pass_in_icarus(&SLOW.map(str::to_owned));
}

/// Verifies a run of the whole in a simulator.
fn whole_passes(simulator: &str, options: &[&str]) -> Passed {
    recorded::verified(simulator, &["tof_top"], options).pop().unwrap()
}

/// Of an array with two banks. Those of the other estimators are configurations of `tof_top`.
#[test]
#[ignore = "long: ./check --full"]
fn whole_images_of_the_likelihood_estimator_pass_in_both_simulators() {
    let keys = ["array.rows=4", "array.columns=3", "firmware.shots_per_frame=300"];
    let set = keys.iter().flat_map(|key| ["-s", *key]);
    let image: Vec<_> = ["--scenario", "array"].into_iter().chain(set).collect();
    for simulator in ["icarus", "verilator"] {
        let passed = whole_passes(simulator, &image);
        // Four rows whose estimates last longer than their shots.
        assert!(passed.cycles > 4 * 3 * 3781, "{passed:?}");
    }
}

/// With another seed, so that it also sees what Icarus is not given.
#[test]
#[ignore = "long: ./check --full"]
fn every_configuration_of_every_block_passes_in_verilator() {
    let names: Vec<_> = configurations().collect();
    let passed = recorded::verified("verilator", &names, &["--seed", "2"]);
    for (name, passed) in names.iter().zip(passed) {
        let (met, of) = passed.goals;
        assert!(passed.cycles >= CYCLES && met == of, "{name}: {passed:?}");
    }
}

#[test]
fn a_frame_of_sixteen_neurons_passes_in_icarus() {
    whole_passes("icarus", &[&SHORT[..], &["-s", "estimator.network=uniform-16"]].concat());
}

#[test]
fn two_frames_of_300_shots_pass_in_icarus() {
    for rate in 0..4 {
        let rate = format!("firmware.laser_freq={rate}");
        whole_passes("icarus", &[&SHORT[..], &["--frames", "2", "-s", &rate]].concat());
    }
}

#[test]
fn the_validation_scenarios_pass_in_icarus() {
    for scenario in ["spad_validation", "histogram_validation", "estimator_validation"] {
        whole_passes("icarus", &["--scenario", scenario, "--cycles", "20000"]);
    }
}

#[test]
fn the_centroid_estimator_passes_with_other_windows_and_scales() {
    for keys in [
        ["half_width=31", "background=false", "offset_m=-0.99", "slope_m=0.0078"],
        ["half_width=1", "background=true", "offset_m=0.99", "slope_m=0.0001"],
        ["half_width=8", "background=false", "offset_m=0.0338", "slope_m=0.00356"],
    ] {
        let keys = keys.map(|key| format!("estimator.centroid_{key}"));
        let set: Vec<_> = keys.iter().flat_map(|key| ["-s", key]).collect();
        let [passed] = &recorded::verified("icarus", &["centroid_estimator"], &set)[..] else {
            panic!()
        };
        assert_eq!(passed.goals.0, passed.goals.1, "{keys:?}");
    }
}

#[test]
#[ignore = "long: ./check --full"]
fn the_top_passes_with_the_centroid_estimator_in_its_socket() {
    let kind = ["-s", "estimator.kind=centroid"];
    for simulator in ["icarus", "verilator"] {
        let two = [&SHORT[..], &["--frames", "2"], &kind].concat();
        let cycles = whole_passes(simulator, &two).cycles;
        let frames = 2 * (300 * 6 + 274 + 312 + 1);
        assert!((frames..frames + 8).contains(&cycles), "{cycles} cycles");
    }
    whole_passes("icarus", &[&["--scenario", "estimator_validation"], &kind[..]].concat());
}

#[test]
fn uneven_chains_and_passive_quenching_pass_in_icarus() {
    for chain in ["table6_3", "ideal", "kintex7"] {
        let chain = format!("tdc.profile={chain}");
        whole_passes("icarus", &[&SHORT[..], &["-s", "firmware.mode=1", "-s", &chain]].concat());
    }
}

#[test]
fn a_chain_whose_taps_are_reached_out_of_order_passes_in_icarus() {
    let folder = common::empty();
    let delays: Vec<_> = (0..800).map(|tap| [30.0, -5.0, 25.0, -4.0][tap % 4]).collect();
    let chain = folder.path().join("uneven.toml");
    std::fs::write(&chain, format!("offset_ps = 2230.0\ntap_delays_ps = {delays:?}\n")).unwrap();
    let chain = format!("tdc.profile={}", chain.display());
    let in_icarus = |names: &[&str], options: &[&str]| {
        recorded::verified_as(&LOCKSTEP, "with uneven taps", "icarus", names, options)
    };
    in_icarus(&["carry_chain", "tdc"], &["-s", &chain]);
    in_icarus(&["tof_top"], &[&SHORT[..], &["-s", &chain]].concat());
}

#[test]
fn each_calibration_of_a_silicon_chain_passes_in_icarus() {
    let folder = common::empty();
    for converter in &common::CONVERTERS[4..] {
        let keys = common::converter(*converter, folder.path());
        let set: Vec<_> = keys.iter().flat_map(|key| ["-s", key]).collect();
        let in_icarus = |name: &str, options: &[&str]| {
            let what = format!("with {}", converter.join(", calibration "));
            recorded::verified_as(&LOCKSTEP, &what, "icarus", &[name], options)
        };
        in_icarus("tdc_decoder", &set);
        in_icarus("tof_top", &[&SHORT[..], &set].concat());
    }
}

#[test]
#[ignore = "long: ./check --full"]
fn full_frames_at_every_rate_pass_in_verilator() {
    for (rate, period) in [(0, 25), (1, 13), (2, 8), (3, 6)] {
        let rate = format!("firmware.laser_freq={rate}");
        let passed = whole_passes("verilator", &["-s", &rate]);
        let frame = 30_000 * period + 541;
        assert!((frame..frame + 8).contains(&passed.cycles), "{passed:?}");
    }
}
