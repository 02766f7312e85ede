//! A comparison as text, as JSON and as JUnit XML.

mod beats;

use std::io::stdout;
use std::path::Path;

use serde_json::{Value, json};

use tofsim::Note;
use tofsim::error::Result;
use tofsim_captures::compare::{Compared, Comparison, Described, MatchedBy, UnmatchedReason};
use tofsim_captures::source::Axis;

use crate::text::junit::{self, JunitCase, JunitOutcome};
use crate::text::table::{coloured, counted, grouped, table};

use super::writer::Findings;

/// Signals that are listed one by one.
const LISTED: usize = 24;
/// Signals without a partner of each side that are listed.
const UNMATCHED: usize = 8;

/// The verdict, what differs first, a line for each pair that differs, and what came together.
fn text(result: &Comparison, verbose: bool) -> String {
    let mut text = String::new();
    let names = ["expected", "got"];
    for (side, name) in result.sides.iter().zip(names) {
        text += &format!("{name:<9} {} ({})\n", side.name, side.format);
    }
    for (k, line) in result.alignment.lines().enumerate() {
        text += &format!("{:<9} {line}\n", if k == 0 { "aligned" } else { "" });
    }
    let places = match result.unit {
        "changes" => "instants",
        unit => unit,
    };
    let pairs = counted(result.pairs.len() as u64, "signals");
    text += &format!("compared  {pairs} at {}\n", counted(result.compared, places));
    text += &beats::counts(result);
    text += &matched(result, verbose);
    if !result.skipped.is_empty() {
        text += &format!(
            "skipped   {}, which --strict refuses\n",
            counted(result.skipped.len() as u64, "signals")
        );
    }
    for note in &result.notes {
        text += &format!("note      {note}\n");
    }
    text += "\n";
    if result.is_same() {
        return text + &coloured("same", true, &stdout()) + "\n";
    }
    text += &(coloured("different", false, &stdout()) + "\n");
    for difference in &result.differences {
        text += &format!("  {difference}\n");
    }
    for finding in &result.findings {
        text += &format!("  {}: {}\n", finding.kind, finding.text);
    }
    text += &beats::differing(result);
    if let Some(first) = result.differing().next() {
        text += &format!("\nfirst     {}\n{}", first_line(result, first), differing(result));
    }
    text
}

fn first_line(result: &Comparison, pair: &Compared) -> String {
    let Some(first) = &pair.first else { return String::new() };
    let [a, b] = [0, 1].map(|side| result.sides[side].place(first.at[side]));
    let place = if a == b { a } else { format!("{a} / {b}") };
    format!("{} at {place}: expected {}, got {}", pair.name, first.expected, first.got)
}

fn differing(result: &Comparison) -> String {
    let row = |pair: &Compared| {
        let first = pair.first.as_ref()?;
        Some([
            pair.name.clone(),
            format!("{} of {}", grouped(pair.differing), grouped(pair.compared)),
            result.sides[0].place(first.at[0]),
            first.expected.clone(),
            first.got.clone(),
            pair.overview.clone(),
        ])
    };
    let header = ["signal", "differs", "first", "expected", "got", "where"];
    let rows = result.differing().take(LISTED).filter_map(row);
    let more = match result.differing().count().checked_sub(LISTED) {
        None | Some(0) => String::new(),
        Some(more) => format!("... and {more} more signals\n"),
    };
    format!("\n{}\n{more}", table(header, rows, ..0))
}

/// Returns the matched and unmatched signals.
fn matched(result: &Comparison, verbose: bool) -> String {
    let count = |how: MatchedBy| result.pairs.iter().filter(|pair| pair.how == how).count();
    let aliases: usize = result.pairs.iter().map(|pair| pair.aliases).sum();
    let parts = [
        (count(MatchedBy::Name), "by name"),
        (count(MatchedBy::Suffix), "by the end of the name"),
        (count(MatchedBy::Tail), "by the ends of both names"),
        (count(MatchedBy::Map), "by the map"),
        (aliases, "more names of the same"),
    ];
    let parts = parts.iter().filter(|(count, _)| *count > 0);
    let parts: Vec<_> = parts.map(|(count, words)| format!("{count} {words}")).collect();
    let mut text = format!("matched   {}\n", parts.join(", "));
    if verbose {
        for pair in &result.pairs {
            let other = if pair.other == pair.name { "" } else { &pair.other };
            text += &format!("            {:<6} {} {other}\n", pair.how, pair.name);
        }
    }
    text += &guessed(result, verbose);
    for (side, which) in ["first", "second"].iter().enumerate() {
        let own = |reason: bool| {
            let unmatched = result.unmatched.iter().filter(move |u| u.side == side);
            unmatched.filter(move |u| (u.reason == UnmatchedReason::Ignored) == reason)
        };
        let (alone, ignored) = (own(false).count(), own(true).count());
        if alone > 0 {
            text += &format!("unmatched {alone} of the {which} side\n");
        }
        let shown = match result.lists_unmatched(side) {
            _ if verbose => usize::MAX,
            true => UNMATCHED,
            false => 0,
        };
        for unmatched in own(false).take(shown) {
            text += &format!("            {}: {}\n", unmatched.name, unmatched.reason);
        }
        if alone > shown {
            let more = if shown > 0 { "... and more" } else { "their names" };
            text += &format!("            {more} with -v\n");
        }
        if ignored > 0 {
            text += &format!("left out  {ignored} of the {which} side\n");
        }
    }
    text
}

