//! `tofsim wave info`: what a waveform has.

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim_captures::source::{Axis, Signal, Source};
use tofsim_captures::wave::Contents;

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
        let rows = [
            ("end", end),
            ("resolution", resolution),
            ("scopes", grouped(contents.scopes as u64)),
            ("names", grouped(contents.names as u64)),
            ("signals", grouped(contents.signals as u64)),
            ("bits", grouped(contents.bits)),
            ("types", types.collect::<Vec<_>>().join(", ")),
        ];
        let rows = rows.map(|(name, value)| (name.to_owned(), value));
        let mut text = format!("{}: {}\n\n{}\n", source.name, source.format, facts(rows));
        if *lists {
            let row = |signal: &Signal| {
                let name = format!("{} {}", signal.name.text, range(signal));
                let width = Contents::width(signal).map_or("-".to_owned(), |w| w.to_string());
                [name, width, Contents::type_of(signal).to_owned()]
            };
            let rows = source.signals.iter().map(row);
            text += &format!("\n{}\n", table(["signal", "width", "type"], rows, 1..2));
        }
        text
    }
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
