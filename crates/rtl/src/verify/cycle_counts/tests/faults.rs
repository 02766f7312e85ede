//! Faults planted in our own Verilog are counted, and what they break is not proven.

use super::scan::array;
use super::{Edit, kc705, with_fault_in};
use crate::verify::cycle_counts::CountedDesign;

/// A fault, what it is found by, and what is counted then.
fn fault(key: &str, edits: &[Edit], measured: u64) {
    fault_in(&kc705(), key, edits, measured);
}

/// A fault of such a design.
fn fault_in(design: &CountedDesign, key: &str, edits: &[Edit], measured: u64) {
    let count = with_fault_in(design, key, edits);
    assert_eq!(count.rtl, Some(measured), "{key}");
    assert_eq!(count.model, Some(count.expected), "{key}");
    assert!(!count.proven && !count.holds(), "{key}");
}

#[test]
fn a_fault_of_the_estimator_is_counted_and_not_proven() {
    let control = |from, to| [["estimator_ctrl.v", from, to]];
    fault("latency", &control("Bins + 2 + Neurons", "Bins + 1 + Neurons"), 266);
    fault("forward1_cycles", &control("step < Tansig - 1'b1;", "step < Tansig - 2'd2;"), 255);
    fault("tansig_cycles", &control("step == Tansig - 1'b1", "step >= Tansig - 1'b1"), 10);
    fault("forward2_cycles", &control("step >= Sums2", "step > Sums2"), 3);
}

#[test]
fn a_fault_of_the_centroid_estimator_is_counted_and_not_proven() {
    let control = |from, to| [["centroid_estimator.v", from, to]];
    fault("centroid_latency", &control("LastAt = Bins + 55", "LastAt = Bins + 56"), 313);
    let shorter = control("LastAt = Bins + 55", "LastAt = Bins + 54");
    fault("centroid_latency", &shorter, 311);
}

#[test]
fn a_fault_of_the_likelihood_estimator_is_counted_and_not_proven() {
    let control = |from, to| [["likelihood_estimator.v", from, to]];
    let solver = |from, to| [["likelihood_solver.v", from, to]];
    fault("likelihood_latency", &control("Bins + 12", "Bins + 13"), 3780);
    fault("likelihood_latency", &control("steps == 3'd5", "steps == 3'd4"), 3449);
    let root = solver("next_one[5:0] - 6'd1", "next_one[5:0] - (op == Root ? 6'd2 : 6'd1)");
    fault("likelihood_latency", &root, 3778);
    // What only one operand in a billion does is not counted, but neither is it proven.
    let rare = solver("pause == 6'd0;", "pause == 6'd0 && a !== 987654321;");
    fault("likelihood_latency", &rare, 3779);
}

#[test]
fn a_fault_of_the_scan_is_counted_and_not_proven() {
    let control = |from, to| [["frame_ctrl.v", from, to]];
    let few = ["firmware.shots_per_frame=300", "array.rows=3", "array.columns=2"];
    let design = array(&few);
    let lost = control("row == LastRow[5:0] ? 6'd0", "row == LastRow[5:0] ? 6'd1");
    fault_in(&design, "image_cycles", &lost, 0);
    let early = control("dsp_en && !estimating", "dsp_en");
    fault_in(&design, "row_cycles", &early, 2073);
    let longer = control("LastDrain = DrainCycles - 17'd1", "LastDrain = DrainCycles - 17'd2");
    fault_in(&array(&[&few[..], &["array.banks=1"]].concat()), "depth_latency", &longer, 7576);
}

#[test]
fn a_fault_of_the_laser_is_counted_and_not_proven() {
    let laser = |from, to| [["vcsel_driver.v", from, to]];
    fault("laser_period_0", &laser("16'd25}", "16'd24}"), 24);
    fault("laser_period_1", &laser("16'd13", "16'd14"), 14);
    fault("laser_period_2", &laser("16'd8", "16'd7"), 7);
    fault("laser_period_3", &laser("{5{16'd6}}", "{5{16'd10}}"), 10);
    fault(
        "first_shot_3",
        &laser("count_next = {PeriodBits{1'b0}}", "count_next = {4'd0, !acquire}"),
        5,
    );
    fault("pre_start_lead", &laser("count + Two == last", "count + 5'd3 == last"), 3);
}

#[test]
#[ignore = "long: ./check --full"]
fn a_fault_of_the_spad_reset_or_of_the_pulse_is_counted_and_not_proven() {
    let laser = |from, to| [["vcsel_driver.v", from, to]];
    let twice = "(count + 5'd2 == last || count + 5'd3 == last)";
    let before = "count + Two == last";
    fault("spad_rst_lead", &laser(before, "count + 5'd1 == last"), 0);
    fault("spad_rst_width", &laser(before, twice), 2);
    fault("spad_rst_mode_1", &[["spad_control.v", "pre_start && !mode", "pre_start"]], 1);
    fault("laser_on_lag", &laser("fire && !fire_last", "fire"), 4000);
    let simulated = ["ddr_output.v", "clk_laser ? d_first : second", "clk_laser ? d_first : level"];
    let synthesized = ["ddr_output.v", ".D2(d_second)", ".D2(d[0])"];
    fault("laser_on_width", &[simulated, synthesized], 4000);
}
