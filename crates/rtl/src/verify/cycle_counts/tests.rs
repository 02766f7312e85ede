//! Promises hold of our own Verilog; what cannot be counted or proven is reported.

mod faults;
mod recorded;
mod scan;

use std::fs;
use std::time::Duration;

use tofsim::firmware::estimator_ctrl::Params;
use tofsim::firmware::likelihood_estimator::glass::Glass;
use tofsim::firmware::likelihood_estimator::params::Params as Likelihood;
use tofsim::sim::setup::Setup;

use crate::golden::blocks::CENTROID;

use super::*;

fn limits() -> Limits<'static> {
    Limits::new(Duration::from_secs(60))
}

/// A place in a file of ours, and what to put there.
type Edit = [&'static str; 3];

fn kc705() -> CountedDesign {
    of(&[])
}

fn of(set: &[&str]) -> CountedDesign {
    CountedDesign::of(&Setup::load("kc705", set).unwrap())
}

/// The count of `key` in our Verilog after some edits.
fn with_fault(key: &str, edits: &[Edit]) -> Count {
    with_fault_in(&kc705(), key, edits)
}

/// The count of `key` in our Verilog of such a design after some edits.
fn with_fault_in(design: &CountedDesign, key: &str, edits: &[Edit]) -> Count {
    let folder = tempfile::tempdir().unwrap();
    let rtl = Rtl::own(folder.path()).unwrap();
    for [file, from, to] in edits {
        let path = folder.path().join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{file} has no `{from}`");
        fs::write(&path, text.replace(from, to)).unwrap();
    }
    let mut promises = promises::promises(design);
    promises.push(promises::centroid(design));
    promises.extend(promises::likelihood(design));
    promises.extend(design.scan.iter().flat_map(promises::of_scan));
    promises.retain(|promise| promise.key() == key);
    let planted = edits.iter().map(|[file, from, to]| format!("{file}: {from} -> {to}"));
    let planted: Vec<_> = planted.collect();
    recorded::count(&planted.join(", "), &promises, design, &rtl).remove(0)
}

/// Proves the promises of either estimator with so many bins and neurons; returns the numbers.
fn proven(bins: usize, neurons: usize) -> Vec<u64> {
    proven_of(bins, neurons, |_| true)
}

/// Proves those of the promises that `chosen` picks; returns the numbers.
fn proven_of(bins: usize, neurons: usize, chosen: fn(&Promise) -> bool) -> Vec<u64> {
    let folder = tempfile::tempdir().unwrap();
    let rtl = Rtl::own(folder.path()).unwrap();
    let mut design = kc705();
    design.estimator = Params { bins, neurons };
    let mut promises = promises::promises(&design);
    promises.retain(|promise| promise.properties.module == "check_estimator");
    promises.push(promises::centroid(&design));
    promises.retain(chosen);
    let of = format!("{bins} bins, {neurons} neurons");
    let counts = recorded::count(&of, &promises, &design, &rtl);
    for count in &counts {
        assert!(count.holds(), "{design:?}: {count:?}");
    }
    counts.iter().map(|count| count.expected).collect()
}

#[test]
fn our_own_design_keeps_all_its_promises() {
    let folder = tempfile::tempdir().unwrap();
    let rtl = Rtl::own(folder.path()).unwrap();
    let counts = recorded::count("", &promises::of(&rtl, &kc705()), &kc705(), &rtl);
    assert!(counts.iter().all(Count::holds), "{counts:?}");
    assert_eq!(counts.len(), 20);
}

#[test]
fn sixteen_neurons_take_275_clocks() {
    assert_eq!(proven(256, 16), [275, 256, 1, 8, 312]);
}

#[test]
fn other_numbers_of_bins_take_a_clock_each() {
    assert_eq!(proven(64, 4), [73, 64, 1, 2, 120]);
    assert_eq!(proven(1024, 8), [1035, 1024, 1, 4, 1080]);
}

#[test]
#[ignore = "long: ./check --full"]
fn the_smallest_and_more_sizes_between_are_proven() {
    assert_eq!(proven(16, 1), [24, 16, 1, 1, 72]);
    assert_eq!(proven(32, 13), [48, 32, 1, 7, 88]);
    assert_eq!(proven(512, 16), [531, 512, 1, 8, 568]);
}

#[test]
#[ignore = "long: ./check --full"]
fn below_eight_neurons_the_pipeline_decides_and_from_there_on_a_clock_a_neuron() {
    for neurons in 1..16 {
        let latency = [264, 264, 265, 265, 266, 266].get(neurons - 1).copied();
        let proven = proven_of(256, neurons, |promise| promise.key() == "latency");
        assert_eq!(proven, [latency.unwrap_or(259 + neurons.max(8) as u64)]);
    }
}

/// Proves the promise of the likelihood estimator of such an instrument; returns the number.
fn likelihood(set: &[&str]) -> u64 {
    of_likelihood(&set.join(", "), of(set))
}

/// The same of a design.
fn of_likelihood(name: &str, design: CountedDesign) -> u64 {
    let folder = tempfile::tempdir().unwrap();
    let rtl = Rtl::own(folder.path()).unwrap();
    let promise = promises::likelihood(&design).unwrap();
    let counts = recorded::count(name, &[promise], &design, &rtl);
    assert!(counts[0].holds(), "{name}: {:?}", counts[0]);
    counts[0].expected
}

#[test]
fn an_estimation_behind_glass_takes_5639_clocks() {
    let mut design = of(&[]);
    let hazards: Vec<_> = (0..30).map(|bin| 0.01 + 0.001 * f64::from(bin)).collect();
    let glass = Glass::of(&hazards);
    design.likelihood = design.likelihood.map(|usual| Likelihood { glass, ..usual });
    assert_eq!(of_likelihood("a pedestal of 30 bins", design), 5639);
}

#[test]
fn an_estimation_of_two_targets_takes_9559_clocks() {
    assert_eq!(likelihood(&["estimator.targets=2"]), 9559);
}

#[test]
fn an_estimation_of_two_targets_behind_glass_takes_12901_clocks() {
    let mut design = of(&["estimator.targets=2"]);
    let hazards: Vec<_> = (0..30).map(|bin| 0.01 + 0.001 * f64::from(bin)).collect();
    let glass = Glass::of(&hazards);
    design.likelihood = design.likelihood.map(|usual| Likelihood { glass, ..usual });
    assert_eq!(of_likelihood("two targets, a pedestal of 30 bins", design), 12_901);
}

#[test]
fn a_likelihood_estimation_takes_3779_clocks() {
    assert_eq!(likelihood(&[]), 3779);
}

#[test]
#[ignore = "long: ./check --full"]
fn a_likelihood_estimation_takes_as_long_as_bins_box_and_fit_say() {
    let sizes = [(16, 30), (32, 30), (64, 100), (512, 100), (1024, 300)];
    let cycles = sizes.map(|(bins, pulse_ps)| {
        let (bins, pulse) =
            (format!("tdc.bins={bins}"), format!("laser.pulse_sigma_ps={pulse_ps}"));
        likelihood(&[&bins, &pulse, "estimator.kind=likelihood"])
    });
    assert_eq!(cycles, [2023, 2103, 2643, 4883, 8495]);
}

/// Counts and proves the promises of other lasers, each with its numbers.
#[test]
#[ignore = "long: ./check --full"]
fn other_laser_periods_pulses_and_clocks_are_counted_and_proven() {
    let folder = tempfile::tempdir().unwrap();
    let rtl = Rtl::own(folder.path()).unwrap();
    for (set, periods, width_ps) in [
        (
            &[
                "firmware.laser_periods=[65535]",
                "firmware.laser_freq=0",
                "firmware.pulse_half_cycles=8",
            ][..],
            &[65535][..],
            16000,
        ),
        (
            &[
                "firmware.laser_periods=[12, 300]",
                "firmware.laser_freq=0",
                "firmware.pulse_half_cycles=3",
                "pll.output_divide=10",
                "tdc.profile=ecp5",
            ],
            &[12, 300],
            7500,
        ),
    ] {
        let design = of(set);
        let mut promises = promises::promises(&design);
        promises.retain(|promise| promise.properties.module != "check_estimator");
        let counts = recorded::count(&set.join(", "), &promises, &design, &rtl);
        for count in &counts {
            assert!(count.holds(), "{set:?}: {count:?}");
        }
        let expected: Vec<_> = counts.iter().map(|count| count.expected).collect();
        let of_laser = [periods, periods, &[2, 1, 1, 0, 0, width_ps]].concat();
        assert_eq!(expected, of_laser, "{set:?}");
    }
}

#[test]
fn a_property_that_holds_of_two_numbers_is_vacuous() {
    let never = ["vcsel_driver.v", "start_next = acquire && count == last", "start_next = 1'b0"];
    let count = with_fault(
        "pre_start_lead",
        &[
            never,
            [
                "vcsel_driver.v",
                "pre_start_next = acquire && count + Two == last",
                "pre_start_next = 1'b0",
            ],
        ],
    );
    assert_eq!(count.rtl, None);
    let why = "vacuous: 1 is proven as well as 2";
    assert_eq!(count.reason.as_deref(), Some(why));
}

#[test]
fn without_our_registers_the_estimator_is_counted_but_not_proven() {
    let count = with_fault("latency", &[["estimator_ctrl.v", "busy", "at_work"]]);
    assert_eq!(count.rtl, Some(267));
    let why = "the proof needs the registers estimator_ctrl.busy and estimator_ctrl.step";
    assert_eq!(count.reason.as_deref(), Some(why));
}

#[test]
fn a_design_may_leave_the_centroid_estimator_out() {
    let folder = tempfile::tempdir().unwrap();
    let mut rtl = Rtl::own(folder.path()).unwrap();
    rtl.files.retain(|file| !file.path.ends_with("centroid_estimator.v"));
    assert!(!rtl.has(CENTROID));
    let own = promises::of(&rtl, &kc705());
    let measured = simulate::measure(&own, &rtl, &kc705(), folder.path(), &limits()).unwrap();
    assert_eq!(measured.count("latency", 267), Some(267));
    assert_eq!(measured.count("centroid_latency", 312), None);
}

#[test]
fn a_missing_module_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut rtl = Rtl::own(folder.path()).unwrap();
    rtl.files.retain(|file| !file.path.ends_with("spad_control.v"));
    let error = cycle_counts(&rtl, &kc705(), &limits(), |_| {}).unwrap_err();
    let error = error.to_string();
    assert!(error.starts_with("rtl_ref: module = spad_control: no such module"), "{error}");
}

