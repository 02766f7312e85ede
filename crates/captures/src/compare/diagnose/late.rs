//! Diagnosis of single signals that are late or early.

use tofsim::error::Result;

use super::super::parts::{Part, gather};
use super::super::plan::Plan;
use super::super::result::{Compared, Comparison, Finding};
use super::collect::{Collected, DiagnosedSignal, key};
use super::rows::{SHIFT, agree, counted};
use crate::words::Bits;

/// Largest number of signals that are diagnosed.
const SIGNALS: usize = 32;
/// Largest number of changes of a signal that are kept.
const CHANGES: usize = 1 << 16;
/// Fewest changes that must be late by the same time.
const FEWEST: usize = 2;

/// Finds the signals of which the second side has the same values some samples later or earlier.
pub(super) fn in_samples(collected: &Collected, rest: &[&Compared]) -> Vec<Finding> {
    let is_rest = |name: &str| rest.iter().any(|pair| pair.name == name);
    let pairs = collected.pairs.iter().filter(|[a, _]| is_rest(&a.name));
    let finding = |[a, b]: &[DiagnosedSignal; 2]| {
        let (name, a, b) = (&a.name, &a.values, &b.values);
        let changes = a.windows(2).filter(|two| two[0] != two[1]).count();
        let shift = |shift: &usize| {
            let late = agree(a, &b[*shift..]);
            (late || agree(&a[*shift..], b)).then_some(late)
        };
        let most = SHIFT.min(a.len().min(b.len()) / 2);
        // A periodic signal fits in several places.
        let mut shifts = (1..=most).filter_map(|n| Some((n, shift(&n)?)));
        let (Some((samples, late)), None) = (shifts.next(), shifts.next()) else { return None };
        if changes < FEWEST || (late && agree(&a[samples..], b)) {
            return None;
        }
        let (how, sign) = if late { ("later", "") } else { ("earlier", "-") };
        let text = format!(
            "{}{name} is {samples} {} {how} on the second side; --latency {name}={sign}{samples} \
             compares it so",
            collected.window,
            counted(samples)
        );
        Some(Finding::new("shifted signal", &[name], text))
    };
    pairs.filter_map(finding).collect()
}

/// Time of a change, and the value from then on.
type Change = (u128, u64);

/// Finds the signals that change on the second side as on the first, but later or earlier by a constant time.
pub(super) fn in_time(plan: &Plan, late_fs: i128, result: &Comparison) -> Result<Vec<Finding>> {
    let names: Vec<&str> = result.differing().map(|pair| pair.name.as_str()).collect();
    let pairs = plan.matching.pairs.iter().filter(|pair| names.contains(&pair.name.as_str()));
    let pairs: Vec<_> = pairs.filter(|pair| pair.is_plain()).take(SIGNALS).collect();
    if pairs.is_empty() {
        return Ok(Vec::new());
    }
    let parts = |side: usize| pairs.iter().map(|pair| &pair.sides[side][..]).collect::<Vec<_>>();
    let a = changes(plan, 0, &parts(0), 0)?;
    let b = changes(plan, 1, &parts(1), late_fs)?;
    let findings = pairs.iter().zip(a.iter().zip(&b)).filter_map(|(pair, (a, b))| {
        let late = delay(a, b)?;
        let (how, name) = (if late > 0 { "later" } else { "earlier" }, &pair.name);
        let ns = late.unsigned_abs() as f64 / 1e6;
        let text = format!("{name} is {ns} ns {how} on the second side");
        Some(Finding::new("shifted signal", &[name], text))
    });
    Ok(findings.collect())
}

/// Reads the changes of the slices on a side.
fn changes(
    plan: &Plan,
    side: usize,
    slices: &[&[Part]],
    late_fs: i128,
) -> Result<Vec<Vec<Change>>> {
    let (mut ids, mut users) = (Vec::new(), Vec::<Vec<usize>>::new());
    let mut own = Vec::new();
    for (k, parts) in slices.iter().enumerate() {
        let mut renumbered = parts.to_vec();
        for part in &mut renumbered {
            let id = plan.matching.slots[side].ids[part.signal];
            let place = ids.iter().position(|known| *known == id).unwrap_or_else(|| {
                ids.push(id);
                users.push(Vec::new());
                ids.len() - 1
            });
            part.signal = place;
            users[place].push(k);
        }
        own.push(renumbered);
    }
    let source = plan.sources[side];
    let mut cursor = source.read(&ids)?;
    let mut changes = vec![Vec::<Change>::new(); slices.len()];
    let (mut touched, mut bits) = (Vec::<usize>::new(), Bits::default());
    while let Some(at) = cursor.peek()? {
        let fs = source.axis.femtoseconds(at).unwrap_or(u128::from(at)) as i128 - late_fs;
        if fs >= plan.terms.until_fs as i128 {
            break;
        }
        cursor.take(|signal| touched.extend_from_slice(&users[signal]));
        for k in touched.drain(..) {
            gather(&own[k], &cursor.state, &mut bits);
            let value = key(&bits);
            let list: &mut Vec<Change> = &mut changes[k];
            let before = list.last().copied();
            if before.is_some_and(|(_, last)| last == value) || list.len() == CHANGES || fs < 0 {
                continue;
            }
            match list.last_mut() {
                Some(last) if last.0 == fs as u128 => last.1 = value,
                _ => list.push((fs as u128, value)),
            }
        }
    }
    Ok(changes)
}

/// Returns the constant time by which all changes but the first value are late [fs], unless it is 0. The last changes
/// of the earlier side may be beyond the end of the later one.
fn delay(a: &[Change], b: &[Change]) -> Option<i128> {
    let (a, b) = (a.get(1..)?, b.get(1..)?);
    let late = b.first()?.0 as i128 - a.first()?.0 as i128;
    let is_late = |(a, b): (&Change, &Change)| a.1 == b.1 && b.0 as i128 - a.0 as i128 == late;
    let common = a.len().min(b.len());
    let whole = late != 0
        && !is_periodic(a)
        && common >= FEWEST
        && a.len().abs_diff(b.len()) <= 1 + common / 4;
    (whole && a.iter().zip(b).all(is_late)).then_some(late)
}

/// Returns whether changes repeat, so that a delay is as good as another.
fn is_periodic(changes: &[Change]) -> bool {
    let is_period = |period: &usize| {
        let span = changes[*period].0 - changes[0].0;
        let again = changes[*period..].iter();
        changes.iter().zip(again).all(|(a, b)| a.1 == b.1 && b.0 - a.0 == span)
    };
    (1..=changes.len() / 2).any(|period| is_period(&period))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_that_are_all_late_by_the_same_time_have_a_delay() {
        let a = [(0, 0), (10, 1), (30, 0), (35, 1)];
        let b = [(0, 0), (14, 1), (34, 0), (39, 1)];
        assert_eq!(delay(&a, &b), Some(4));
        assert_eq!(delay(&b, &a), Some(-4));
        assert_eq!(delay(&a, &b[..3]), Some(4));
        assert_eq!(delay(&a, &a), None);
        assert_eq!(delay(&a, &[(0, 0), (14, 1), (33, 0), (39, 1)]), None);
        assert_eq!(delay(&a, &[(0, 0), (14, 1), (34, 2), (39, 1)]), None);
        assert_eq!(delay(&a[..2], &b[..2]), None);
        let clock =
            |late: u128| -> Vec<Change> { (0..9).map(|k| (10 * k + late, k as u64 % 2)).collect() };
        assert_eq!(delay(&clock(0), &clock(3)), None);
    }
}
