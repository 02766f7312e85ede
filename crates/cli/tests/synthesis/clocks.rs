//! Clock frequencies of the blocks of the reference RTL, as far as synthesis alone can tell.

use std::path::Path;

use serde_json::Value;

use crate::common;

/// Longest path of every block by the estimate, with 0.6 ns for each routed net [ns].
const LONGEST_NS: f64 = 7.0;

/// Block, begin of the primitive's name, how many. The TDC's CARRY4 are 200 of the chain, those of the
/// ones count's sums, and of the time.
const EXPECTED: &[(&str, &str, u64)] = &[
    ("depth_estimator", "DSP48E1", 10),
    ("depth_estimator", "RAMB36E1", 10),
    ("depth_estimator", "CARRY4", 41),
    ("estimator_histogram", "RAM256X1S", 16),
    ("histogram_builder", "RAM256X1S", 16),
    ("histogram_builder", "CARRY4", 4),
    ("tdc", "CARRY4", 324),
    ("tdc", "RAMB18E1", 1),
    ("centroid_estimator", "DSP48E1", 3),
    ("centroid_estimator", "CARRY4", 52),
    ("vcsel_driver", "CARRY4", 3),
];

#[test]
#[ignore = "long: ./check --full"]
fn every_block_of_the_reference_rtl_fits_into_a_cycle_of_a_kintex_7_by_the_estimate() {
    let output = common::output(Path::new("."), &["timing", "--part", "kintex7", "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let timed: Value = serde_json::from_slice(&output.stdout).unwrap();
    let estimate = |block: &str| &timed["blocks"][block]["kintex7"];
    let blocks = timed["blocks"].as_object().unwrap();
    assert_eq!(blocks.len(), 6);
    for name in blocks.keys() {
        let ns = estimate(name)["ns"][1].as_f64().unwrap();
        assert!(ns < LONGEST_NS, "{name}: {ns} ns, {:#}", estimate(name)["path"]);
        assert_eq!(estimate(name)["unknown"], Value::Array(Vec::new()), "{name}");
    }
    for (block, primitive, expected) in EXPECTED {
        let cells = estimate(block)["cells"].as_object().unwrap();
        let counts = cells.iter().filter(|(kind, _)| kind.starts_with(primitive));
        let count: u64 = counts.map(|(_, count)| count.as_u64().unwrap()).sum();
        assert_eq!(count, *expected, "{primitive} in {block}");
    }
    let dsps = &estimate("depth_estimator")["pipelined_dsps"];
    assert_eq!(dsps.as_u64(), Some(10), "DSP48E1 with AREG, BREG, MREG and PREG");
}