#[test]
fn what_the_compiler_refuses_comes_with_its_message() {
    let folder = tempfile::tempdir().unwrap();
    let rtl = Rtl::own(folder.path()).unwrap();
    let path = folder.path().join("spad_control.v");
    let text = fs::read_to_string(&path).unwrap().replace("spad_rst", "spad_reset");
    fs::write(&path, text).unwrap();
    let error = cycle_counts(&rtl, &kc705(), &limits(), |_| {}).unwrap_err().to_string();
    assert!(error.contains("bench_shot.v") && error.contains("spad_rst"), "{error}");
}

#[test]
fn a_simulation_that_never_ends_is_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let rtl = Rtl::own(folder.path()).unwrap();
    let path = folder.path().join("spad_control.v");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("initial begin", "initial begin while (1) spad_sel = 40'd1;"))
        .unwrap();
    let limits = Limits::new(Duration::from_secs(2));
    let error = cycle_counts(&rtl, &kc705(), &limits, |_| {}).unwrap_err().to_string();
    assert_eq!(error, "rtl_ref: bench_shot has not ended after 2 s of processor time");
}

#[test]
fn a_proof_that_takes_too_long_is_none() {
    let folder = tempfile::tempdir().unwrap();
    let rtl = Rtl::own(folder.path()).unwrap();
    let limits = Limits::new(Duration::ZERO);
    let unproven =
        prove::prove(&promises::promises(&kc705())[0], &rtl, folder.path(), &limits).unwrap();
    assert_eq!(unproven.as_deref(), Some("Yosys has not ended after 0 s"));
}
