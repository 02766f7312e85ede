//! Comparison of the words that a bus accepts, regardless of their times: a stall is not a difference.

mod classify;
mod place;
mod script;
mod stream;

use std::ops::Range;

use tofsim::error::{Input, Result};

use super::align::windows_differ;
use super::operands::SideCondition;
use super::pair::Pair;
use super::parts::ordered;
use super::plan::Plan;
use super::result::{Beats, Comparison};
use crate::condition::Condition;
use crate::words::listed;

use classify::Classifier;
use place::{Placed, place};
use script::{End, MOST_EDITS, script};
use stream::{BeatWords, Stream, stream};

/// Number of positions listed in an error.
const LISTED: usize = 4;

/// Returns the pairs that form a word: those selected, or else all except the clock and those in the condition.
fn word<'a>(plan: &'a Plan, condition: &Condition, only: &[String]) -> Result<Vec<&'a Pair>> {
    let named: Vec<usize> =
        condition.names().filter_map(|name| plan.matching.pair(name).ok()).collect();
    let pairs = plan.matching.pairs.iter().enumerate();
    let chosen = pairs.filter(|(k, _)| !only.is_empty() || !named.contains(k));
    let pairs: Vec<&Pair> = chosen
        .map(|(_, pair)| pair)
        .filter(|pair| !plan.is_clock(pair) && !pair.is_event)
        .collect();
    if pairs.is_empty() {
        let expected = "no signal is compared but those of the condition; choose some (--signals)";
        return Err(Input::new("--beats", expected).into());
    }
    for pair in &pairs {
        let reason = match pair {
            Pair { latency: 1.. | ..=-1, .. } => "a latency",
            Pair { tolerance: 1.., .. } => "a tolerance",
            Pair { valid: Some(_), .. } => "`valid`",
            Pair { has_words: true, .. } => "words on one side and bits on the other",
            _ => continue,
        };
        let expected = format!("has {reason}, which cannot go with --beats");
        return Err(Input::new("map", expected).field(&pair.name).into());
    }
    Ok(pairs)
}

/// Compares the beats of both sides.
///
/// # Errors
/// If a side cannot be read or has no beats, or the position of a window is ambiguous.
pub(super) fn compare(
    plan: &mut Plan,
    condition: &Condition,
    only: &[String],
) -> Result<Comparison> {
    let mut conditions = Vec::new();
    for side in 0..2 {
        let source = plan.sources[side];
        conditions.push(SideCondition::new(source, side, &mut plan.matching, condition)?);
    }
    let pairs = word(plan, condition, only)?;
    let mut words = BeatWords::default();
    // A capture first: it says how far a simulation goes.
    let first = usize::from(plan.sources[1].is_capture());
    let mut streams = [Stream::default(), Stream::default()];
    for side in [first, 1 - first] {
        let more = streams[1 - side].samples;
        streams[side] = stream(plan, side, &conditions[side], &pairs, &mut words, more)?;
        if streams[side].beats.is_empty() {
            let expected = "has no beat: the condition never holds";
            return Err(plan.fault(side, expected).field("--beats").into());
        }
    }
    let alignment = "by the words of the beats".to_owned();
    let mut result = Comparison::new(plan.sources, "beats", alignment);
    let counts = streams.each_ref().map(|stream| stream.beats.len() as u64);
    let signals = pairs.iter().map(|pair| pair.name.clone()).collect();
    let mut beats = Beats { signals, counts, ..Beats::default() };
    match plan.sources.map(|source| source.is_capture()) {
        [true, true] => captures(&streams, &words, &mut result, &mut beats)?,
        [false, false] => {
            let [a, b] = &streams;
            let found = script(&a.words, &b.words, End::Both);
            let end = [0, 1].map(|side| {
                if found.is_whole { streams[side].words.len() } else { found.taken[side] }
            });
            let classifier = Classifier { sides: [a, b], words: &words, window: 0 };
            classifier.count(&found.same, [0, 0], end, &mut beats);
            too_many(found.is_whole, &mut result);
        }
        [is_first, _] => {
            windows(plan, usize::from(!is_first), &streams, &words, &mut result, &mut beats)?;
        }
    }
    result.compared = beats.same + beats.changed;
    result.beats = Some(beats);
    Ok(result)
}

fn too_many(is_whole: bool, result: &mut Comparison) {
    if !is_whole {
        let text = format!("more than {MOST_EDITS} words differ; the rest is not compared");
        result.differences.push(text);
    }
}

