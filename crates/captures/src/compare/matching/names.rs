//! Matching of signals by name.

use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use smallvec::SmallVec;

use crate::source::{Name, Signal, SignalKind, Source};

use super::super::pair::{MatchedBy, Pair};
use super::super::parts::ordered;
use super::matched::{Fits, Matching, Unmatched, UnmatchedReason};
use super::tails::{by_tail, ends};

/// Largest number of name pairs with the same last part that are evaluated to find the common scopes, rare names
/// first.
const VOTES: usize = 1 << 16;

/// Indices of signals that share a name, of which there is mostly one.
type Few = SmallVec<[usize; 2]>;

/// Finds the scopes of both sides below which most names agree, such as the instance of the design in a test bench.
fn scopes(names: &[Vec<Name>; 2], candidates: &[Vec<usize>; 2]) -> Option<[String; 2]> {
    let mut places: HashMap<&str, usize> = HashMap::new();
    let mut alike: Vec<[Few; 2]> = Vec::new();
    for side in 0..2 {
        for &k in &candidates[side] {
            let place = *places.entry(names[side][k].last()).or_insert(alike.len());
            if place == alike.len() {
                alike.push(Default::default());
            }
            alike[place][side].push(k);
        }
    }
    let pairs = |[a, b]: &[Few; 2]| a.len() * b.len();
    alike.sort_by_key(pairs);
    let mut votes: BTreeMap<[&str; 2], usize> = BTreeMap::new();
    let mut count = 0;
    for [of_a, of_b] in alike {
        count += of_a.len() * of_b.len();
        if count > VOTES {
            break;
        }
        for &a in &of_a {
            for &b in &of_b {
                let (a, b) = (&names[0][a], &names[1][b]);
                let tail = a.tail(b);
                let scopes = [a.scope(tail), b.scope(tail)];
                *votes.entry(scopes).or_default() += 1;
            }
        }
    }
    let (scopes, count) = votes.into_iter().max_by_key(|(_, count)| *count)?;
    let are_named = scopes.iter().all(|scope| !scope.is_empty());
    (count >= 2 && are_named).then(|| scopes.map(str::to_owned))
}

/// Replaces these scopes by a common name.
fn below(names: &[Vec<Name>; 2], scopes: &[String; 2]) -> [Vec<Name>; 2] {
    [0, 1].map(|side| {
        let own = |name: &Name| name.moved(&scopes[side], SHARED).unwrap_or_else(|| name.clone());
        names[side].iter().map(own).collect()
    })
}

/// Common name of the scopes below which names agree.
const SHARED: &str = "*";

/// Signals of the other side whose names have the most parts in common with a signal's.
#[derive(Clone, Debug, Default)]
struct Best {
    score: usize,
    found: Few,
    /// Names of the signals found, if they are not the same signal.
    several: Option<Vec<String>>,
}

impl Best {
    fn take(&mut self, score: usize, other: usize) {
        if score > self.score {
            self.score = score;
            self.found.clear();
            self.found.push(other);
        } else if score == self.score {
            self.found.push(other);
        }
    }
}

/// Finds the best partners of each candidate on each side.
fn best(
    sides: [&Source; 2],
    names: &[Vec<Name>; 2],
    candidates: &[Vec<usize>; 2],
) -> [Vec<Best>; 2] {
    let mut whole: [HashMap<&str, Few>; 2] = Default::default();
    let mut depths: [BTreeSet<usize>; 2] = Default::default();
    for side in 0..2 {
        for &k in &candidates[side] {
            whole[side].entry(names[side][k].parts()).or_default().push(k);
            depths[side].insert(names[side][k].depth());
        }
    }
    let mut best = [0, 1].map(|side| vec![Best::default(); names[side].len()]);
    for side in 0..2 {
        for &own in &candidates[side] {
            let name = &names[side][own];
            // Names that are the same are found from the first side.
            for (end, depth) in ends(name.parts()).zip((1..=name.depth()).rev()).skip(side) {
                if !depths[1 - side].contains(&depth) {
                    continue;
                }
                for &other in whole[1 - side].get(end).into_iter().flatten() {
                    let [a, b] = ordered(side, own, other);
                    let score = score(&names[0][a], &names[1][b]);
                    best[0][a].take(score, b);
                    best[1][b].take(score, a);
                }
            }
        }
    }
    for side in 0..2 {
        for best in &mut best[side] {
            best.found.sort_unstable();
            best.several = several(sides[1 - side], &best.found);
        }
    }
    best
}

/// Rates two names of which one is a suffix of the other.
fn score(a: &Name, b: &Name) -> usize {
    let parts = if a.is(b) { usize::MAX / 2 } else { a.depth().min(b.depth()) };
    // Verilog tells `drain` from `Drain`; other tools do not.
    2 * parts + usize::from(a.ends_exactly_as(b))
}

