//! Diagnosis of differences: one flipped bit, a missing or an extra sample, a shifted window, a shifted signal, a
//! renamed probe, two swapped probes, or a wrong radix.

mod collect;
mod delay;
mod late;
mod radix;
mod rows;

use collect::{Collected, DiagnosedSignal, collect};

use tofsim::error::Result;

use super::align::Alignment;
use super::plan::Plan;
use super::result::{Compared, Comparison, Finding};

/// Diagnoses the differences of samples, by reading the window of the first difference again.
pub(super) fn samples(
    plan: &Plan,
    alignment: &Alignment,
    result: &Comparison,
) -> Result<Vec<Finding>> {
    let collected = collect(plan, alignment, result)?;
    let mut findings = renamed(&collected);
    findings.extend(swapped(&collected));
    findings.extend(radix::findings(plan, &collected));
    let explained = |name: &str| findings.iter().any(|f| f.signals.iter().any(|s| s == name));
    let rest: Vec<_> = result.differing().filter(|pair| !explained(&pair.name)).collect();
    match single(result, &rest) {
        Some(finding) => findings.push(finding),
        None if rest.is_empty() => {}
        None => match rows::finding(&collected, &rest) {
            Some(finding) => findings.push(finding),
            None => findings.extend(late::in_samples(&collected, &rest)),
        },
    }
    Ok(findings)
}

/// Diagnoses the differences of waveforms, of which the second is `late_fs` late, by reading the signals that differ
/// again.
pub(super) fn changes(plan: &Plan, late_fs: i128, result: &Comparison) -> Result<Vec<Finding>> {
    let rest: Vec<_> = result.differing().collect();
    match single(result, &rest) {
        Some(finding) => Ok(vec![finding]),
        None => late::in_time(plan, late_fs, result),
    }
}

/// Finds that all differences are one difference of one signal.
fn single(result: &Comparison, rest: &[&Compared]) -> Option<Finding> {
    let [pair] = rest else { return None };
    let first = pair.first.as_ref().filter(|_| pair.differing == 1)?;
    let bits: Vec<String> = first.bits.iter().map(u32::to_string).collect();
    let (kind, what) = match &bits[..] {
        [] => ("one value", "the value".to_owned()),
        [bit] => ("flipped bit", format!("bit {bit}")),
        _ => ("one value", format!("bits {}", bits.join(", "))),
    };
    let place = result.sides[1].place(first.at[1]);
    let text = format!("{what} of {} at one place, {place}", pair.name);
    Some(Finding::new(kind, &[&pair.name], text))
}

/// Finds signals without a partner that have the same values as a signal of the other side.
fn renamed(collected: &Collected) -> Vec<Finding> {
    let [own, others] = &collected.unpaired;
    let fits =
        |a: &DiagnosedSignal, b: &DiagnosedSignal| a.width == b.width && a.values == b.values;
    let mut findings = Vec::new();
    for a in own {
        let like: Vec<&DiagnosedSignal> = others.iter().filter(|b| fits(a, b)).collect();
        let back = own.iter().filter(|other| like.iter().any(|b| fits(other, b))).count();
        if let [b] = like[..]
            && back == 1
        {
            let text = format!(
                "{} of the first side and {} of the second have the same values: renamed?",
                a.name, b.name
            );
            findings.push(Finding::new("renamed", &[&a.name, &b.name], text));
        }
    }
    findings
}

/// Finds pairs that have each other's values.
fn swapped(collected: &Collected) -> Vec<Finding> {
    let mut findings = Vec::new();
    let pairs = &collected.pairs;
    for (k, [a, b]) in pairs.iter().enumerate() {
        for [c, d] in &pairs[k + 1..] {
            if a.width == c.width && a.values == d.values && c.values == b.values {
                let text = format!("{} and {} are swapped", a.name, c.name);
                findings.push(Finding::new("swapped", &[&a.name, &c.name], text));
            }
        }
    }
    findings
}
