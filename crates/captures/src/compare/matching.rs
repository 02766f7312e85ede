//! Matching of signals: by map, by name, or by the end of a name.

mod matched;
mod names;
mod rules;
mod slices;
mod tails;

use std::collections::HashSet;

use regex::Regex;

use tofsim::error::{Input, Result};

use crate::choice::SignalChoice;
use crate::source::{Name, Signal, SignalKind, Source};

use super::map::{Side, SignalMap};

pub(super) use matched::Matching;
pub use matched::{Unmatched, UnmatchedReason};

use matched::Fits;
use names::by_name;
use rules::{by_rule, is_swapped};
use slices::by_slice;

/// Matches the signals of two sources.
///
/// # Errors
/// If the map names a signal that does not exist, or a pattern is invalid.
pub(super) fn matching(
    sides: [&Source; 2],
    map: &SignalMap,
    choice: &SignalChoice,
    fits: Fits,
) -> Result<Matching> {
    let mut matching = Matching { swapped: is_swapped(sides, map), ..Matching::default() };
    let mut used = [HashSet::new(), HashSet::new()];
    for rule in map.signal.iter().filter(|rule| !rule.b.is_empty()) {
        let pair = by_rule(sides, rule, &mut matching, &mut used, fits)?;
        matching.pairs.push(pair);
    }
    let names = renamed(sides, map, matching.swapped)?;
    let chosen = choice.patterns(&map.ignore)?;
    matching.pairs.retain(|pair| chosen.has(&[&pair.name, &pair.other], None));
    let mut candidates: [Vec<usize>; 2] = Default::default();
    for side in 0..2 {
        for (k, signal) in sides[side].signals.iter().enumerate() {
            if used[side].contains(&signal.id) {
                continue;
            }
            let (renamed, own) = (&names[side][k].text, &signal.name.text);
            let reason = match signal.kind {
                _ if !chosen.has(&[own], Some(renamed)) => UnmatchedReason::Ignored,
                SignalKind::Other => UnmatchedReason::Text,
                SignalKind::Bits | SignalKind::Real | SignalKind::Text | SignalKind::Event => {
                    candidates[side].push(k);
                    continue;
                }
            };
            let name = signal.name.text.clone();
            matching.unmatched.push(Unmatched { side, name, signal: k, reason });
        }
    }
    by_name(sides, &names, &candidates, &mut matching, fits);
    by_slice(sides, &mut matching);
    for rule in map.signal.iter().filter(|rule| rule.b.is_empty()) {
        let pair = matching.pair(&rule.a[0])?;
        let mut changed = matching.pairs[pair].clone();
        changed.follow(rule, sides, &mut matching)?;
        matching.pairs[pair] = changed;
    }
    Ok(matching)
}

fn renamed(sides: [&Source; 2], map: &SignalMap, swapped: bool) -> Result<[Vec<Name>; 2]> {
    let mut rules = Vec::new();
    for rename in &map.rename {
        let regex = Regex::new(&rename.pattern)
            .map_err(|error| Input::new("rename", error).value(&rename.pattern))?;
        rules.push((regex, rename));
    }
    let names = [0, 1].map(|side| {
        let own = if (side == 0) != swapped { Side::A } else { Side::B };
        let rules = rules.iter().filter(|(_, rename)| [own, Side::Both].contains(&rename.side));
        let rename = |signal: &Signal| {
            if rules.clone().next().is_none() {
                return signal.name.clone();
            }
            let mut text = signal.name.text.clone();
            for (regex, rename) in rules.clone() {
                text = regex.replace(&text, rename.by.as_str()).into_owned();
            }
            Name::new(text)
        };
        sides[side].signals.iter().map(rename).collect()
    });
    Ok(names)
}
