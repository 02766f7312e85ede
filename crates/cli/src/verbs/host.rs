//! A command line within another program, as the Python package: that has what is printed, may stop the verb, and
//! hears how far it is.

use std::cell::RefCell;
use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

use clap::{CommandFactory, FromArgMatches};

use tofsim::error::{Input, Result};

use crate::record::command_line;

use super::{Cli, usage};

/// Hears how much of how much is done.
pub type HearProgress = Arc<dyn Fn(u64, u64) + Send + Sync>;

/// The program around a command.
#[derive(Clone)]
pub struct Host {
    /// Set to stop the verb, if it is one that looks at such a signal.
    pub stop: Arc<AtomicBool>,
    /// Hears of the progress of a task whose size is known.
    pub progress: HearProgress,
    printed: Printed,
}

#[derive(Clone, Default)]
struct Printed(Arc<Mutex<Vec<u8>>>);

impl Write for Printed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// What came of a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Whether all was the same or fine.
    pub is_fine: bool,
    /// What it printed.
    pub text: String,
}

thread_local! {
    static HOST: RefCell<Option<Host>> = const { RefCell::new(None) };
}

/// The program around the verb of this thread, if there is one.
pub fn host() -> Option<Host> {
    HOST.with_borrow(Clone::clone)
}

/// Where a verb of this thread prints.
pub fn output() -> Box<dyn Write> {
    match host() {
        Some(host) => Box::new(host.printed),
        None => Box::new(io::stdout().lock()),
    }
}

impl Host {
    /// A program that stops a verb by `stop`.
    pub fn new(stop: Arc<AtomicBool>, progress: HearProgress) -> Host {
        Host { stop, progress, printed: Printed::default() }
    }

    /// Does what a command line asks for, the first word of which is a verb, on all threads of the current pool.
    /// Nothing is printed elsewhere.
    ///
    /// # Errors
    /// When the command line is wrong, the verb fails, or is stopped.
    pub fn answer(self, words: &[String]) -> Result<Answer> {
        let mut command = Cli::command().no_binary_name(true);
        let fault = |fault| Input::new("command", usage::shortened(fault).to_string().trim());
        let matches = command.try_get_matches_from_mut(words).map_err(fault)?;
        let mut cli = Cli::from_arg_matches(&matches).map_err(fault)?;
        cli.talk = cli.talk.silent(command_line(&command, &matches));
        let printed = self.printed.clone();
        let outer = HOST.replace(Some(self));
        let status = cli.run();
        HOST.set(outer);
        let is_fine = status? == ExitCode::SUCCESS;
        let bytes = printed.0.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(Answer { is_fine, text: String::from_utf8_lossy(&bytes).into_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(words: &[&str]) -> Result<Answer> {
        let words: Vec<_> = words.iter().map(|word| word.to_string()).collect();
        Host::new(Arc::default(), Arc::new(|_, _| {})).answer(&words)
    }

    #[test]
    fn what_a_command_prints_is_its_answer() {
        let answer = answer(&["budget", "near", "--json"]).unwrap();
        assert!(answer.is_fine && answer.text.starts_with('{'), "{answer:?}");
        assert!(answer.text.contains(r#""command":["budget","near"]"#), "{answer:?}");
        assert!(host().is_none());
    }

    #[test]
    fn a_wrong_command_line_is_an_error_and_ends_nothing() {
        let error = answer(&["budget", "--bogus"]).unwrap_err().to_string();
        assert!(error.contains("--bogus"), "{error}");
        let error = answer(&["budget", "-s", "target.distance_m=-1"]).unwrap_err().to_string();
        assert!(error.starts_with("-s target.distance_m=-1: "), "{error}");
        assert!(host().is_none());
    }
}
