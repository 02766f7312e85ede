//! Where the words of a window lie in a longer sequence.

use std::collections::HashMap;

use super::script::{End, Script, script};

/// Words of the parts by which a window is found, the longest first.
const PARTS: [usize; 4] = [16, 8, 4, 1];
/// Places of a part in the window that are looked at.
const REPEATS: usize = 4;
/// Places that are tried.
const TRIED: usize = 8;
/// How many words a part may be moved by others lost or added, to count for the same place.
const NEAR: i64 = 16;

/// Where a window lies, as far as that is clear.
#[derive(Debug)]
pub(super) enum Placed {
    /// The words that are the same, by their numbers in both.
    Found(Script),
    /// It does as well at several places: the first word's.
    Ambiguous(Vec<i64>),
    /// It does at none.
    Nowhere,
}

/// Finds `window` in `whole`. With `both`, the ends of either are free, and not only those of `whole`.
pub(super) fn place(window: &[u32], whole: &[u32], both: bool) -> Placed {
    let end = if both { End::Either } else { End::First };
    let mut tried: Vec<Script> = Vec::new();
    for part in PARTS.into_iter().filter(|&part| part <= window.len()) {
        for anchor in anchors(window, whole, part) {
            let found = around(window, whole, anchor, end);
            let is_known = tried.iter().any(|other| {
                found.same.first() == other.same.first() || found.same.last() == other.same.last()
            });
            if !is_known {
                tried.push(found);
            }
        }
        if !tried.is_empty() {
            break;
        }
    }
    // The most that is the same, then the least that is not.
    tried.sort_by_key(|found| (std::cmp::Reverse(found.same.len()), found.edits));
    let Some(best) = tried.first() else { return Placed::Nowhere };
    let same = best.same.len();
    let missing = window.len() - same.min(window.len());
    if 2 * same < window.len() && !both {
        return Placed::Nowhere;
    }
    let near: Vec<_> = tried
        .iter()
        .filter(|other| window.len() - other.same.len().min(window.len()) <= 2 * missing)
        .collect();
    if near.len() > 1 {
        let first = |found: &&Script| found.same[0].1 as i64 - found.same[0].0 as i64;
        return Placed::Ambiguous(near.iter().map(first).collect());
    }
    tried.into_iter().next().map_or(Placed::Nowhere, Placed::Found)
}

/// Parts that both have, one for each place where many of them lie, the most first.
fn anchors(window: &[u32], whole: &[u32], part: usize) -> Vec<(usize, usize)> {
    let mut parts: HashMap<&[u32], Vec<usize>> = HashMap::new();
    for (k, words) in window.windows(part).enumerate() {
        let places = parts.entry(words).or_default();
        if places.len() < REPEATS {
            places.push(k);
        }
    }
    // For each offset how many parts lie there, and the first.
    let mut votes: HashMap<i64, (usize, (usize, usize))> = HashMap::new();
    for (k, words) in whole.windows(part).enumerate() {
        for &own in parts.get(words).into_iter().flatten() {
            votes.entry(k as i64 - own as i64).or_insert((0, (own, k))).0 += 1;
        }
    }
    let mut ranked: Vec<_> =
        votes.iter().map(|(&offset, &(count, at))| (count, offset, at)).collect();
    ranked.sort_by_key(|&(count, offset, _)| (std::cmp::Reverse(count), offset));
    let mut chosen: Vec<(i64, (usize, usize))> = Vec::new();
    for (_, offset, at) in ranked {
        let is_new = part == 1
            || chosen.iter().all(|(other, _)| (offset - other).abs() > NEAR)
            || window.len() < 4 * NEAR as usize;
        if chosen.len() < TRIED && is_new {
            chosen.push((offset, at));
        }
    }
    chosen.into_iter().map(|(_, at)| at).collect()
}

/// The script that goes through a word of both, with free ends.
fn around(window: &[u32], whole: &[u32], (a, b): (usize, usize), end: End) -> Script {
    let backward = |words: &[u32]| words.iter().rev().copied().collect::<Vec<_>>();
    // What lies further away than this cannot be reached with the edits that are looked for.
    let reach = |length: usize| length + super::script::MOST_EDITS;
    let from = b.saturating_sub(reach(a));
    let until = whole.len().min(b + reach(window.len() - a));
    let before = script(&backward(&window[..a]), &backward(&whole[from..b]), end);
    let after = script(&window[a..], &whole[b..until], end);
    let mirrored = before.same.iter().rev().map(|&(x, y)| (a - 1 - x, b - 1 - y));
    let same = mirrored.chain(after.same.iter().map(|&(x, y)| (a + x, b + y))).collect();
    Script {
        same,
        taken: [a + after.taken[0], b + after.taken[1]],
        edits: before.edits + after.edits,
        is_whole: before.is_whole && after.is_whole,
    }
}
