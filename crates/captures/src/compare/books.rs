//! The books of a comparison, closed: what goes into its result.

use crate::source::{Format, Name, shapes};

use super::Options;
use super::matching::Reason;
use super::plan::Plan;
use super::result::{Compared, Comparison, Described, Difference};
use super::tallies::Tallies;

/// A result with nothing in it yet.
pub(super) fn empty(plan: &Plan, unit: &'static str, alignment: String) -> Comparison {
    Comparison {
        sides: plan.sources.map(Described::new),
        unit,
        alignment,
        offset: None,
        compared: 0,
        pairs: Vec::new(),
        unmatched: Vec::new(),
        differences: Vec::new(),
        findings: Vec::new(),
        notes: Vec::new(),
    }
}

/// Puts the books into the result.
pub(super) fn compiled(plan: &Plan, tallies: &Tallies, options: &Options, result: &mut Comparison) {
    let known = shapes();
    let flow = |name: &str| {
        let name = Name::new(name);
        let place = known.iter().position(|(known, _)| {
            known.common(&name).is_some_and(|parts| parts >= 2 || parts == name.depth())
        });
        place.unwrap_or(known.len())
    };
    let pairs = plan.matching.pairs.iter().zip(&tallies.tallies);
    result.pairs = pairs
        .map(|(pair, tally)| Compared {
            name: pair.name.clone(),
            other: pair.other.clone(),
            how: pair.how,
            aliases: pair.aliases,
            width: pair.width,
            compared: tally.compared,
            differing: tally.differing,
            first: tally.first.as_ref().map(|first| Difference {
                order: first.spot.order,
                window: first.spot.piece,
                at: first.spot.at,
                expected: first.expected.clone(),
                got: first.got.clone(),
                bits: first.bits.clone(),
            }),
            strip: tally.strip.text(result.compared),
        })
        .collect();
    let order = |pair: &Compared| pair.first.as_ref().map_or(u64::MAX, |first| first.order);
    result.pairs.sort_by_cached_key(|pair| {
        let order = order(pair);
        (order, if order == u64::MAX { 0 } else { flow(&pair.name) })
    });
    for (pair, tally) in plan.matching.pairs.iter().zip(&tallies.tallies) {
        match tally.compared {
            0 if pair.latency != 0 => {
                let text = format!("{}: no sample has both sides with that latency", pair.name);
                result.differences.push(text);
            }
            0 if pair.valid.is_some() => {
                result.notes.push(format!("{} is compared nowhere: it is never valid", pair.name));
            }
            _ => {}
        }
    }
    result.unmatched = plan.matching.unmatched.clone();
    for unmatched in &result.unmatched {
        let needed = options.all || plan.sources[unmatched.side].is_capture();
        if needed && unmatched.reason != Reason::Ignored {
            let source = &plan.sources[unmatched.side].name;
            let reason = unmatched.reason.text();
            result
                .differences
                .push(format!("{source}: {} is not compared: {reason}", unmatched.name));
        }
    }
    if plan.matching.swapped {
        result.notes.push("the map's names are found with the sides exchanged".to_owned());
    }
    for (side, source) in plan.sources.iter().enumerate() {
        if source.format == Format::IlaVcd && !plan.sources[1 - side].is_capture() {
            let note = "does not say how many samples it has; compared up to its last change";
            result.notes.push(format!("the {} side {note}", ["first", "second"][side]));
        }
        if source.is_capture() && !source.radix_told && source.format != Format::IlaVcd {
            let side = ["first", "second"][side];
            result
                .notes
                .push(format!("the {side} side does not say in which radix its values are"));
        }
    }
}
