//! What the program prints, and what it says while it works.

use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::process::ExitCode;

use serde_json::Value;

use tofsim::Note;
use tofsim::error::{Error, Input, Result};
use tofsim::files::folder::FolderLock;
use tofsim::files::output::write_bytes;

use super::host;
pub use super::interrupt::stop_signal;
use super::progress::Progress;

/// Where a verb prints.
pub type Output = BufWriter<Box<dyn Write>>;

/// Prints `text` as it is; a closed pipe or a full disk is an error.
pub fn print(text: &str) -> Result<()> {
    print_with(|out| out.write_all(text.as_bytes()))
}

/// Prints an object as a line of JSON.
pub fn print_json(object: &Value) -> Result<()> {
    print(&format!("{object}\n"))
}

/// Prints what `fill` writes; a closed pipe or a full disk is an error.
pub fn print_with(fill: impl FnOnce(&mut Output) -> io::Result<()>) -> Result<()> {
    let mut out = BufWriter::new(host::output());
    let written = fill(&mut out).and_then(|()| out.flush());
    written.map_err(Error::io(Path::new("stdout"), "write"))
}

/// Does what a command line asks for, the first word of which is a verb, and speaks as another one's part.
pub type RunCommand = fn(&[&str], &Talk) -> Result<ExitCode>;

/// The voice, and how much it says.
#[derive(Debug, clap::Args)]
pub struct Talk {
    /// Print nothing but errors, and what --json asks for
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Say more
    #[arg(short, long, global = true)]
    pub verbose: bool,
    /// Take a note on what a result is outside of for an error
    #[arg(long, global = true)]
    strict: bool,
    /// The verb and its options, for the record in outputs.
    #[arg(skip)]
    pub command: Vec<String>,
    /// Whether another verb speaks for this one, which then keeps quiet unless more is asked for.
    #[arg(skip)]
    within: bool,
}

impl Talk {
    /// That of a command which is a part of this one.
    pub fn within(&self, command: Vec<String>) -> Talk {
        let Talk { quiet, verbose, strict, .. } = *self;
        Talk { quiet, verbose, strict, command, within: true }
    }

    /// That of a command within another program, which says nothing but what is asked for.
    pub fn silent(&self, command: Vec<String>) -> Talk {
        Talk { quiet: true, verbose: false, strict: self.strict, command, within: false }
    }

    /// Whether nothing but errors is to be said.
    pub fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// Something worth knowing.
    pub fn note(&self, text: impl std::fmt::Display) {
        if !self.quiet && (!self.within || self.verbose) {
            eprintln!("{text}");
        }
    }

    /// What results lie outside of, a line each.
    ///
    /// # Errors
    /// With `--strict`, if there is any.
    pub fn heed(&self, notes: &[Note]) -> Result<()> {
        notes.iter().for_each(|note| self.note(note));
        let Some(first) = notes.first().filter(|_| self.strict) else { return Ok(()) };
        let expected = format!("expected what no note [{}] has to be said of", first.code);
        Err(Input::new("--strict", expected).field(&first.key).value(&first.value).into())
    }

    /// Makes a folder, and writes files of such names and texts into it.
    ///
    /// # Errors
    /// When another run writes there, or a file cannot be written.
    pub fn write_into(
        &self,
        folder: &Path,
        files: impl IntoIterator<Item = (impl AsRef<Path>, String)>,
    ) -> Result<()> {
        let _held = FolderLock::take(folder)?;
        for (name, text) in files {
            let path = folder.join(name);
            write_bytes(&path, text)?;
            self.wrote(&path);
        }
        Ok(())
    }

    /// That a file was written.
    pub fn wrote(&self, path: &Path) {
        self.note(format_args!("wrote {}", path.display()));
    }

    /// That a waveform was written, with what viewers need beside it.
    pub fn wrote_wave(&self, path: &Path) {
        self.wrote(path);
        let views = ["gtkw", "sucl"].map(|ending| path.with_extension(ending));
        views
            .iter()
            .filter(|view| path.is_file() && view.is_file())
            .for_each(|view| self.wrote(view));
    }

    /// Prints what came out, for people; what is for programs is [printed](print_json) in any case.
    pub fn report(&self, text: &str) -> Result<()> {
        if self.quiet || self.within { Ok(()) } else { print(text) }
    }

    /// Something for who asked for it.
    pub fn detail(&self, text: impl std::fmt::Display) {
        if self.verbose {
            eprintln!("{text}");
        }
    }

    /// How far it is with `count` of `things`.
    pub fn progress(&self, count: u64, things: &'static str) -> Progress {
        Progress::new(count, things, self.quiet)
    }
}
