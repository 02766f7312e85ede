//! Promises of arrays, in which either the shots or the estimates decide how long a row takes.

use tofsim::scenario;

use super::recorded;
use crate::golden::setting::Setting;
use crate::verify::cycle_counts::{CountedDesign, promises};
use crate::verify::rtl::Rtl;

/// Returns the design of an array with so many rows, columns and banks, and other keys.
pub fn array(set: &[&str]) -> CountedDesign {
    let set: Vec<_> = set.iter().map(|line| (*line).to_owned()).collect();
    CountedDesign::of(&Setting::of(scenario::load("array", &set).unwrap()).unwrap().setup)
}

/// Proves the promises of such an array; returns the numbers.
fn scanned(set: &[&str]) -> Vec<u64> {
    let folder = tempfile::tempdir().unwrap();
    let rtl = Rtl::own(folder.path()).unwrap();
    let design = array(set);
    let promises = promises::of_scan(&design.scan.unwrap());
    let counts = recorded::count(&set.join(", "), &promises, &design, &rtl);
    counts.iter().for_each(|count| assert!(count.holds(), "{set:?}: {count:?}"));
    counts.iter().map(|count| count.expected).collect()
}

/// Rows, columns, banks and estimator of an array of few shots.
fn small_array([rows, columns, banks]: [u32; 3], estimator: &str) -> Vec<u64> {
    let size = [("rows", rows), ("columns", columns), ("banks", banks)];
    let mut set: Vec<_> = size.iter().map(|(key, n)| format!("array.{key}={n}")).collect();
    set.extend([format!("estimator.kind={estimator}"), "firmware.shots_per_frame=300".to_owned()]);
    scanned(&set.iter().map(String::as_str).collect::<Vec<_>>())
}

#[test]
fn rows_and_images_take_as_long_as_shots_say_where_estimates_are_hidden() {
    assert_eq!(small_array([4, 3, 2], "centroid"), [2073, 8292, 957]);
}

#[test]
#[ignore = "long: ./check --full"]
fn rows_and_images_take_as_long_as_estimates_say_where_those_last_longer_or_come_after() {
    assert_eq!(small_array([3, 2, 2], "likelihood"), [7563, 22689, 13067]);
    assert_eq!(small_array([2, 3, 1], "network"), [2880, 5760, 822]);
}