/// Matches candidates by name, and records the reasons for the others.
pub(super) fn by_name(
    sides: [&Source; 2],
    own: &[Vec<Name>; 2],
    candidates: &[Vec<usize>; 2],
    matching: &mut Matching,
    fits: Fits,
) {
    let hung = scopes(own, candidates).map(|scopes| below(own, &scopes));
    let names = hung.as_ref().unwrap_or(own);
    let best = best(sides, names, candidates);
    let mut pairs: HashMap<(usize, usize), usize> = HashMap::new();
    let mut joined = sides.map(|side| vec![false; side.id_count()]);
    let mut reasons: [HashMap<usize, UnmatchedReason>; 2] = Default::default();
    for &k in &candidates[0] {
        let found = &best[0][k];
        let a = &sides[0].signals[k];
        let is_mutual = |&b: &usize| best[1][b].score == found.score;
        let mutual: Few = found.found.iter().copied().filter(is_mutual).collect();
        let Some(&first) = mutual.first() else { continue };
        let b = &sides[1].signals[first];
        let refused = refused(sides, k, &mutual, &best[1][first], fits);
        if !refused.is_empty() {
            for (side, signal, reason) in refused {
                reasons[side].entry(signal).or_insert(reason);
            }
            continue;
        }
        joined[0][a.id] = true;
        joined[1][b.id] = true;
        match pairs.entry((a.id, b.id)) {
            Entry::Occupied(pair) => {
                matching.pairs[*pair.get()].aliases += 1;
                continue;
            }
            Entry::Vacant(place) => place.insert(matching.pairs.len()),
        };
        let how = if a.name.is(&b.name) { MatchedBy::Name } else { MatchedBy::Suffix };
        matching.pairs.push(Pair::whole([a, b], how, &mut matching.slots));
    }
    let is_alone = |side: usize, k: &usize| {
        !joined[side][sides[side].signals[*k].id] && !reasons[side].contains_key(k)
    };
    let alone = [0, 1].map(|side| {
        let alone = candidates[side].iter().copied();
        alone.filter(|k| is_alone(side, k)).collect::<Vec<_>>()
    });
    for [a, b] in by_tail(sides, own, candidates, &alone, fits) {
        let [a, b] = [&sides[0].signals[a], &sides[1].signals[b]];
        if !joined[0][a.id] && !joined[1][b.id] {
            (joined[0][a.id], joined[1][b.id]) = (true, true);
            matching.pairs.push(Pair::whole([a, b], MatchedBy::Tail, &mut matching.slots));
        }
    }
    for side in 0..2 {
        for &k in &candidates[side] {
            let signal = &sides[side].signals[k];
            if !joined[side][signal.id] {
                let reason = reasons[side].remove(&k).unwrap_or(UnmatchedReason::Alone);
                let name = signal.name.text.clone();
                matching.unmatched.push(Unmatched { side, name, signal: k, reason });
            }
        }
    }
}

/// Returns the sides and signals that cannot be matched, with reasons, of a signal of the first side and its mutual
/// partners, the first of which has the partners `back`.
fn refused(
    sides: [&Source; 2],
    own: usize,
    mutual: &[usize],
    back: &Best,
    fits: Fits,
) -> Vec<(usize, usize, UnmatchedReason)> {
    let (a, b) = (&sides[0].signals[own], &sides[1].signals[mutual[0]]);
    if let Some(others) = several(sides[1], mutual) {
        return vec![(0, own, UnmatchedReason::Ambiguous(others))];
    }
    if let Some(others) = &back.several {
        return vec![(1, mutual[0], UnmatchedReason::Ambiguous(others.clone()))];
    }
    if fits(a, b) {
        return Vec::new();
    }
    let reason = |own: &Signal, other: &Signal| match (own.kind, other.kind) {
        (SignalKind::Text, _) | (_, SignalKind::Text) => UnmatchedReason::Text,
        (own, other) if own != other => UnmatchedReason::Type(own.plural(), other.plural()),
        _ => UnmatchedReason::Width(own.width, other.width),
    };
    let theirs = mutual.iter().map(|&other| (1, other, reason(b, a)));
    [(0, own, reason(a, b))].into_iter().chain(theirs).collect()
}

/// Returns the names of some signals, if they are not the same signal.
fn several(source: &Source, signals: &[usize]) -> Option<Vec<String>> {
    if signals.len() < 2 {
        return None;
    }
    let ids: HashSet<usize> = signals.iter().map(|&k| source.signals[k].id).collect();
    let name = |&k: &usize| source.signals[k].name.text.clone();
    (ids.len() > 1).then(|| signals.iter().take(4).map(name).collect())
}
