//! Which signals belong together: by the map, by name, by the end of a name.

use std::collections::{BTreeMap, HashMap, HashSet};

use globset::{Glob, GlobSet, GlobSetBuilder};
use regex::Regex;

use crate::error::{Input, Result, nearest};
use crate::source::{Kind, Name, Source, shapes};

use super::find::{self, Slots};
use super::map::{Map, Rule, Side, parse_mask};
use super::pair::{How, Pair, Part};
use super::show::Show;

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
    let mut candidates: [Vec<usize>; 2] = Default::default();
    for side in 0..2 {
        for (k, signal) in sides[side].signals.iter().enumerate() {
            if used[side].contains(&signal.id) {
                continue;
            }
            let is_in = |set: &GlobSet| is_match(set, &names[side][k], &signal.name.text);
            let reason = match signal.kind {
                _ if is_in(&ignored) || (!choice.only.is_empty() && !is_in(&only)) => {
                    Reason::Ignored
                }
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
    for rule in map.signal.iter().filter(|rule| rule.b.is_empty()) {
        let pair = matching.pair(&rule.a[0])?;
        let mut changed = matching.pairs[pair].clone();
        changed.follow(rule, sides, &mut matching)?;
        matching.pairs[pair] = changed;
    }
    Ok(matching)
}

fn is_match(set: &GlobSet, name: &Name, text: &str) -> bool {
    let below = text.split_once('.').map_or(text, |(_, below)| below);
    [text, below, name.text.as_str(), name.last()].iter().any(|name| set.is_match(name))
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

/// Whether more of the map's names are found with the sides the other way round.
fn is_swapped(sides: [&Source; 2], map: &Map) -> bool {
    let found = |order: [usize; 2]| {
        let has = |side: usize, names: &[String]| {
            let part = |name: &String| find::part(sides[side], name, &mut Slots::default()).is_ok();
            usize::from(names.iter().all(part))
        };
        let rules = map.signal.iter().filter(|rule| !rule.b.is_empty());
        rules.map(|rule| has(order[0], &rule.a) + has(order[1], &rule.b)).sum::<usize>()
    };
    found([1, 0]) > found([0, 1])
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

impl Pair {
    /// Takes over what a rule says of how it is compared.
    fn follow(&mut self, rule: &Rule, sides: [&Source; 2], matching: &mut Matching) -> Result<()> {
        if let Some(name) = &rule.valid {
            let (_, part) = find::part(sides[0], name, &mut matching.slots[0])?;
            if part.width != 1 {
                let expected = "expected a signal of one bit";
                return Err(Input::new("map", expected).field("valid").value(name).into());
            }
            self.valid = Some(part.signal);
        }
        match (rule.signed, rule.fraction) {
            (Some(true), fraction) => self.show = Show::Signed(fraction.unwrap_or(0)),
            (_, Some(fraction)) => self.show = Show::Fixed(fraction),
            (Some(false), None) => self.show = Show::Unsigned,
            (None, None) => {}
        }
        if let Some(mask) = rule.dont_care.as_deref().and_then(parse_mask) {
            self.mask = mask.into_iter().map(|word| !word).collect();
        }
        self.invert |= rule.invert;
        if rule.latency != 0 {
            self.latency = if matching.swapped { -rule.latency } else { rule.latency };
        }
        self.tolerance = self.tolerance.max(rule.tolerance);
        Ok(())
    }
}

fn by_rule(
    sides: [&Source; 2],
    rule: &Rule,
    matching: &mut Matching,
    used: &mut [HashSet<usize>; 2],
) -> Result<Pair> {
    let mut names = [rule.a.as_slice(), rule.b.as_slice()];
    if matching.swapped {
        names.swap(0, 1);
    }
    let mut parts: [Vec<Part>; 2] = Default::default();
    let mut first = [0, 0];
    for side in 0..2 {
        for (k, name) in names[side].iter().enumerate() {
            let slots = &mut matching.slots[side];
            let (signal, part) = find::part(sides[side], name, slots)?;
            used[side].insert(sides[side].signals[signal].id);
            parts[side].push(part);
            if k == 0 {
                first[side] = signal;
            }
        }
    }
    let [width, other] = [0, 1].map(|side| parts[side].iter().map(|part| part.width).sum::<u32>());
    if width != other {
        let expected = format!("expected signals of one width, not {width} and {other} bits");
        return Err(Input::new("map", expected).field(names[0].join(" ")).into());
    }
    let [a, b] = [0, 1].map(|side| &sides[side].signals[first[side]]);
    let mut pair = Pair {
        name: names[0].join(" "),
        other: names[1].join(" "),
        aliases: 0,
        how: How::Map,
        width,
        sides: parts,
        show: shown(a, b, &shapes()),
        mask: Vec::new(),
        invert: false,
        latency: 0,
        tolerance: 0,
        valid: None,
    };
    pair.follow(rule, sides, matching)?;
    Ok(pair)
}

/// How the values of two signals are shown.
fn shown(
    a: &crate::source::Signal,
    b: &crate::source::Signal,
    known: &[(Name, crate::kernel::signals::Format)],
) -> Show {
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
        let rename = |signal: &crate::source::Signal| {
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

fn by_name(
    sides: [&Source; 2],
    names: &[Vec<Name>; 2],
    candidates: &[Vec<usize>; 2],
    matching: &mut Matching,
) {
    let hung = scopes(names, candidates).map(|scopes| below(names, &scopes));
    let names = hung.as_ref().unwrap_or(names);
    let best = best(names, candidates);
    let known = shapes();
    let mut pairs: HashMap<(usize, usize), usize> = HashMap::new();
    let mut joined = [HashSet::new(), HashSet::new()];
    let mut reasons: [HashMap<usize, Reason>; 2] = Default::default();
    for &k in &candidates[0] {
        let Some((_, found)) = best[0].get(&k) else { continue };
        let a = &sides[0].signals[k];
        let mutual: Vec<usize> = (found.iter().copied())
            .filter(|b| best[1].get(b).is_some_and(|(_, back)| back.contains(&k)))
            .collect();
        let mut refuse = |side: usize, signal: usize, reason: Reason| {
            reasons[side].entry(signal).or_insert(reason);
        };
        let Some(&first) = mutual.first() else { continue };
        let b = &sides[1].signals[first];
        if let Some(others) = several(sides[1], &mutual) {
            refuse(0, k, Reason::Ambiguous(others));
            continue;
        }
        if let Some((_, back)) = best[1].get(&first)
            && let Some(others) = several(sides[0], back)
        {
            refuse(1, first, Reason::Ambiguous(others));
            continue;
        }
        if a.width != b.width || a.kind != b.kind {
            refuse(0, k, Reason::Width(a.width, b.width));
            mutual.iter().for_each(|&b_k| refuse(1, b_k, Reason::Width(b.width, a.width)));
            continue;
        }
        joined[0].insert(a.id);
        joined[1].insert(b.id);
        if let Some(&pair) = pairs.get(&(a.id, b.id)) {
            matching.pairs[pair].aliases += 1;
            continue;
        }
        pairs.insert((a.id, b.id), matching.pairs.len());
        let whole = |slots: &mut Slots, signal: &crate::source::Signal| Part {
            signal: slots.place(signal.id),
            low: 0,
            width: signal.width,
            whole: true,
        };
        let [left, right] = &mut matching.slots;
        matching.pairs.push(Pair {
            name: a.name.text.clone(),
            other: b.name.text.clone(),
            aliases: 0,
            how: if a.name.is(&b.name) { How::Name } else { How::Suffix },
            width: a.width,
            sides: [vec![whole(left, a)], vec![whole(right, b)]],
            show: shown(a, b, &known),
            mask: Vec::new(),
            invert: false,
            latency: 0,
            tolerance: 0,
            valid: None,
        });
    }
    for side in 0..2 {
        for &k in &candidates[side] {
            let signal = &sides[side].signals[k];
            if joined[side].contains(&signal.id) {
                continue;
            }
            let reason = reasons[side].remove(&k).unwrap_or(Reason::Alone);
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
