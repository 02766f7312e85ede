//! Signals that belong together by their names.

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::source::{Name, Source};

use super::super::pair::{MatchedBy, Pair};
use super::super::parts::Part;
use super::super::show::Show;
use super::matched::{Matching, Unmatched, UnmatchedReason};

/// Signals of one name beyond which it says nothing about where they belong.
const COMMON: usize = 64;

/// The scopes of the two sides below which most names are the same: where a design hangs in a bench.
fn scopes(names: &[Vec<Name>; 2], candidates: &[Vec<usize>; 2]) -> Option<[String; 2]> {
    let mut by_last: HashMap<&str, [Vec<usize>; 2]> = HashMap::new();
    for side in 0..2 {
        for &k in &candidates[side] {
            by_last.entry(names[side][k].last()).or_default()[side].push(k);
        }
    }
    let mut votes: BTreeMap<[String; 2], usize> = BTreeMap::new();
    for [of_a, of_b] in by_last.values().filter(|sides| sides.iter().all(|k| k.len() <= COMMON)) {
        for &a in of_a {
            for &b in of_b {
                let (a, b) = (&names[0][a], &names[1][b]);
                let tail = a.tail(b);
                *votes.entry([a.scope(tail), b.scope(tail)]).or_default() += 1;
            }
        }
    }
    let (scopes, count) = votes.into_iter().max_by_key(|(_, count)| *count)?;
    (count >= 2 && scopes.iter().all(|scope| !scope.is_empty())).then_some(scopes)
}

/// The names as they are below those scopes, so that what hangs there has the same name.
fn below(names: &[Vec<Name>; 2], scopes: &[String; 2]) -> [Vec<Name>; 2] {
    [0, 1].map(|side| {
        let own = |name: &Name| match name.below(&scopes[side]) {
            Some(below) => Name::new(format!("{SHARED}.{below}")).spelled(name),
            None => name.clone(),
        };
        names[side].iter().map(own).collect()
    })
}

/// Stands for the scopes below which names are the same.
const SHARED: &str = "*";

/// For each signal of each side those of the other whose names share the most parts with its own.
type Best = [HashMap<usize, (usize, Vec<usize>)>; 2];

fn best(names: &[Vec<Name>; 2], candidates: &[Vec<usize>; 2]) -> Best {
    let mut by_last: HashMap<&str, Vec<usize>> = HashMap::new();
    for &k in &candidates[1] {
        by_last.entry(names[1][k].last()).or_default().push(k);
    }
    let mut best = Best::default();
    for &a in &candidates[0] {
        for &b in by_last.get(names[0][a].last()).into_iter().flatten() {
            let Some(mut common) = names[0][a].common(&names[1][b]) else { continue };
            if names[0][a].is(&names[1][b]) {
                common = usize::MAX / 2;
            }
            // Verilog tells `drain` from `Drain`; other tools do not.
            common = 2 * common + usize::from(names[0][a].ends_exactly_as(&names[1][b]));
            for (side, own, other) in [(0, a, b), (1, b, a)] {
                let (most, found) = best[side].entry(own).or_default();
                if common > *most {
                    (*most, *found) = (common, vec![other]);
                } else if common == *most {
                    found.push(other);
                }
            }
        }
    }
    best
}

/// Matches the candidates by name, and says why the others are left.
pub(super) fn by_name(
    sides: [&Source; 2],
    names: &[Vec<Name>; 2],
    candidates: &[Vec<usize>; 2],
    matching: &mut Matching,
) {
    let hung = scopes(names, candidates).map(|scopes| below(names, &scopes));
    let names = hung.as_ref().unwrap_or(names);
    let best = best(names, candidates);
    let mut pairs: HashMap<(usize, usize), usize> = HashMap::new();
    let mut joined = [HashSet::new(), HashSet::new()];
    let mut reasons: [HashMap<usize, UnmatchedReason>; 2] = Default::default();
    for &k in &candidates[0] {
        let Some((_, found)) = best[0].get(&k) else { continue };
        let a = &sides[0].signals[k];
        let mutual: Vec<usize> = (found.iter().copied())
            .filter(|b| best[1].get(b).is_some_and(|(_, back)| back.contains(&k)))
            .collect();
        let mut refuse = |side: usize, signal: usize, reason: UnmatchedReason| {
            reasons[side].entry(signal).or_insert(reason);
        };
        let Some(&first) = mutual.first() else { continue };
        let b = &sides[1].signals[first];
        if let Some(others) = several(sides[1], &mutual) {
            refuse(0, k, UnmatchedReason::Ambiguous(others));
            continue;
        }
        if let Some((_, back)) = best[1].get(&first)
            && let Some(others) = several(sides[0], back)
        {
            refuse(1, first, UnmatchedReason::Ambiguous(others));
            continue;
        }
        if a.width != b.width || a.kind != b.kind {
            refuse(0, k, UnmatchedReason::Width(a.width, b.width));
            mutual.iter().for_each(|&b_k| refuse(1, b_k, UnmatchedReason::Width(b.width, a.width)));
            continue;
        }
        joined[0].insert(a.id);
        joined[1].insert(b.id);
        if let Some(&pair) = pairs.get(&(a.id, b.id)) {
            matching.pairs[pair].aliases += 1;
            continue;
        }
        pairs.insert((a.id, b.id), matching.pairs.len());
        let [left, right] = &mut matching.slots;
        matching.pairs.push(Pair {
            name: a.name.text.clone(),
            other: b.name.text.clone(),
            how: if a.name.is(&b.name) { MatchedBy::Name } else { MatchedBy::Suffix },
            width: a.width,
            sides: [vec![Part::whole(left, a)], vec![Part::whole(right, b)]],
            show: Show::of(a, b),
            ..Pair::default()
        });
    }
    for side in 0..2 {
        for &k in &candidates[side] {
            let signal = &sides[side].signals[k];
            if joined[side].contains(&signal.id) {
                continue;
            }
            let reason = reasons[side].remove(&k).unwrap_or(UnmatchedReason::Alone);
            let name = signal.name.text.clone();
            matching.unmatched.push(Unmatched { side, name, signal: k, reason });
        }
    }
}

/// The names, if they are not all of one signal.
fn several(source: &Source, signals: &[usize]) -> Option<Vec<String>> {
    let ids: HashSet<usize> = signals.iter().map(|&k| source.signals[k].id).collect();
    let name = |&k: &usize| source.signals[k].name.text.clone();
    (ids.len() > 1).then(|| signals.iter().take(4).map(name).collect())
}
