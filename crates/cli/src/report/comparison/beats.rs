//! A comparison of beats as text and as JSON.

use serde_json::{Value, json};

use tofsim_captures::compare::{BeatDifference, BeatPlace, Beats, Comparison};

use crate::text::table::{counted, grouped, table};

/// Differences that are listed one by one.
const LISTED: usize = 24;

/// Returns the line with the numbers of beats.
pub(super) fn counts(result: &Comparison) -> String {
    let Some(found) = &result.beats else { return String::new() };
    let side = |k: usize| {
        let outside = match found.outside[k] {
            0 => String::new(),
            outside => format!(" ({} before or after)", grouped(outside)),
        };
        format!("{}{outside}", grouped(found.counts[k]))
    };
    let kinds = [
        (found.same, "the same"),
        (found.lost, "lost"),
        (found.repeated, "repeated"),
        (found.extra, "extra"),
        (found.changed, "changed"),
    ];
    let kinds = kinds.iter().filter(|(count, _)| *count > 0);
    let kinds: Vec<_> = kinds.map(|(count, word)| format!("{} {word}", grouped(*count))).collect();
    format!("beats     {} expected, {} got: {}\n", side(0), side(1), kinds.join(", "))
}

/// The first difference, if there is one.
pub(super) fn first_line(result: &Comparison, found: &Beats) -> Option<String> {
    let first = found.list.first()?;
    let [a, b] = [0, 1].map(|side| place(result, side, first.beats[side]));
    let of = |word: &Option<String>| word.clone().unwrap_or_else(|| "none".to_owned());
    let (expected, got) = (of(&first.expected), of(&first.got));
    Some(format!("{} word at {a} / {b}: expected {expected}, got {got}", first.kind))
}

/// The words that differ, the first on a line of its own.
pub(super) fn differing(result: &Comparison) -> String {
    let Some(found) = &result.beats else { return String::new() };
    let Some(first) = first_line(result, found) else { return String::new() };
    let row = |beat: &BeatDifference| {
        let [a, b] = [0, 1].map(|side| place(result, side, beat.beats[side]));
        let word = |word: &Option<String>| word.clone().unwrap_or_default();
        let (expected, got) = (word(&beat.expected), word(&beat.got));
        [beat.kind.to_string(), beat.window.to_string(), a, b, expected, got]
    };
    let header = ["word", "window", "expected at", "got at", "expected", "got"];
    let rows = found.list.iter().take(LISTED).map(row);
    let more = match found.differing() - (found.list.len().min(LISTED)) as u64 {
        0 => String::new(),
        more => format!("... and {} more\n", counted(more, "words")),
    };
    format!("\nfirst     {first}\n\n{}\n{more}", table(header, rows, ..0))
}

/// Returns the place of a beat on a side.
fn place(result: &Comparison, side: usize, place: Option<BeatPlace>) -> String {
    let Some(BeatPlace { sample, at, .. }) = place else { return "the end".to_owned() };
    let own = result.sides[side].place(at);
    if own.starts_with("sample") { own } else { format!("{own}, sample {sample}") }
}

/// Counts, and the first differences with their places: picoseconds or samples.
pub(super) fn json(result: &Comparison, found: &Beats) -> Value {
    let mut value = json!(found);
    if let Some(list) = value["list"].as_array_mut() {
        for (json, beat) in list.iter_mut().zip(&found.list) {
            for side in 0..2 {
                if let Some(place) = beat.beats[side] {
                    json["beats"][side]["at"] = json!(result.sides[side].number(place.at));
                }
            }
        }
    }
    value
}
