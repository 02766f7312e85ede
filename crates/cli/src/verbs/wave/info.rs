//! `tofsim wave info`: what a waveform has.

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::waves::dump::SignalDescription;
use tofsim_captures::source::{Axis, Signal, Source};
use tofsim_captures::wave::Contents;

use crate::record::MARK;
use crate::report::writer::{Findings, Report};
use crate::text::table::{facts, grouped, table};

use super::super::terminal::Console;
use super::excerpt::InputArgs;

/// Show format, duration and signals of a waveform
///
/// Signals are listed with -v, and by --json.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  tofsim wave info waves/kc705.vcd")]
pub(super) struct Args {
    #[command(flatten)]
    input: InputArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args, console: &Console) -> Result<()> {
    let source = args.input.open(console)?;
    let findings =
        Info { contents: Contents::of(&source), source: &source, lists: console.verbose };
    Report::without_record(findings).deliver(None, args.json, console)
}

/// The contents of a source.
struct Info<'a> {
    source: &'a Source,
    contents: Contents,
    /// Whether the signals are listed.
    lists: bool,
}

/// Indices of the bits, as they are part of the name.
fn range(signal: &Signal) -> String {
    signal.range.map_or(String::new(), |[high, low]| format!("[{high}:{low}]"))
}

impl Findings for Info<'_> {
    const SCHEMA: &'static str = "tofsim.wave_info/1";

    fn json(&self) -> Value {
        let Info { source, contents, .. } = self;
        let signal = |signal: &Signal| {
            let states = signal.words.states.iter();
            let states: serde_json::Map<String, Value> =
                states.map(|state| (state.name.clone(), state.bits.into())).collect();
            json!({
                "name": signal.name.text,
                "type": Contents::type_of(signal),
                "width": Contents::width(signal),
                "range": signal.range,
                "states": states,
                "value_type": stated(signal, |known| &known.value_type),
                "meaning": meaning(signal),
                "id": signal.id,
            })
        };
        json!({
            "file": source.name,
            "format": source.format.to_string(),
            "unit": unit(source.axis),
            "resolution": resolution(source.axis),
            "end": source.end.map(|end| source.axis.place_number(end)),
            "scopes": contents.scopes,
            "names": contents.names,
            "different_signals": contents.signals,
            "bits": contents.bits,
            "types": contents.types,
            "comments": source.comments,
            "signals": source.signals.iter().map(signal).collect::<Vec<_>>(),
            "notes": source.notes,
        })
    }

    fn text(&self) -> String {
        let Info { source, contents, lists } = self;
        let types = contents.types.iter();
        let types = types.map(|(name, &count)| format!("{} {name}", grouped(count as u64)));
        let end = source.end.map_or("not stated".to_owned(), |end| source.axis.place_text(end));
        let resolution =
            resolution(source.axis).map_or("samples".to_owned(), |ps| format!("{ps} ps"));
        let comments = source.comments.iter().filter(|comment| !comment.starts_with(MARK));
        let comments = comments.map(|comment| ("comment", comment.clone()));
        let rows = [
            ("end", end),
            ("resolution", resolution),
            ("scopes", grouped(contents.scopes as u64)),
            ("names", grouped(contents.names as u64)),
            ("signals", grouped(contents.signals as u64)),
            ("bits", grouped(contents.bits)),
            ("types", types.collect::<Vec<_>>().join(", ")),
        ];
        let rows = rows.into_iter().chain(comments).map(|(name, value)| (name.to_owned(), value));
        let mut text = format!("{}: {}\n\n{}\n", source.name, source.format, facts(rows));
        if *lists {
            let has_meanings = source.signals.iter().any(|signal| meaning(signal).is_some());
            let header =
                &["signal", "width", "type", "meaning"][..if has_meanings { 4 } else { 3 }];
            let row = |signal: &Signal| {
                let name = format!("{} {}", signal.name.text, range(signal));
                let width = Contents::width(signal).map_or("-".to_owned(), |w| w.to_string());
                let value_type = stated(signal, |known| &known.value_type);
                let value_type = value_type.unwrap_or(Contents::type_of(signal)).to_owned();
                let mut row = vec![name, width, value_type];
                row.extend(has_meanings.then(|| meaning(signal).unwrap_or_default().to_owned()));
                row
            };
            let rows = source.signals.iter().map(row);
            text += &format!("\n{}\n", table(header.to_vec(), rows, 1..2));
        }
        text
    }
}

/// Returns a part of a signal's description, if the source states it.
fn stated(signal: &Signal, part: impl Fn(&SignalDescription) -> &String) -> Option<&str> {
    Some(part(signal.description.as_ref()?).as_str()).filter(|text| !text.is_empty())
}

/// Returns a signal's meaning, if the source states it.
fn meaning(signal: &Signal) -> Option<&str> {
    stated(signal, |known| &known.meaning)
}

/// Returns the unit of times in JSON.
pub(super) fn unit(axis: Axis) -> &'static str {
    match axis {
        Axis::Samples => "sample",
        Axis::Time(_) => "ps",
    }
}

/// Returns the smallest step of time [ps].
fn resolution(axis: Axis) -> Option<f64> {
    matches!(axis, Axis::Time(_)).then(|| axis.place_number(1))
}
