//! What the program prints, what it says while it works, and how it hears that the user interrupts.

use std::io::{self, BufWriter, StdoutLock, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::Value;

use tofsim::Note;
use tofsim::error::{Error, Input, Result};

/// Prints `text` as it is; a closed pipe or a full disk is an error.
pub fn print(text: &str) -> Result<()> {
    print_with(|out| out.write_all(text.as_bytes()))
}

/// Prints an object as a line of JSON.
pub fn print_json(object: &Value) -> Result<()> {
    print(&format!("{object}\n"))
}

/// Prints what `fill` writes; a closed pipe or a full disk is an error.
pub fn print_with(fill: impl FnOnce(&mut BufWriter<StdoutLock>) -> io::Result<()>) -> Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    let written = fill(&mut out).and_then(|()| out.flush());
    written.map_err(Error::io(Path::new("stdout"), "write"))
}

/// Set when the user interrupts. `None` if the system offers no way to hear of it.
pub fn stop_signal() -> Option<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let heard = Arc::clone(&stop);
    ctrlc::set_handler(move || heard.store(true, Ordering::Relaxed)).ok()?;
    Some(stop)
}

/// The voice, and how much it says.
#[derive(Debug, clap::Args)]
pub struct Talk {
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    quiet: bool,
    /// Say what is read and written
    #[arg(short, long, global = true)]
    pub verbose: bool,
    /// Take a note on what a result is outside of for an error
    #[arg(long, global = true)]
    strict: bool,
    /// The verb and its options, for the record in outputs.
    #[arg(skip)]
    pub command: Vec<String>,
}

impl Talk {
    /// Something worth knowing.
    pub fn note(&self, text: impl std::fmt::Display) {
        if !self.quiet {
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

    /// Something for who asked for it.
    pub fn detail(&self, text: impl std::fmt::Display) {
        if self.verbose {
            eprintln!("{text}");
        }
    }

    /// A progress bar over `count` of `things`, visible on a terminal only.
    pub fn progress(&self, count: u64, things: &str) -> ProgressBar {
        let target = match self.quiet || count < 2 {
            true => ProgressDrawTarget::hidden(),
            false => ProgressDrawTarget::stderr(),
        };
        let bar = ProgressBar::with_draw_target(Some(count), target);
        let template = format!("{{bar:40}} {{pos}}/{{len}} {things}, {{eta}} to go");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        bar
    }
}
