//! Comparison of two sequences of samples that an alignment pairs.

use std::collections::BTreeSet;

use tofsim::error::Result;

use crate::source::SourceState;

use super::align::{Align, Alignment};
use super::delay::Delay;
use super::differences::{Differences, Spot};
use super::plan::Plan;
use super::result::Comparison;
use super::selection::{Piece, SamplePlace, Selected};

/// Compares all pieces of an alignment.
pub(super) fn compare(
    plan: &Plan,
    align: &Align,
    alignment: &Alignment,
    differences: &mut Differences,
) -> Result<Comparison> {
    let mut result = Comparison::new(plan.sources, "samples", alignment.found.clone());
    result.offset = alignment.offset;
    result.differences = alignment.differences.clone();
    let pairs = &plan.matching.pairs;
    let mut sides = [
        Selected::new(plan.samples(0)?, &alignment.pieces[0]),
        Selected::new(plan.samples(1)?, &alignment.pieces[1]),
    ];
    let late = (0..pairs.len()).filter(|&pair| !pairs[pair].is_plain());
    let mut delays: Vec<Delay> = late.map(Delay::new).collect();
    // Plain pairs that differ at the present sample.
    let mut differing = BTreeSet::new();
    differences.touch_all();
    'pieces: loop {
        let mut count = 0;
        delays.iter_mut().for_each(Delay::clear);
        loop {
            let places = [sides[0].next()?, sides[1].next()?];
            let [Some(a), Some(b)] = places else {
                short(plan, align, &alignment.pieces, places, count, &mut result);
                break;
            };
            if is_over(plan, a, b) || is_late(plan, [a, b]) {
                break 'pieces;
            }
            for (side, selected) in sides.iter_mut().enumerate() {
                selected.samples.changes(|signal| differences.touch(side, signal));
            }
            let states = [&sides[0].samples.state, &sides[1].samples.state];
            let at = [a.sample.at, b.sample.at];
            let spot = Spot { order: result.compared, window: a.piece, at };
            if let Some(both) = &mut differences.both {
                both.at(plan.sources[0].axis, a.sample.at)?;
            }
            let gaps = [a.sample.marks.gap, b.sample.marks.gap];
            for delay in &mut delays {
                delay.compare(plan, spot, states, gaps, differences)?;
            }
            if gaps != [false, false] {
                continue;
            }
            compare_touched(plan, spot, states, (count == 0, &mut differing), differences)?;
            result.compared += 1;
            count += 1;
        }
        if [sides[0].next_piece(), sides[1].next_piece()] != [true, true] {
            break;
        }
    }
    let counts = pairs.iter().zip(&mut differences.counts);
    counts
        .filter(|(pair, _)| pair.is_plain())
        .for_each(|(_, count)| count.compared = result.compared);
    Ok(result)
}

/// Compares the plain pairs that have changed, and counts all plain pairs that differ at a sample. An event belongs to
/// the sample after it; before the first one, the sides may have read different parts.
fn compare_touched(
    plan: &Plan,
    spot: Spot,
    states: [&SourceState; 2],
    (is_first, differing): (bool, &mut BTreeSet<usize>),
    differences: &mut Differences,
) -> Result<()> {
    let pairs = &plan.matching.pairs;
    let touched = differences.take_touched();
    differing.retain(|&pair| !pairs[pair].is_event);
    if is_first {
        differences.end_events(&touched);
    }
    for &pair in touched.iter().filter(|&&pair| pairs[pair].is_plain()) {
        if differences.differs(pair, states)? {
            differing.insert(pair);
        } else {
            differing.remove(&pair);
        }
    }
    for &pair in &*differing {
        differences.count(pair, spot, states);
    }
    differences.end_events(&touched);
    Ok(())
}

/// Returns whether a capture that does not state its number of samples has ended at this place: its last values
/// extend as far as another capture, but not as far as a waveform.
fn is_over(plan: &Plan, a: SamplePlace, b: SamplePlace) -> bool {
    let is_extended = [a.sample.is_extended, b.sample.is_extended];
    is_extended == [true, true] || (plan.capture().is_some() && is_extended != [false, false])
}

/// Returns whether the end of the comparison is reached on the first side that has times.
fn is_late(plan: &Plan, places: [SamplePlace; 2]) -> bool {
    (0..2).find_map(|side| plan.is_reached(side, places[side].sample)) == Some(true)
}

/// Records a difference if one side has ended before its piece or the other side.
fn short(
    plan: &Plan,
    align: &Align,
    pieces: &[Vec<Piece>; 2],
    places: [Option<SamplePlace>; 2],
    count: u64,
    result: &mut Comparison,
) {
    let ended = usize::from(places[0].is_some());
    let other = 1 - ended;
    let Some(place) = places[other] else { return };
    if place.sample.is_extended || plan.is_reached(other, place.sample) == Some(true) {
        return;
    }
    let wanted = pieces[other].get(place.piece).and_then(|piece| piece.count());
    let is_wanted = wanted.is_some_and(|wanted| wanted > count);
    if !is_wanted && wanted.is_some() {
        return;
    }
    let [name, longer] = [ended, other].map(|side| &plan.sources[side].name);
    let window = place.piece;
    let text = format!("window {window}: {name} ends after {count} samples, before {longer} does");
    match plan.capture() {
        capture if is_wanted || capture == Some(other) => result.differences.push(text),
        Some(_) => {}
        None if *align == Align::Start => {
            result.differences.push(format!("{text} (--until ends earlier)"));
        }
        None => result.notes.push(text),
    }
}
