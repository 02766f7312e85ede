//! Results on standard output, messages on standard error.

use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::process::ExitCode;

use serde_json::Value;

use tofsim::Note;
use tofsim::error::{Error, Input, Result};
use tofsim::files::folder::FolderLock;
use tofsim::files::output::write_bytes;

use crate::text::wrap::message;

use super::host;
pub use super::interrupt::stop_signal;
use super::progress::Progress;

/// Output of a verb.
pub type Output = BufWriter<Box<dyn Write>>;

/// Prints text to standard output; a closed pipe or a full disk is an error.
pub fn print(text: &str) -> Result<()> {
    print_with(|out| out.write_all(text.as_bytes()))
}

/// Prints an object as a line of JSON.
pub fn print_json(object: &Value) -> Result<()> {
    print(&format!("{object}\n"))
}

/// Prints all that `fill` writes; a closed pipe or a full disk is an error.
pub fn print_with(fill: impl FnOnce(&mut Output) -> io::Result<()>) -> Result<()> {
    let mut out = BufWriter::new(host::output());
    let written = fill(&mut out).and_then(|()| out.flush());
    written.map_err(Error::io(Path::new("stdout"), "write"))
}

/// Runs a command line, the first word of which is a verb, as part of another command.
pub type RunCommand = fn(&[&str], &Console) -> Result<ExitCode>;

/// Messages to the user, and how many of them are printed.
#[derive(Debug, clap::Args)]
pub struct Console {
    /// Print only errors and the object of --json
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Print more messages
    #[arg(short, long, global = true)]
    pub verbose: bool,
    /// Treat notes as errors
    #[arg(long, global = true)]
    strict: bool,
    /// Verb and options, for the record in outputs.
    #[arg(skip)]
    pub command: Vec<String>,
    /// Whether the command is part of another one, which prints the messages unless more are asked for.
    #[arg(skip)]
    within: bool,
}

impl Console {
    /// Returns the console of a command that is part of this one.
    pub fn within(&self, command: Vec<String>) -> Console {
        let Console { quiet, verbose, strict, .. } = *self;
        Console { quiet, verbose, strict, command, within: true }
    }

    /// Returns the console of a command within another program, which prints only what is asked for.
    pub fn silent(&self, command: Vec<String>) -> Console {
        Console { quiet: true, verbose: false, strict: self.strict, command, within: false }
    }

    /// Whether only errors are printed.
    pub fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// Prints a message, unless `--quiet` is given.
    pub fn note(&self, text: impl std::fmt::Display) {
        if !self.quiet && (!self.within || self.verbose) {
            message(text);
        }
    }

    /// Prints the notes on results.
    ///
    /// # Errors
    /// With `--strict`, if there is a note.
    pub fn print_notes(&self, notes: &[Note]) -> Result<()> {
        notes.iter().for_each(|note| self.note(note));
        let Some(first) = notes.first().filter(|_| self.strict) else { return Ok(()) };
        let expected = format!("expected no note [{}]", first.code);
        Err(Input::new("--strict", expected).field(&first.key).value(&first.value).into())
    }

    /// Checks that no values were skipped in a comparison.
    ///
    /// # Errors
    /// With `--strict`, if some were.
    pub fn none_skipped(&self, skipped: &[String]) -> Result<()> {
        let Some(first) = skipped.first().filter(|_| self.strict) else { return Ok(()) };
        let more = match skipped.len() - 1 {
            0 => String::new(),
            1 => "; 1 other is skipped, too".to_owned(),
            more => format!("; {more} others are skipped, too"),
        };
        let expected = format!("expected that all values can be compared: {first}{more}");
        Err(Input::new("--strict", expected).into())
    }

    /// Writes files, given by name and contents, into a folder, which is made if it is not there.
    ///
    /// # Errors
    /// When another run writes there, or a file cannot be written.
    pub fn write_into(
        &self,
        folder: &Path,
        files: impl IntoIterator<Item = (impl AsRef<Path>, impl AsRef<[u8]>)>,
    ) -> Result<()> {
        let _held = FolderLock::take(folder)?;
        for (name, contents) in files {
            let path = folder.join(name);
            write_bytes(&path, contents)?;
            self.wrote(&path);
        }
        Ok(())
    }

    /// Prints that a file was written.
    pub fn wrote(&self, path: &Path) {
        self.note(format_args!("wrote {}", path.display()));
    }

    /// Prints that a waveform was written, and the save files of viewers beside it.
    pub fn wrote_wave(&self, path: &Path) {
        self.wrote(path);
        let views = ["gtkw", "sucl"].map(|ending| path.with_extension(ending));
        views
            .iter()
            .filter(|view| path.is_file() && view.is_file())
            .for_each(|view| self.wrote(view));
    }

    /// Prints results for people; [`print_json`] prints those for programs in any case.
    pub fn report(&self, text: &str) -> Result<()> {
        if self.quiet || self.within { Ok(()) } else { print(text) }
    }

    /// Prints a message if `--verbose` is given.
    pub fn detail(&self, text: impl std::fmt::Display) {
        if self.verbose {
            message(text);
        }
    }

    /// Creates a progress bar over `count` of `things`.
    pub fn progress(&self, count: u64, things: &'static str) -> Progress {
        Progress::new(count, things, self.quiet)
    }

    /// Creates a progress bar over items that differ in length, without an estimate of the remaining time.
    pub fn uneven_progress(&self, count: u64, things: &'static str) -> Progress {
        Progress::uneven(count, things, self.quiet)
    }
}
