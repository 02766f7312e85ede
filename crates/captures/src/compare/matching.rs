//! Which signals belong together: by the map, by name, by the end of a name.

mod names;
mod rules;
mod slices;

use std::collections::HashSet;

use globset::{Glob, GlobSet, GlobSetBuilder};
use regex::Regex;

use crate::source::{Kind, Name, Signal, Source};
use tofsim::error::{Input, Result, nearest};

use super::find::Slots;
use super::map::{Map, Side};
use super::pair::Pair;
use super::show::Show;

use names::by_name;
use rules::{by_rule, is_swapped};
use slices::by_slice;

/// A signal that has no partner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unmatched {
    /// 0 for the first side, 1 for the second.
    pub side: usize,
    /// Its name.
    pub name: String,
    /// Its index in the source.
    pub(super) signal: usize,
    /// Why.
    pub reason: Reason,
}

/// Why a signal has no partner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The other side has no signal of that name.
    Alone,
    /// The other side has several.
    Ambiguous(Vec<String>),
    /// The other side's has another width.
    Width(u32, u32),
    /// The other side has slices of it, but not so many of its bits.
    Part(u32),
    /// It is text or an event.
    Text,
    /// It was asked not to be compared.
    Ignored,
}

impl Reason {
    /// The reason in words.
    pub fn text(&self) -> String {
        match self {
            Reason::Alone => "no signal of that name on the other side".to_owned(),
            Reason::Ambiguous(names) => format!("several on the other side: {}", names.join(", ")),
            Reason::Width(own, other) => format!("{own} bits here, {other} on the other side"),
            Reason::Part(missing) => format!("{missing} of its bits are not on the other side"),
            Reason::Text => "text or events, which are not compared".to_owned(),
            Reason::Ignored => "left out".to_owned(),
        }
    }
}

/// What came together, and what did not.
#[derive(Clone, Debug, Default)]
pub(super) struct Matching {
    pub(super) pairs: Vec<Pair>,
    pub(super) unmatched: Vec<Unmatched>,
    /// Signals that each side has to read.
    pub(super) slots: [Slots; 2],
    /// Whether the map has the sides the other way round.
    pub(super) swapped: bool,
}

/// Which signals are looked at.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// Only these, with * and ?; all if there are none.
    pub only: Vec<String>,
    /// But these.
    pub ignore: Vec<String>,
}

/// Matches the signals of two sources.
///
/// # Errors
/// When the map names what there is not, or a pattern is none.
pub(super) fn matching(sides: [&Source; 2], map: &Map, choice: &Choice) -> Result<Matching> {
    let mut matching = Matching { swapped: is_swapped(sides, map), ..Matching::default() };
    let mut used = [HashSet::new(), HashSet::new()];
    for rule in map.signal.iter().filter(|rule| !rule.b.is_empty()) {
        let pair = by_rule(sides, rule, &mut matching, &mut used)?;
        matching.pairs.push(pair);
    }
    let names = renamed(sides, map, matching.swapped)?;
    let ignored = globs(choice.ignore.iter().chain(&map.ignore), "--ignore")?;
    let only = globs(choice.only.iter(), "--signals")?;
    let is_left_out = |is_in: &dyn Fn(&GlobSet) -> bool| {
        is_in(&ignored) || (!choice.only.is_empty() && !is_in(&only))
    };
    matching.pairs.retain(|pair| {
        !is_left_out(&|set| [&pair.name, &pair.other].iter().any(|name| is_match(set, name, name)))
    });
    let mut candidates: [Vec<usize>; 2] = Default::default();
    for side in 0..2 {
        for (k, signal) in sides[side].signals.iter().enumerate() {
            if used[side].contains(&signal.id) {
                continue;
            }
            let (renamed, own) = (&names[side][k].text, &signal.name.text);
            let is_in = |set: &GlobSet| is_match(set, renamed, own);
            let reason = match signal.kind {
                _ if is_left_out(&is_in) => Reason::Ignored,
                Kind::Other => Reason::Text,
                Kind::Bits | Kind::Real => {
                    candidates[side].push(k);
                    continue;
                }
            };
            let name = signal.name.text.clone();
            matching.unmatched.push(Unmatched { side, name, signal: k, reason });
        }
    }
    by_name(sides, &names, &candidates, &mut matching);
    by_slice(sides, &mut matching);
    for rule in map.signal.iter().filter(|rule| rule.b.is_empty()) {
        let pair = matching.pair(&rule.a[0])?;
        let mut changed = matching.pairs[pair].clone();
        changed.follow(rule, sides, &mut matching)?;
        matching.pairs[pair] = changed;
    }
    Ok(matching)
}

fn is_match(set: &GlobSet, renamed: &str, text: &str) -> bool {
    let below = text.split_once('.').map_or(text, |(_, below)| below);
    let last = text.rsplit(['.', '/']).next().unwrap_or(text);
    [text, below, renamed, last].iter().any(|name| set.is_match(name))
}

fn globs<'a>(texts: impl Iterator<Item = &'a String>, option: &str) -> Result<GlobSet> {
    let mut set = GlobSetBuilder::new();
    for text in texts {
        let glob = Glob::new(text).map_err(|error| {
            Input::new(option, format!("expected a pattern: {}", error.kind())).value(text)
        })?;
        set.add(glob);
    }
    let fault = |error: globset::Error| Input::new(option, error.kind());
    Ok(set.build().map_err(fault)?)
}

impl Matching {
    /// The pair that a user calls so.
    ///
    /// # Errors
    /// When there is none, or several.
    pub(super) fn pair(&self, text: &str) -> Result<usize> {
        let wanted = Name::new(text);
        let named = |name: &String| Name::new(name.clone()).common(&wanted) == Some(wanted.depth());
        let found: Vec<usize> = (self.pairs.iter().enumerate())
            .filter(|(_, pair)| named(&pair.name) || named(&pair.other))
            .map(|(k, _)| k)
            .collect();
        let fault = |expected: String| Input::new("compared signals", expected).field(text);
        match found[..] {
            [pair] => Ok(pair),
            [] => {
                let names = self.pairs.iter().map(|pair| pair.name.as_str());
                let near = nearest(text, names).map(|name| format!("; near it: {name}"));
                Err(fault(format!("no such signal{}", near.unwrap_or_default())).into())
            }
            _ => {
                let names: Vec<_> =
                    found.iter().take(4).map(|&k| self.pairs[k].name.as_str()).collect();
                Err(fault(format!("several are called so: {}", names.join(", "))).into())
            }
        }
    }
}

fn renamed(sides: [&Source; 2], map: &Map, swapped: bool) -> Result<[Vec<Name>; 2]> {
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

/// How the values of two signals are shown.
fn shown(a: &Signal, b: &Signal, known: &[(Name, tofsim::kernel::signals::SignalFormat)]) -> Show {
    if a.kind == Kind::Real {
        return Show::Real;
    }
    let ours = || {
        let mut found = known.iter().filter(|(name, _)| {
            [&a.name, &b.name]
                .iter()
                .any(|signal| name.common(signal).is_some_and(|parts| parts >= 2))
        });
        found.next().map(|(_, shape)| *shape)
    };
    let radix = a.radix.or(b.radix).map(Show::radix);
    let shape = a.shape.or(b.shape).map(Show::shape);
    shape.or(radix).or_else(|| ours().map(Show::shape)).unwrap_or(Show::Bits)
}
