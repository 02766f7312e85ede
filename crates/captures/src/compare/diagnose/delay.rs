//! Constant delays between two sequences of changes.

/// Time or number of a change, and the value from then on. The first of a sequence is its start.
pub(super) type Change = (u128, u64);

/// Fewest changes that must be late by the same time.
const FEWEST: usize = 2;
/// Largest number of changes at the start of a sequence that would be before the start of the other.
const SKIPPED: usize = 16;

/// Returns the constant time by which the changes of the second sequence are late, before an end up to which both are
/// complete; none if they are not late, or fit several times, as those of a clock do.
pub(super) fn delay(a: &[Change], b: &[Change], end: u128) -> Option<i128> {
    let ((&(start, _), a), (&(other, _), b)) = (a.split_first()?, b.split_first()?);
    let start = start.min(other);
    let skips = (1..=SKIPPED).flat_map(|skip| [[skip, 0], [0, skip]]);
    let lates = [[0, 0]].into_iter().chain(skips).filter_map(|[of_a, of_b]| {
        let late = b.get(of_b)?.0 as i128 - a.get(of_a)?.0 as i128;
        let is_it = late.unsigned_abs() <= (end.saturating_sub(start)) / 2
            && begins_before(&a[..of_a], late, start)
            && begins_before(&b[..of_b], -late, start)
            && follows(&a[of_a..], &b[of_b..], late, end);
        is_it.then_some(late)
    });
    let mut lates = lates.take(2);
    lates.next().filter(|&late| late != 0 && lates.next().is_none())
}

/// Returns whether these changes are not after the start if they are `late`.
fn begins_before(skipped: &[Change], late: i128, start: u128) -> bool {
    skipped.last().is_none_or(|last| last.0 as i128 + late <= start as i128)
}

/// Returns whether all changes are `late` on the second side; those at the end may be beyond it there.
fn follows(a: &[Change], b: &[Change], late: i128, end: u128) -> bool {
    let common = a.len().min(b.len());
    let is_late = |(a, b): (&Change, &Change)| a.1 == b.1 && b.0 as i128 - a.0 as i128 == late;
    let is_beyond = |rest: Option<&Change>, late: i128| {
        rest.is_none_or(|change| change.0 as i128 + late >= end as i128)
    };
    common >= FEWEST
        && is_beyond(a.get(common), late)
        && is_beyond(b.get(common), -late)
        && a.iter().zip(b).all(is_late)
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: [Change; 4] = [(0, 0), (10, 1), (30, 0), (35, 1)];

    fn late(changes: &[Change], by: u128) -> Vec<Change> {
        changes
            .iter()
            .enumerate()
            .map(|(k, &(at, v))| (if k > 0 { at + by } else { at }, v))
            .collect()
    }

    #[test]
    fn changes_that_are_all_late_by_the_same_time_have_a_delay() {
        let b = late(&A, 4);
        assert_eq!((delay(&A, &b, 50), delay(&b, &A, 50)), (Some(4), Some(-4)));
        assert_eq!(delay(&A, &A, 50), None);
        assert_eq!(delay(&A, &[(0, 0), (14, 1), (33, 0), (39, 1)], 50), None);
        assert_eq!(delay(&A, &[(0, 0), (14, 1), (34, 2), (39, 1)], 50), None);
        assert_eq!(delay(&A[..2], &b[..2], 50), None);
    }

    #[test]
    fn changes_may_be_missing_only_beyond_the_ends() {
        let b = late(&A, 4);
        assert_eq!(delay(&A, &b[..3], 39), Some(4));
        assert_eq!(delay(&A, &b[..3], 40), None);
        // What was before the start of one is after that of the other.
        let before = [(0, 1), (3, 0), (14, 1), (34, 0), (39, 1)];
        assert_eq!(delay(&A, &before, 50), Some(4));
        assert_eq!(delay(&before, &A, 50), Some(-4));
        let after = [(0, 1), (5, 0), (14, 1), (34, 0), (39, 1)];
        assert_eq!(delay(&A, &after, 50), None);
    }

    #[test]
    fn changes_that_repeat_fit_several_times() {
        let clock: Vec<Change> = (0..20).map(|k| (10 * k, k as u64 % 2)).collect();
        assert_eq!(delay(&clock, &late(&clock, 3), 200), None);
        assert_eq!(delay(&late(&clock, 3), &clock, 200), None);
    }
}