/// The pairs of which only the ends of the names are alike, and the lines of a map that would put
/// another in place of the first.
fn guessed(result: &Comparison, verbose: bool) -> String {
    let guessed: Vec<_> = result.pairs.iter().filter(|pair| pair.how == MatchedBy::Tail).collect();
    let Some(first) = guessed.first() else { return String::new() };
    let shown = if verbose { 0 } else { UNMATCHED };
    let lines = guessed.iter().take(shown);
    let mut text: String =
        lines.map(|pair| format!("            {} and {}\n", pair.name, pair.other)).collect();
    if !verbose && guessed.len() > shown {
        text += "            ... and more with -v\n";
    }
    let quoted = |name: &str| toml::Value::from(name).to_string();
    let lines = [
        "# If one is wrong, lines like these in a --map name the right one:".to_owned(),
        "[[signal]]".to_owned(),
        format!("a = [{}]", quoted(&first.name)),
        format!("b = [{}]", quoted(&first.other)),
    ];
    text += &lines.map(|line| format!("            {line}\n")).concat();
    text
}

/// A comparison, and the notes on it.
pub struct ComparisonFindings<'a> {
    /// Both sides, and their differences.
    pub result: &'a Comparison,
    /// Notes on the scenario and the comparison.
    pub notes: &'a [Note],
    /// Whether all names are listed.
    pub verbose: bool,
}

impl Findings for ComparisonFindings<'_> {
    const SCHEMA: &'static str = "tofsim.compare/1";

    /// The object of two files; a record of a scenario goes over its last keys.
    fn json(&self) -> Value {
        let mut json = json(self.result);
        json["set"] = json!([]);
        json["hash"] = Value::Null;
        json["notes"] = json!(self.notes);
        json
    }

    fn text(&self) -> String {
        text(self.result, self.verbose)
    }
}

fn json(result: &Comparison) -> Value {
    let pair = |pair: &Compared| {
        let mut value = json!(pair);
        if let Some(first) = &pair.first {
            let number = |side: usize| result.sides[side].number(first.at[side]);
            value["first"]["at"] = json!([0, 1].map(number));
        }
        value
    };
    let unit = |side: &Described| match side.axis {
        Axis::Samples => "sample",
        Axis::Time(_) => "ps",
    };
    json!({
        "same": result.is_same(),
        "sides": result.sides.iter().map(|side| json!({
            "name": side.name,
            "format": side.format,
            "unit": unit(side),
        })).collect::<Vec<_>>(),
        "by": result.unit,
        "alignment": result.alignment,
        "offset": result.offset,
        "compared": result.compared,
        "beats": result.beats.as_ref().map(|found| beats::json(result, found)),
        "differences": result.differences,
        "findings": result.findings,
        "first": result.differing().next().map(pair),
        "signals": result.pairs.iter().map(pair).collect::<Vec<_>>(),
        "skipped": result.skipped,
        "unmatched": result.unmatched.iter().map(|unmatched| json!({
            "side": if unmatched.side == 0 { "a" } else { "b" },
            "name": unmatched.name,
            "reason": unmatched.reason.to_string(),
        })).collect::<Vec<_>>(),
    })
}

/// Writes a test suite with a case for each pair, and one for what is not of a signal's values.
///
/// # Errors
/// When it cannot be put into XML, or the file cannot be written.
pub fn write_junit(path: &Path, result: &Comparison) -> Result<()> {
    let [a, b] = [&result.sides[0].name, &result.sides[1].name];
    let pair = |pair: &Compared| {
        let failure = (pair.differing > 0).then(|| {
            let count =
                format!("{} of {} differ: {}", pair.differing, pair.compared, pair.overview);
            (first_line(result, pair), count)
        });
        JunitCase { name: pair.name.clone(), outcome: JunitOutcome::of(failure) }
    };
    let findings: Vec<_> = result.findings.iter().map(|f| f.text.as_str()).collect();
    let differs = !result.differences.is_empty();
    let failure = differs.then(|| (result.differences.join("; "), findings.join("\n")));
    let structure = JunitCase { name: "structure".to_owned(), outcome: JunitOutcome::of(failure) };
    let words = result.beats.as_ref().map(|found| {
        let first = beats::first_line(result, found);
        let failure = first.map(|first| (first, beats::counts(result)));
        JunitCase { name: "beats".to_owned(), outcome: JunitOutcome::of(failure) }
    });
    let cases = result.pairs.iter().map(pair).chain([structure]).chain(words);
    junit::write(path, "tofsim compare", format!("tofsim compare {a} {b}"), cases)
}