/// Compares windows of a capture with sections of a waveform, in order of time.
fn windows(
    plan: &Plan,
    side: usize,
    streams: &[Stream; 2],
    words: &BeatWords,
    result: &mut Comparison,
    beats: &mut Beats,
) -> Result<()> {
    let [capture, waveform] = [&streams[side], &streams[1 - side]];
    let (mut from, mut covered, mut found_at) = (0, 0, Vec::new());
    for (window, range) in capture.windows.iter().enumerate() {
        if range.is_empty() {
            result.notes.push(format!("window {window} has no beat"));
            continue;
        }
        let part = &capture.words[range.clone()];
        let found = clear(place(part, &waveform.words[from..], false), window, from)?;
        let same: Vec<(usize, usize)> =
            found.same.iter().map(|&(own, other)| (range.start + own, from + other)).collect();
        let [Some(first), Some(last)] = [same.first(), same.last()] else { continue };
        // The ends of the window have to be there too.
        let lead = first.0 - range.start;
        let begin = first.1.saturating_sub(lead).max(from);
        let end = (last.1 + range.end - last.0).min(waveform.words.len());
        found_at.push(format!("beat {begin}"));
        let same: Vec<_> =
            same.into_iter().map(|(own, other)| ordered(side, own, other).into()).collect();
        let begins = ordered(side, range.start, begin);
        let classifier = Classifier { sides: [&streams[0], &streams[1]], words, window };
        classifier.count(&same, begins, ordered(side, range.end, end), beats);
        too_many(found.is_whole, result);
        (from, covered) = (end, covered + end - begin);
    }
    let (shown, name) = (listed(&found_at, LISTED, ", ..."), &plan.sources[1 - side].name);
    result.alignment += &format!("; from {shown} of {name}");
    beats.outside[1 - side] = (waveform.words.len() - covered) as u64;
    Ok(())
}

/// Compares two captures window by window. Beats of one before the other begins or after it ends are not differences.
fn captures(
    streams: &[Stream; 2],
    words: &BeatWords,
    result: &mut Comparison,
    beats: &mut Beats,
) -> Result<()> {
    let [a, b] = streams;
    result.differences.extend(windows_differ(a.windows.len(), b.windows.len()));
    for (window, (own, other)) in a.windows.iter().zip(&b.windows).enumerate() {
        let parts: [&[u32]; 2] = [&a.words[own.clone()], &b.words[other.clone()]];
        let begins: [&Range<usize>; 2] = [own, other];
        if parts.iter().all(|part| part.is_empty()) {
            continue;
        }
        let found = clear(place(parts[0], parts[1], true), window, 0)?;
        let same: Vec<(usize, usize)> =
            found.same.iter().map(|&(x, y)| (begins[0].start + x, begins[1].start + y)).collect();
        let [Some(&first), Some(&last)] = [same.first(), same.last()] else { continue };
        let lead = (first.0 - own.start).min(first.1 - other.start);
        let tail = (own.end - last.0).min(other.end - last.1);
        let begin = [first.0 - lead, first.1 - lead];
        let end = [last.0 + tail, last.1 + tail];
        let classifier = Classifier { sides: [a, b], words, window };
        classifier.count(&same, begin, end, beats);
        too_many(found.is_whole, result);
        for (side, range) in begins.into_iter().enumerate() {
            beats.outside[side] += (begin[side] - range.start + range.end - end[side]) as u64;
        }
    }
    Ok(())
}

/// Returns the position of a window that was searched from a given beat on.
///
/// # Errors
/// If there is none, or it is ambiguous.
fn clear(placed: Placed, window: usize, from: usize) -> Result<script::Script> {
    match placed {
        Placed::Found(found) => Ok(found),
        Placed::Ambiguous(places) => {
            let places: Vec<_> =
                places.iter().map(|place| format!("beat {}", place + from as i64)).collect();
            let expected = format!(
                "window {window} is ambiguous, its words come at several places: {}; compare \
                 more signals, or less of the waveform (--after, --until)",
                listed(&places, LISTED, " and more")
            );
            Err(Input::new("--beats", expected).into())
        }
        Placed::Nowhere => {
            let expected = format!(
                "window {window} fits nowhere: less than half of its words come in their order"
            );
            Err(Input::new("--beats", expected).into())
        }
    }
}
