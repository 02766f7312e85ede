//! Location of a window's words in a longer sequence.

use std::collections::HashMap;

use super::script::{End, Script, script};

/// Lengths of the sections by which a window is located, longest first [words].
const PARTS: [usize; 4] = [16, 8, 4, 1];
/// Largest number of occurrences of a section in the window that are considered.
const REPEATS: usize = 4;
/// Largest number of positions that are tried.
const TRIED: usize = 8;
/// Distance between positions that count as one, because of lost or added words [words].
const NEAR: i64 = 16;

/// Result of locating a window.
#[derive(Debug)]
pub(super) enum Placed {
    /// Found: the equal words, by their numbers on both sides.
    Found(Script),
    /// Ambiguous: the equally good positions of the first word.
    Ambiguous(Vec<i64>),
    /// Not found.
    Nowhere,
}

/// Locates `window` in `whole`. With `both`, either may extend beyond the other; otherwise only `whole` may.
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

/// Returns common sections, one for each position that many of them indicate, most frequent first.
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

/// Returns the edit script that matches a given word of both sides, with free ends.
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
