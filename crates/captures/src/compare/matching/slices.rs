//! Matching of slices of a signal on one side with the whole signal on the other.

use std::collections::{HashMap, HashSet};

use crate::source::Source;

use super::super::find;
use super::super::pair::{MatchedBy, Pair};
use super::super::parts::{Part, ordered};
use super::super::show::Show;
use super::matched::{Matching, Unmatched, UnmatchedReason};

/// Matches each remaining signal that has a range in its name with those bits of the other side's signal.
///
/// The columns of a capture may be slices of one bus, which the waveform library joins. If the slices cover the whole
/// bus, it counts as matched. Slices of an excluded signal are excluded too.
pub(super) fn by_slice(sides: [&Source; 2], matching: &mut Matching) {
    let left_out = |left: &&Unmatched| left.reason == UnmatchedReason::Ignored;
    let ignored: HashSet<_> = matching.unmatched.iter().filter(left_out).map(key).collect();
    let mut parts: HashMap<(usize, usize), Vec<Part>> = HashMap::new();
    let Matching { pairs, unmatched, slots, .. } = matching;
    unmatched.retain_mut(|left| {
        if left.reason != UnmatchedReason::Alone
            || !left.name.ends_with(']')
            || !left.name.contains(':')
            || sides[1 - left.side]
                .called(sides[left.side].signals[left.signal].name.last())
                .is_empty()
        {
            return true;
        }
        let (own, other) = (left.side, 1 - left.side);
        let signal = &sides[own].signals[left.signal];
        let Ok((bus, part)) = find::part(sides[other], &left.name, &mut slots[other]) else {
            return true;
        };
        if part.width != signal.width || part.whole {
            return true;
        }
        if ignored.contains(&(other, bus)) {
            left.reason = UnmatchedReason::Ignored;
            return true;
        }
        parts.entry((other, bus)).or_default().push(part);
        let sides = ordered(own, vec![Part::whole(&mut slots[own], signal)], vec![part]);
        let [name, other] = [0, 1].map(|_| left.name.clone());
        let (how, width, show) = (MatchedBy::Suffix, signal.width, Show::of(signal, signal));
        pairs.push(Pair { name, other, how, width, sides, show, ..Pair::default() });
        false
    });
    unmatched.retain_mut(|left| {
        let Some(parts) = parts.get_mut(&key(left)) else { return true };
        let width = sides[left.side].signals[left.signal].width;
        left.reason = UnmatchedReason::Part(width - covered(parts));
        left.reason != UnmatchedReason::Part(0)
    });
}

fn key(left: &Unmatched) -> (usize, usize) {
    (left.side, left.signal)
}

/// Counts the bits of a signal that the parts cover.
fn covered(parts: &mut [Part]) -> u32 {
    parts.sort_unstable_by_key(|part| part.low);
    let (mut count, mut top) = (0, 0);
    for part in parts {
        let end = part.low + part.width;
        count += end.saturating_sub(top.max(part.low));
        top = top.max(end);
    }
    count
}
