//! Diagnosis of missing, extra or shifted samples.

use super::super::result::{Compared, Finding};
use super::collect::Collected;

/// Largest number of missing or extra samples.
const STEP: usize = 64;
/// Largest shift of a window or a signal [samples].
pub(super) const SHIFT: usize = 4096;
/// Number of samples that must agree for a diagnosis.
const FEWEST: usize = 16;

/// Finds an explanation for differences of whole samples.
pub(super) fn finding(collected: &Collected, rest: &[&Compared]) -> Option<Finding> {
    let [a, b] = &collected.rows;
    let names: Vec<&str> = rest.iter().map(|pair| pair.name.as_str()).collect();
    let window = &collected.window;
    let first = a.iter().zip(b).position(|(a, b)| a != b)?;
    let place = collected.first + first as u64;
    for shift in 1..=SHIFT.min(a.len() / 2) {
        let late = if agree(a, &b[shift..]) {
            "later"
        } else if agree(&a[shift..], b) {
            "earlier"
        } else {
            continue;
        };
        let text = format!("{window}the second side is {shift} {} {late}", counted(shift));
        return Some(Finding::new("shifted window", &names, text));
    }
    for step in 1..=STEP.min(a.len() / 2) {
        // The values may stand still at first, so that more agree than do belong together.
        let later = |rows: &[u64]| first + step.min(rows.len() - first);
        let (kind, what) = if agree(&a[later(a)..], &b[first..]) && first > 0 {
            ("missing samples", "missing")
        } else if agree(&a[first..], &b[later(b)..]) && first > 0 {
            ("extra samples", "too many")
        } else {
            continue;
        };
        let text = format!(
            "{window}{step} {} {what} on the second side at or before sample {place}",
            counted(step)
        );
        return Some(Finding::new(kind, &names, text));
    }
    None
}

pub(super) fn counted(samples: usize) -> &'static str {
    if samples == 1 { "sample" } else { "samples" }
}

/// Returns whether two sequences are equal over their common length, which must be long enough.
fn agree(a: &[u64], b: &[u64]) -> bool {
    a.len().min(b.len()) >= FEWEST && a.iter().zip(b).all(|(a, b)| a == b)
}
