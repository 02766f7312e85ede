//! Matching of signals by the rules of a map.

use std::collections::HashSet;

use tofsim::error::{Input, Result};
use tofsim::kernel::signals::SignalFormat as Shape;

use crate::source::{SignalKind, Source};
use crate::words::ones;

use super::super::find;
use super::super::map::{Rule, SignalMap, parse_mask};
use super::super::pair::{MatchedBy, Pair};
use super::super::parts::{Part, Slots, ordered};
use super::super::show::Show;
use super::matched::{Fits, Matching};

/// Returns whether more of the map's names exist with the sides swapped.
pub(super) fn is_swapped(sides: [&Source; 2], map: &SignalMap) -> bool {
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

/// Returns the pair that a rule names.
///
/// # Errors
/// If a side does not have the signal, or the widths differ.
pub(super) fn by_rule(
    sides: [&Source; 2],
    rule: &Rule,
    matching: &mut Matching,
    used: &mut [HashSet<usize>; 2],
    fits: Fits,
) -> Result<Pair> {
    let names = ordered(usize::from(matching.swapped), &rule.a, &rule.b);
    let mut parts: [Vec<Part>; 2] = Default::default();
    let mut first = [0, 0];
    for side in 0..2 {
        for (k, name) in names[side].iter().enumerate() {
            let slots = &mut matching.slots[side];
            let (signal, part) = find::part(sides[side], name, slots)
                .map_err(|error| Input::new("map", error).field("signal"))?;
            used[side].insert(sides[side].signals[signal].id);
            parts[side].push(part);
            if k == 0 {
                first[side] = signal;
            }
        }
    }
    let [width, other] = [0, 1].map(|side| parts[side].iter().map(|part| part.width).sum::<u32>());
    let [a, b] = [0, 1].map(|side| &sides[side].signals[first[side]]);
    let are_whole = parts.iter().all(|parts| matches!(parts[..], [Part { whole: true, .. }]));
    // The width of words may be unknown.
    if width != other && width > 0 && other > 0 && !(are_whole && fits(a, b)) {
        let expected = format!("expected signals of one width, not {width} and {other} bits");
        return Err(Input::new("map", expected).field(names[0].join(" ")).into());
    }
    let [name, other] = names.map(|parts| parts.join(" "));
    let is_event = a.kind == SignalKind::Event && b.kind == SignalKind::Event;
    let states = if are_whole {
        [a, b].map(|signal| signal.words.states.clone())
    } else {
        Default::default()
    };
    let width = if is_event { 1 } else { width };
    let pair = Pair { name, other, width, sides: parts, states, is_event, ..Pair::default() };
    let mut pair = Pair { how: MatchedBy::Map, show: Show::of(a, b), ..pair };
    pair.follow(rule, sides, matching)?;
    Ok(pair)
}

impl Pair {
    /// Applies the options of a rule to a pair.
    pub(super) fn follow(
        &mut self,
        rule: &Rule,
        sides: [&Source; 2],
        matching: &mut Matching,
    ) -> Result<()> {
        if let Some(name) = &rule.valid {
            let (_, part) = find::part(sides[0], name, &mut matching.slots[0])?;
            if part.width != 1 {
                let expected = "expected a signal of one bit";
                return Err(Input::new("map", expected).field("valid").value(name).into());
            }
            self.valid = Some(part.signal);
        }
        if self.is_event && (rule.latency != 0 || rule.valid.is_some()) {
            let expected = "expected a signal with values: events have no `latency` and no `valid`";
            return Err(Input::new("map", expected).field(&self.name).into());
        }
        self.signed = rule.signed.or(self.signed);
        if rule.signed.is_some() || rule.fraction.is_some() {
            self.states = Default::default();
        }
        match (rule.signed, rule.fraction) {
            (Some(true), fraction) => {
                self.show = Show::Shape(Shape::Signed { fraction: fraction.unwrap_or(0) });
            }
            (_, Some(fraction)) => self.show = Show::Fixed(fraction),
            (Some(false), None) => self.show = Show::Shape(Shape::Unsigned),
            (None, None) => {}
        }
        if let Some(text) = &rule.dont_care {
            let mask = parse_mask(text).unwrap_or_default();
            let beyond = |(k, word): (usize, &u64)| word & !ones(self.width, k) != 0;
            if mask.iter().enumerate().any(beyond) {
                let expected = format!("expected {} bits at most", self.width);
                return Err(Input::new("map", expected).field("dont_care").value(text).into());
            }
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
