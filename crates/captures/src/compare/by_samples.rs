//! Compares two sequences of samples, one by one, as an alignment says.

use tofsim::error::Result;

use crate::source::{Axis, SourceState};

use super::align::Alignment;
use super::delay::Delay;
use super::differences::{Differences, Spot};
use super::pair::Pair;
use super::plan::Plan;
use super::selection::{Piece, Place, Selected};

/// What came of a pass over both sequences.
#[derive(Clone, Debug, Default)]
pub(super) struct Passed {
    /// Samples compared.
    pub(super) compared: u64,
    /// Windows in which one side has ended before the other.
    pub(super) short: Vec<Short>,
}

/// That a side has ended before the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Short {
    pub(super) window: usize,
    pub(super) side: usize,
    /// Samples of the window that were compared.
    pub(super) count: u64,
    /// Whether the other side was to be compared so far.
    pub(super) is_wanted: bool,
}

/// Compares all pieces.
pub(super) fn compare(
    plan: &Plan,
    alignment: &Alignment,
    until_fs: u128,
    differences: &mut Differences,
) -> Result<Passed> {
    let pairs = &plan.matching.pairs;
    let mut sides = [
        Selected::new(plan.samples(0)?, &alignment.pieces[0]),
        Selected::new(plan.samples(1)?, &alignment.pieces[1]),
    ];
    let steady: Vec<usize> = (0..pairs.len()).filter(|&pair| !pairs[pair].is_plain()).collect();
    let mut delays: Vec<Delay> = steady.iter().map(|&pair| Delay::new(pair)).collect();
    let mut plain = PlainPairs::new(pairs);
    let mut passed = Passed::default();
    differences.touch_all();
    'pieces: loop {
        let mut count = 0;
        delays.iter_mut().for_each(Delay::clear);
        loop {
            let places = [sides[0].next()?, sides[1].next()?];
            let [Some(a), Some(b)] = places else {
                passed.short.extend(short(plan, &alignment.pieces, places, until_fs, count));
                break;
            };
            if is_over(plan, a, b) || is_late(plan, [a, b], until_fs) {
                break 'pieces;
            }
            for (side, selected) in sides.iter_mut().enumerate() {
                selected.samples.changes(|signal| differences.touch(side, signal));
            }
            let states = [sides[0].samples.state(), sides[1].samples.state()];
            let at = [a.sample.at, b.sample.at];
            let spot = Spot { order: passed.compared, window: a.piece, at };
            if let Some(both) = &mut differences.both {
                both.at(place_ps(plan, a))?;
            }
            let gaps = [a.sample.marks.gap, b.sample.marks.gap];
            for delay in &mut delays {
                delay.compare(plan, spot, (states, gaps), differences)?;
            }
            if gaps != [false, false] {
                continue;
            }
            plain.compare(spot, states, differences)?;
            passed.compared += 1;
            count += 1;
        }
        let more = [sides[0].next_piece(), sides[1].next_piece()];
        if more != [true, true] {
            break;
        }
    }
    for (pair, count) in differences.counts.iter_mut().enumerate() {
        if pairs[pair].is_plain() {
            count.compared = passed.compared;
        }
    }
    Ok(passed)
}

/// The pairs that are compared by the bits at one place alone.
struct PlainPairs<'a> {
    pairs: &'a [Pair],
    /// Whether each differs now, and those that do.
    wrong: Vec<bool>,
    differing: Vec<usize>,
    touched: Vec<u32>,
}

impl<'a> PlainPairs<'a> {
    fn new(pairs: &'a [Pair]) -> Self {
        let wrong = vec![false; pairs.len()];
        PlainPairs { pairs, wrong, differing: Vec::new(), touched: Vec::new() }
    }

    /// Compares those of which a side has changed, and counts all that differ.
    fn compare(
        &mut self,
        spot: Spot,
        states: [&SourceState; 2],
        differences: &mut Differences,
    ) -> Result<()> {
        differences.take_touched(&mut self.touched);
        for pair in self.touched.iter().map(|&pair| pair as usize) {
            if !self.pairs[pair].is_plain() {
                continue;
            }
            let same = differences.is_same(pair, states);
            if self.wrong[pair] == same {
                self.wrong[pair] = !same;
                match same {
                    true => self.differing.retain(|&other| other != pair),
                    false => self.differing.push(pair),
                }
            }
            differences.show(pair, states, !same)?;
        }
        for &pair in &self.differing {
            differences.count(pair, spot, states);
        }
        Ok(())
    }
}

/// Whether nothing more is said: a capture that does not say how many samples it has goes on as
/// long as another capture does, but not as long as a waveform.
fn is_over(plan: &Plan, a: Place, b: Place) -> bool {
    let held = [a.sample.held, b.sample.held];
    held == [true, true] || (plan.capture().is_some() && held != [false, false])
}

/// Whether that time is reached on the first side that has times.
fn is_late(plan: &Plan, places: [Place; 2], until_fs: u128) -> bool {
    let late = (0..2).find_map(|side| is_reached(plan, side, places[side], until_fs));
    late.unwrap_or(false)
}

/// Whether that time is reached, on a side that has times.
fn is_reached(plan: &Plan, side: usize, place: Place, until_fs: u128) -> Option<bool> {
    match plan.sources[side].axis {
        Axis::Time(tick) => Some(tick.femtoseconds(place.sample.at) >= until_fs),
        Axis::Samples => None,
    }
}

/// Time of a place in the waveform of both sides: the first side's, or its sample's number [ps].
fn place_ps(plan: &Plan, place: Place) -> u128 {
    match plan.sources[0].axis {
        Axis::Time(tick) => tick.femtoseconds(place.sample.at) / 1000,
        Axis::Samples => place.sample.at as u128,
    }
}

/// That one side has ended although its piece, or the other side, goes on.
fn short(
    plan: &Plan,
    pieces: &[Vec<Piece>; 2],
    places: [Option<Place>; 2],
    until_fs: u128,
    count: u64,
) -> Option<Short> {
    let side = places.iter().position(Option::is_none)?;
    let other = 1 - side;
    let place = places[other]?;
    if place.sample.held || is_reached(plan, other, place, until_fs) == Some(true) {
        return None;
    }
    let wanted = pieces[other].get(place.piece).and_then(|piece| piece.count());
    let is_wanted = wanted.is_some_and(|wanted| wanted > count);
    let window = place.piece;
    (is_wanted || wanted.is_none()).then_some(Short { window, side, count, is_wanted })
}
