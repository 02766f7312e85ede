//! Diagnosis of single signals that are late or early.

use std::collections::{HashMap, HashSet};

use tofsim::error::Result;

use super::super::pair::Pair;
use super::super::plan::Plan;
use super::super::result::{Compared, Comparison, Finding};
use super::collect::{Collected, DiagnosedSignal, key};
use super::delay::{Change, delay};
use super::rows::{SHIFT, counted};
use crate::words::Bits;

/// Largest number of signals that are diagnosed.
const SIGNALS: usize = 32;
/// Largest number of changes of a signal that are kept.
const CHANGES: usize = 1 << 16;

/// Finds the signals of which the second side has the same values some samples later or earlier.
pub(super) fn in_samples(collected: &Collected, rest: &[&Compared]) -> Vec<Finding> {
    let names: HashSet<&str> = rest.iter().map(|pair| pair.name.as_str()).collect();
    let pairs = collected.pairs.iter().filter(|[a, _]| names.contains(a.name.as_str()));
    let finding = |[a, b]: &[DiagnosedSignal; 2]| {
        let [of_a, of_b] = [a, b].map(|signal| sampled(&signal.values));
        let end = a.values.len().min(b.values.len());
        let late = delay(&of_a, &of_b, end as u128)?;
        let samples = usize::try_from(late.unsigned_abs()).ok().filter(|&count| count <= SHIFT)?;
        let (how, sign) = if late > 0 { ("later", "") } else { ("earlier", "-") };
        let (window, name, of) = (&collected.window, &a.name, counted(samples));
        let text = format!(
            "{window}{name} is {samples} {of} {how} on the second side; --latency \
             {name}={sign}{samples} compares it so",
        );
        Some(Finding::new("shifted signal", &[name], text))
    };
    pairs.filter_map(finding).collect()
}

/// Returns the samples at which values change.
fn sampled(values: &[u64]) -> Vec<Change> {
    let values = values.iter().enumerate().map(|(at, &value)| (at as u128, value));
    let mut changes: Vec<Change> = values.collect();
    changes.dedup_by_key(|change| change.1);
    changes
}

/// Finds the signals that change on the second side, which is `late_fs` late, as on the first, but later or earlier by
/// a constant time.
pub(super) fn in_time(plan: &Plan, late_fs: i128, result: &Comparison) -> Result<Vec<Finding>> {
    let names: HashSet<&str> = result.differing().map(|pair| pair.name.as_str()).collect();
    let pairs = plan.matching.pairs.iter().filter(|pair| names.contains(pair.name.as_str()));
    let pairs: Vec<&Pair> = pairs.filter(|pair| pair.is_plain()).take(SIGNALS).collect();
    if pairs.is_empty() {
        return Ok(Vec::new());
    }
    let (a, end_a) = changes(plan, 0, &pairs, 0)?;
    let (b, end_b) = changes(plan, 1, &pairs, late_fs)?;
    let findings = pairs.iter().zip(a.iter().zip(&b)).filter_map(|(pair, (a, b))| {
        let late = delay(a, b, end_a.min(end_b))?;
        let (how, name) = (if late > 0 { "later" } else { "earlier" }, &pair.name);
        let ns = late.unsigned_abs() as f64 / 1e6;
        let text = format!("{name} is {ns} ns {how} on the second side");
        Some(Finding::new("shifted signal", &[name], text))
    });
    Ok(findings.collect())
}

/// Reads the changes of pairs on a side, from the start of the comparison on, and returns them with the time up to
/// which they are complete [fs].
fn changes(
    plan: &Plan,
    side: usize,
    pairs: &[&Pair],
    late_fs: i128,
) -> Result<(Vec<Vec<Change>>, u128)> {
    let (mut ids, mut users) = (Vec::new(), Vec::<Vec<usize>>::new());
    let mut places = HashMap::new();
    let mut own: Vec<Pair> = pairs.iter().map(|&pair| pair.clone()).collect();
    for (k, pair) in own.iter_mut().enumerate() {
        for part in &mut pair.sides[side] {
            let id = plan.matching.slots[side].ids[part.signal];
            part.signal = *places.entry(id).or_insert_with(|| {
                ids.push(id);
                users.push(Vec::new());
                ids.len() - 1
            });
            users[part.signal].push(k);
        }
    }
    let source = plan.sources[side];
    let mut cursor = source.read(&ids)?;
    let mut lists = vec![Vec::<Change>::new(); pairs.len()];
    let (mut touched, mut bits) = (Vec::<usize>::new(), Bits::default());
    let (mut full, mut end) = (0, 0);
    let common = |at: u64| {
        let fs = source.axis.femtoseconds(at).unwrap_or(u128::from(at)) as i128 - late_fs;
        u128::try_from(fs).unwrap_or(0).max(plan.terms.after.fs() as u128)
    };
    while let Some(at) = cursor.peek()?.filter(|_| full == 0) {
        end = common(at);
        if end >= plan.terms.until_fs {
            return Ok((lists, plan.terms.until_fs));
        }
        cursor.take(|signal| touched.extend_from_slice(&users[signal]));
        for k in touched.drain(..) {
            own[k].gather(side, &cursor.state, &mut bits);
            own[k].mask(&mut bits);
            note(&mut lists[k], (end, key(&bits)));
            full += usize::from(lists[k].len() == CHANGES);
        }
    }
    let stated = source.end.filter(|_| full == 0).map_or(0, common);
    Ok((lists, end.max(stated)))
}

/// Adds the value at a time; of several at one time, the last.
fn note(list: &mut Vec<Change>, (at, value): Change) {
    if list.last().is_some_and(|(last, _)| *last == at) {
        list.pop();
    }
    if list.last().is_none_or(|(_, last)| *last != value) {
        list.push((at, value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_several_values_at_one_time_the_last_counts() {
        let mut list = Vec::new();
        let changes = [(0, 1), (0, 2), (5, 3), (5, 2), (7, 4), (9, 4)];
        changes.into_iter().for_each(|change| note(&mut list, change));
        assert_eq!(list, [(0, 2), (7, 4)]);
        assert_eq!(sampled(&[3, 3, 4, 4, 3]), [(0, 3), (2, 4), (4, 3)]);
    }
}
