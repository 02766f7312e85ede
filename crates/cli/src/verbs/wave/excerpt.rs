//! The input of a command, and the part of it that is read.

use std::path::PathBuf;

use tofsim::error::Result;
use tofsim::kernel::Time;
use tofsim_captures::choice::SignalChoice;
use tofsim_captures::ila::Radix;
use tofsim_captures::source::Source;
use tofsim_captures::wave::Excerpt;

use crate::choice::{self, words};

use super::super::compare::values::time;
use super::super::host::host;
use super::super::terminal::Console;

/// A waveform.
#[derive(Debug, clap::Args)]
pub(super) struct InputArgs {
    /// VCD, FST or GHW, or a logic analyser's CSV, VCD or .ila archive; its contents decide
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Radix of the values in a CSV without radices
    #[arg(long, value_parser = words(choice::RADIX))]
    radix: Option<Radix>,
}

/// Signals.
#[derive(Debug, clap::Args)]
pub(super) struct SignalArgs {
    /// Choose only matching signals, with * and ?; may be repeated
    #[arg(long, value_name = "GLOB")]
    signals: Vec<String>,
    /// Leave out matching signals, with * and ?; may be repeated
    #[arg(long, value_name = "GLOB")]
    ignore: Vec<String>,
}

/// A range of time.
#[derive(Debug, Default, clap::Args)]
pub(super) struct RangeArgs {
    /// Start of the part, e.g. 10us
    #[arg(long, value_name = "TIME", value_parser = time)]
    after: Option<Time>,
    /// End of the part; changes at this time are not of it
    #[arg(long, value_name = "TIME", value_parser = time)]
    until: Option<Time>,
}

impl InputArgs {
    /// Opens the file, and prints what is unusual about it.
    pub(super) fn open(&self, console: &Console) -> Result<Source> {
        let stop = host().map(|host| host.stop).unwrap_or_default();
        let source = Source::file_stopped_by(&self.file, self.radix, stop)?;
        source.notes.iter().for_each(|note| console.note(format_args!("note: {note}")));
        Ok(source)
    }
}

impl SignalArgs {
    /// Returns the part of a waveform with these signals.
    pub(super) fn excerpt(&self, range: &RangeArgs) -> Excerpt {
        let choice = SignalChoice { only: self.signals.clone(), ignore: self.ignore.clone() };
        Excerpt { choice, after: range.after, until: range.until }
    }
}
