//! `tofsim ila info`: what a capture holds, and what its format cannot say.

use std::path::PathBuf;

use serde_json::json;

use tofsim::error::{Input, Result};
use tofsim_captures::compare::{Survey, survey};
use tofsim_captures::ila::Radix;
use tofsim_captures::source::{Signal, SignalKind, Source, SourceFormat};

use crate::choice::{self, words};
use crate::text::table::{facts, grouped, table};
use crate::verbs::terminal::{Console, print};

/// Show the contents of a logic analyser's file
///
/// Reads CSV (with or without a row of radices), VCD and .ila archives of Vivado's ILA, and what chipscopy writes;
/// the contents decide which, not the name. Corrections, and values from other parts of an archive, are noted.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The file
    file: PathBuf,
    /// Radix of the values in a CSV without radices
    #[arg(long, value_parser = words(choice::RADIX))]
    radix: Option<Radix>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let source = Source::file(&args.file, args.radix)?;
    if !source.is_capture() {
        let expected = format!(
            "is a waveform ({}), not a logic analyser's capture; `tofsim compare` reads it",
            source.format
        );
        return Err(Input::new(args.file.display(), expected).into());
    }
    let survey = survey(&source)?;
    if args.json {
        print(&format!("{:#}\n", as_json(&source, &survey)))
    } else {
        console.report(&as_text(&source, &survey))
    }
}

/// Returns what the format does not tell.
fn unsaid(source: &Source, survey: &Survey) -> Vec<&'static str> {
    let mut unsaid = vec!["the frequency of the clock", "whether all samples were stored"];
    if survey.windows.len() > 1 {
        unsaid.push("the time between windows");
    }
    match source.format {
        SourceFormat::IlaVcd => unsaid.extend(["the number of samples", "the radix of the probes"]),
        SourceFormat::LegacyIlaCsv => unsaid.push("the radix of the probes, which is inferred"),
        _ if !source.radix_stated => unsaid.push("the radix of the probes"),
        _ => {}
    }
    unsaid
}

/// The words that stand for values, with those that are known.
fn states(signal: &Signal) -> serde_json::Map<String, serde_json::Value> {
    let states = signal.words.states.iter();
    states.map(|state| (state.name.clone(), state.bits.into())).collect()
}

/// Width of a probe [bits], also of one whose values are words.
fn width(signal: &Signal) -> u32 {
    if signal.kind == SignalKind::Text { signal.words.width } else { signal.width }
}

fn as_json(source: &Source, survey: &Survey) -> serde_json::Value {
    let probe = |signal: &Signal| {
        json!({
            "name": signal.name.text,
            "width": width(signal),
            "lsb": signal.lsb,
            "radix": signal.radix.map(|radix| radix.to_string()),
            "states": states(signal),
            "text": signal.kind == SignalKind::Text,
        })
    };
    let triggers: Vec<_> = survey.windows.iter().filter_map(|window| window.trigger).collect();
    json!({
        "schema": "tofsim.ila_info/1",
        "file": source.name,
        "format": source.format.to_string(),
        "samples": survey.samples,
        "windows": survey.windows.len(),
        "triggers": triggers.len(),
        "window_starts": survey.windows.iter().map(|window| window.first).collect::<Vec<_>>(),
        "trigger_samples": triggers,
        "gaps": survey.gaps,
        "last_change": survey.last,
        "probes": source.signals.iter().map(probe).collect::<Vec<_>>(),
        "unknown": unsaid(source, survey),
        "notes": source.notes,
    })
}

/// Windows that are listed.
const LISTED: usize = 12;

fn as_text(source: &Source, survey: &Survey) -> String {
    let samples = match (survey.samples, survey.last) {
        (Some(samples), _) => grouped(samples),
        (None, Some(last)) => format!("at least {}", grouped(last + 1)),
        (None, None) => "not known".to_owned(),
    };
    let count = survey.windows.len();
    let mut rows = vec![("samples".to_owned(), samples), ("windows".to_owned(), count.to_string())];
    for (k, window) in survey.windows.iter().take(LISTED).enumerate() {
        let count = window.count.map_or("?".to_owned(), grouped);
        let trigger = match window.trigger {
            Some(trigger) => format!("trigger at {} ({} in it)", trigger, trigger - window.first),
            None => "no trigger".to_owned(),
        };
        let text = format!("from {}, {count} samples, {trigger}", window.first);
        rows.push((format!("window {k}"), text));
    }
    if count > LISTED {
        rows.push((String::new(), format!("... {} more", count - LISTED)));
    }
    if survey.gaps > 0 {
        rows.push(("gaps".to_owned(), format!("{} samples", grouped(survey.gaps))));
    }
    let probes = source.signals.iter().map(|signal| {
        let radix = match (signal.kind, signal.radix) {
            (SignalKind::Text, _) if signal.words.mixed => "text, numbers",
            (SignalKind::Text, _) => "text",
            (_, Some(radix)) => radix.into(),
            (_, None) => "-",
        };
        [signal.name.text.clone(), width(signal).to_string(), radix.to_owned()]
    });
    let unsaid = unsaid(source, survey).into_iter().map(|unsaid| format!("  {unsaid}\n"));
    let notes: String = source.notes.iter().map(|note| format!("  {note}\n")).collect();
    let notes = if notes.is_empty() { notes } else { format!("\nNotes:\n{notes}") };
    format!(
        "{}: {}\n\n{}\n\n{}\n\nNot in this file:\n{}{notes}",
        source.name,
        source.format,
        facts(rows),
        table(["probe", "width", "radix"], probes, ..0),
        unsaid.collect::<String>()
    )
}
