//! Slices of a signal on one side that are one signal on the other.

use crate::source::{Source, shapes};

use super::super::find;
use super::super::pair::{How, Pair, Part};
use super::{Matching, Reason, shown};

/// Matches what is left and has a range in its name with those bits of the other side's signal.
///
/// A capture's columns may have the slices of one bus; the library that reads waveforms joins them.
pub(super) fn by_slice(sides: [&Source; 2], matching: &mut Matching) {
    let known = shapes();
    let mut found = Vec::new();
    for (place, left) in matching.unmatched.iter().enumerate() {
        if left.reason != Reason::Alone || !left.name.ends_with(']') || !left.name.contains(':') {
            continue;
        }
        let (own, other) = (left.side, 1 - left.side);
        let signal = &sides[own].signals[left.signal];
        let part = find::part(sides[other], &left.name, &mut matching.slots[other]);
        if let Ok((whole, part)) = part
            && part.width == signal.width
            && !part.whole
        {
            found.push((place, whole, part));
        }
    }
    let mut gone: Vec<usize> = found.iter().map(|(place, ..)| *place).collect();
    for &(place, whole, part) in &found {
        let left = &matching.unmatched[place];
        let (own, other) = (left.side, 1 - left.side);
        let signal = &sides[own].signals[left.signal];
        let slot = matching.slots[own].place(signal.id);
        let mut parts = [Vec::new(), Vec::new()];
        parts[own].push(Part { signal: slot, low: 0, width: signal.width, whole: true });
        parts[other].push(part);
        matching.pairs.push(Pair {
            name: left.name.clone(),
            other: left.name.clone(),
            aliases: 0,
            how: How::Suffix,
            width: signal.width,
            sides: parts,
            show: shown(signal, signal, &known),
            signed: None,
            mask: Vec::new(),
            invert: false,
            latency: 0,
            tolerance: 0,
            valid: None,
        });
        let is_whole = |side: usize, signal: usize| side == other && signal == whole;
        let places = matching.unmatched.iter().enumerate();
        gone.extend(places.filter(|(_, u)| is_whole(u.side, u.signal)).map(|(place, _)| place));
    }
    let mut place = 0;
    matching.unmatched.retain(|_| {
        place += 1;
        !gone.contains(&(place - 1))
    });
}
