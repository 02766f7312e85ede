//! Matching of signals by a common ending, below scopes that differ.

use std::collections::{HashMap, HashSet};

use crate::source::{Name, Source};

use super::matched::Fits;

/// Returns a name and all its endings, longest first.
pub(super) fn ends(text: &str) -> impl Iterator<Item = &str> {
    let inner = text.match_indices('.').map(|(place, _)| &text[place + 1..]);
    std::iter::once(text).chain(inner).filter(|end| !end.is_empty())
}

/// The signal of a side with a given ending, or an indication that there are several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ending {
    One(usize),
    Several,
}

/// Pairs remaining signals of both sides whose longest common ending belongs to no other signal, matched or not.
pub(super) fn by_tail(
    sides: [&Source; 2],
    names: &[Vec<Name>; 2],
    candidates: &[Vec<usize>; 2],
    left: &[Vec<usize>; 2],
    fits: Fits,
) -> Vec<[usize; 2]> {
    if left.iter().any(Vec::is_empty) {
        return Vec::new();
    }
    let [own, others] = [0, 1].map(|side| endings(sides[side], &names[side], &candidates[side]));
    let is_left: HashSet<usize> = left[1].iter().copied().collect();
    let partner = |&a: &usize| {
        let (end, &found) = ends(names[0][a].parts()).find_map(|end| others.get_key_value(end))?;
        let (Ending::One(b), Some(Ending::One(_))) = (found, own.get(end)) else { return None };
        let [a_signal, b_signal] = [&sides[0].signals[a], &sides[1].signals[b]];
        (fits(a_signal, b_signal) && is_left.contains(&b)).then_some([a, b])
    };
    left[0].iter().filter_map(partner).collect()
}

/// Indexes the names of a side by all their endings.
fn endings<'a>(
    source: &Source,
    names: &'a [Name],
    candidates: &[usize],
) -> HashMap<&'a str, Ending> {
    let mut endings: HashMap<&str, Ending> = HashMap::new();
    for &k in candidates {
        for end in ends(names[k].parts()) {
            match endings.get_mut(end) {
                Some(Ending::One(first)) if source.signals[*first].id == source.signals[k].id => {}
                Some(ending) => *ending = Ending::Several,
                None => drop(endings.insert(end, Ending::One(k))),
            }
        }
    }
    endings
}
