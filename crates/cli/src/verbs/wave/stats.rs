//! `tofsim wave stats`: what the signals of a waveform do.

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim_captures::source::{Axis, Source};
use tofsim_captures::wave::{Contents, Pulses, SignalStatistics, statistics};

use crate::report::sheet::Digits::{Fixed, Shortest};
use crate::report::sheet::Sheet;
use crate::report::writer::{Findings, Report};

use super::super::terminal::Console;
use super::excerpt::{InputArgs, RangeArgs, SignalArgs};
use super::info::unit;

/// Show changes, pulse widths and frequency of the signals of a waveform
///
/// A signal's first value is not counted as a change. Toggles are changes of single bits between 0 and 1. Pulses are
/// those of single bits with both edges in the file; the frequency is that of the rising edges, of signals that are
/// never unknown after the first one.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  tofsim wave stats run.fst --signals 'clk_*' --after 10us")]
pub(super) struct Args {
    #[command(flatten)]
    input: InputArgs,
    #[command(flatten)]
    range: RangeArgs,
    #[command(flatten)]
    signals: SignalArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args, console: &Console) -> Result<()> {
    let source = args.input.open(console)?;
    let (signals, end) = statistics(&source, &args.signals.excerpt(&args.range))?;
    let findings = Statistics { source: &source, signals, end };
    Report::without_record(findings).deliver(None, args.json, console)
}

struct Statistics<'a> {
    source: &'a Source,
    signals: Vec<SignalStatistics<'a>>,
    /// End of what was read, in units of the source.
    end: u64,
}

impl Statistics<'_> {
    fn axis(&self) -> Axis {
        self.source.axis
    }

    /// Length of a unit of the source [ps], or a sample.
    fn unit(&self) -> f64 {
        self.axis().place_number(1)
    }

    /// Frequency of the rising edges [Hz], if places are times.
    fn frequency_hz(&self, signal: &SignalStatistics) -> Option<f64> {
        let period_ps = signal.period? * self.unit();
        matches!(self.axis(), Axis::Time(_)).then(|| 1e12 / period_ps)
    }

    fn pulses(&self, pulses: &Pulses) -> Value {
        let number = |width: u64| (pulses.count > 0).then(|| self.axis().place_number(width));
        json!({
            "count": pulses.count,
            "shortest": number(pulses.shortest),
            "mean": pulses.mean(self.unit()),
            "longest": number(pulses.longest),
        })
    }
}

/// Shortest and longest width, as numbers of the axis.
fn widths(axis: Axis, pulses: &Pulses) -> String {
    match pulses {
        Pulses { count: 0, .. } => "-".to_owned(),
        Pulses { shortest, longest, .. } if shortest == longest => axis.place_text(*shortest),
        Pulses { shortest, longest, .. } => {
            let shortest = axis.place_text(*shortest);
            let shortest = shortest.trim_end_matches(" ns");
            format!("{shortest}..{}", axis.place_text(*longest).trim_start_matches("sample "))
        }
    }
}

impl Findings for Statistics<'_> {
    const SCHEMA: &'static str = "tofsim.wave_stats/1";

    fn json(&self) -> Value {
        let place = |at: Option<u64>| at.map(|at| self.axis().place_number(at));
        let signal = |signal: &SignalStatistics| {
            let pulses = |k: usize| signal.pulses.map(|pulses| self.pulses(&pulses[k]));
            json!({
                "name": signal.signal.name.text,
                "type": Contents::type_of(signal.signal),
                "width": Contents::width(signal.signal),
                "changes": signal.changes,
                "toggles": signal.toggles,
                "first_change": place(signal.first),
                "last_change": place(signal.last),
                "high": pulses(1),
                "low": pulses(0),
                "frequency_hz": self.frequency_hz(signal),
            })
        };
        json!({
            "file": self.source.name,
            "format": self.source.format.to_string(),
            "unit": unit(self.axis()),
            "end": self.axis().place_number(self.end),
            "signals": self.signals.iter().map(signal).collect::<Vec<_>>(),
        })
    }

    fn text(&self) -> String {
        let axis = self.axis();
        let place = |at: Option<u64>| at.map_or("-".to_owned(), |at| axis.place_text(at));
        let pulses = |signal: &SignalStatistics, k: usize| {
            signal.pulses.map_or("-".to_owned(), |pulses| widths(axis, &pulses[k]))
        };
        let sheet = Sheet::of(&self.signals)
            .words("signal", |signal| signal.signal.name.text.clone())
            .both(("changes", Shortest), ("changes", Shortest), |signal| signal.changes)
            .both(("toggles", Shortest), ("toggles", Shortest), |signal| signal.toggles)
            .words("first", |signal| place(signal.first))
            .words("last", |signal| place(signal.last))
            .words("high", |signal| pulses(signal, 1))
            .words("low", |signal| pulses(signal, 0))
            .both(("frequency_mhz", Shortest), ("frequency [MHz]", Fixed(6)), |signal| {
                self.frequency_hz(signal).map(|hz| hz / 1e6)
            });
        format!(
            "{}: {}, {}\n\n{}\n",
            self.source.name,
            self.source.format,
            axis.place_text(self.end),
            sheet.table()
        )
    }
}
