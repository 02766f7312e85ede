//! The command line: one file per subcommand, each with its `Args` and `run`.

pub mod board;
pub mod budget;
pub mod build;
pub mod calibrate;
pub mod compare;
pub mod completions;
pub mod dataset;
mod deferred;
mod design;
pub mod dpi;
pub mod draws;
pub mod estimate;
pub mod evaluate;
mod formats;
pub mod frames;
pub mod host;
pub mod ila;
pub mod image;
mod instrument;
pub mod interrupt;
pub mod man;
pub mod new;
pub mod options;
pub mod pixel;
mod progress;
pub mod quantize;
pub mod report;
pub mod reproduce;
pub mod rerun;
pub mod run;
pub mod scenario;
pub mod scenes;
pub mod serve;
pub mod spad;
pub mod sweep;
pub mod tdc;
pub mod terminal;
pub mod timing;
pub mod train;
mod usage;
pub mod vectors;
pub mod verify;
pub mod wave;
mod wave_plan;

use std::ffi::OsString;
use std::process::ExitCode;
use std::time::Instant;

use clap::{Command, CommandFactory, FromArgMatches, Parser, Subcommand};
use host::Host;
use terminal::Console;

use tofsim::error::{Input, Result};

use crate::record::command_line;

/// Cycle-accurate simulator of the FPGA firmware of a time-of-flight rangefinder
#[derive(Debug, Parser)]
#[command(name = "tofsim", version, propagate_version = true)]
#[command(after_help = "Results go to standard output, messages to standard error.\n\
    Exit status: 0 fine or same, 1 differences found or a check failed, \
    2 usage or input error, 130 interrupted.")]
pub struct Cli {
    #[command(subcommand)]
    verb: Verb,
    #[command(flatten)]
    console: Console,
}

/// Result of a command that ran within another program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Whether all was the same or fine.
    pub is_fine: bool,
    /// Text on its standard output.
    pub text: String,
}

#[derive(Debug, Subcommand)]
enum Verb {
    New(new::Args),
    Run(run::Args),
    Image(image::Args),
    Rerun(rerun::Args),
    Budget(budget::Args),
    Estimate(estimate::Args),
    Evaluate(Box<evaluate::Args>),
    Quantize(quantize::Args),
    Calibrate(calibrate::Args),
    Tdc(tdc::Args),
    Spad(spad::Args),
    Vectors(vectors::Args),
    Verify(verify::Args),
    Dpi(dpi::Args),
    Timing(timing::Args),
    Sweep(sweep::Args),
    Build(build::Args),
    Reproduce(reproduce::Args),
    Report(report::Args),
    Board(board::Args),
    Serve(serve::Args),
    Ila(ila::Args),
    #[command(visible_alias = "diff")]
    Compare(Box<compare::Args>),
    Wave(wave::Args),
    Dataset(dataset::Args),
    Train(Box<train::Args>),
    Scenario(scenario::Args),
    Completions(completions::Args),
    Man(man::Args),
}

impl Cli {
    /// The command with all verbs, whose options take a negative number for one, so that its range is in the message.
    fn whole() -> Command {
        usage::with_negative_numbers(Cli::command())
    }

    /// A command line; a fault in it ends the process.
    pub fn read(words: impl IntoIterator<Item = OsString>) -> Cli {
        let mut command = Cli::whole();
        let given = command.try_get_matches_from_mut(words).and_then(|matches| {
            let mut cli = Cli::from_arg_matches(&matches)?;
            cli.console.command = command_line(&command, &matches);
            Ok(cli)
        });
        given.unwrap_or_else(|fault| usage::readable(fault, &command).exit())
    }

    /// The command without `help`, which has a page for each command that there is anyway.
    fn without_help() -> Command {
        Cli::whole().disable_help_subcommand(true)
    }

    /// Does what a command of another one's asks for, as [`Cli::run`].
    fn run_within(words: &[&str], console: &Console) -> Result<ExitCode> {
        let mut command = Cli::whole().no_binary_name(true);
        let fault = |error| Input::new("command", error);
        let matches = command.try_get_matches_from_mut(words).map_err(fault)?;
        let mut cli = Cli::from_arg_matches(&matches).map_err(fault)?;
        cli.console = console.within(command_line(&command, &matches));
        cli.run()
    }

    /// Does what a command line asks for within another program, which has what is printed.
    ///
    /// # Errors
    /// When the command line is wrong, the verb fails, or is stopped.
    pub fn answer(words: &[String], host: Host) -> Result<Answer> {
        let mut command = Cli::whole().no_binary_name(true);
        let matches = command.try_get_matches_from_mut(words);
        let fault = |fault| {
            let fault = usage::readable(fault, &command);
            Input::new("command", fault.to_string().trim())
        };
        let matches = matches.map_err(fault)?;
        let mut cli = Cli::from_arg_matches(&matches).map_err(fault)?;
        cli.console = cli.console.silent(command_line(&command, &matches));
        let (status, text) = host.around(|| cli.run());
        Ok(Answer { is_fine: status? == ExitCode::SUCCESS, text })
    }

    /// Does what the command line asks for; the status says whether all was the same or fine.
    pub fn run(&self) -> Result<ExitCode> {
        let begun = Instant::now();
        let status = self.run_verb()?;
        let verb = self.console.command.first().map_or("tofsim", String::as_str);
        self.console.detail(format_args!("{verb}: {:.2} s", begun.elapsed().as_secs_f64()));
        Ok(status)
    }

    fn run_verb(&self) -> Result<ExitCode> {
        let console = &self.console;
        match &self.verb {
            Verb::New(args) => new::run(args, console),
            Verb::Run(args) => run::run(args, console),
            Verb::Image(args) => image::run(args, console),
            Verb::Rerun(args) => return rerun::run(args, console),
            Verb::Budget(args) => budget::run(args, console),
            Verb::Estimate(args) => estimate::run(args, console),
            Verb::Evaluate(args) => return evaluate::run(args, console),
            Verb::Quantize(args) => quantize::run(args, console),
            Verb::Calibrate(args) => calibrate::run(args, console),
            Verb::Tdc(args) => return tdc::run(args, console),
            Verb::Spad(args) => spad::run(args, console),
            Verb::Vectors(args) => vectors::run(args, console),
            Verb::Verify(args) => return verify::run(args, console),
            Verb::Dpi(args) => dpi::run(args, console),
            Verb::Timing(args) => return timing::run(args, console),
            Verb::Sweep(args) => sweep::run(args, console),
            Verb::Build(args) => return build::run(args, console, Cli::run_within),
            Verb::Reproduce(args) => reproduce::run(args, console),
            Verb::Report(args) => return report::run(args, console, Cli::run_within),
            Verb::Board(args) => return board::run(args, console),
            Verb::Serve(args) => return serve::run(args, console),
            Verb::Ila(args) => ila::run(args, console),
            Verb::Compare(args) => return compare::run(args, console),
            Verb::Wave(args) => return wave::run(args, console),
            Verb::Dataset(args) => dataset::run(args, console),
            Verb::Train(args) => train::run(args, console),
            Verb::Scenario(args) => scenario::run(args, console),
            Verb::Completions(args) => completions::run(args, Cli::without_help()),
            Verb::Man(args) => man::run(args, Cli::without_help(), console),
        }?;
        Ok(ExitCode::SUCCESS)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    fn answer(words: &[&str]) -> Result<Answer> {
        let words: Vec<_> = words.iter().map(|word| word.to_string()).collect();
        Cli::answer(&words, Host::new(Arc::default(), Arc::new(|_, _| {})))
    }

    #[test]
    fn what_a_command_prints_within_another_program_is_its_answer() {
        let answer = answer(&["budget", "near", "--json"]).unwrap();
        assert!(answer.is_fine && answer.text.starts_with('{'), "{answer:?}");
        assert!(answer.text.contains(r#""command":["budget","near"]"#), "{answer:?}");
        assert!(host::host().is_none());
    }

    #[test]
    fn a_wrong_command_line_within_another_program_ends_nothing() {
        let error = answer(&["budget", "--bogus"]).unwrap_err().to_string();
        assert!(error.contains("--bogus"), "{error}");
        let error = answer(&["budget", "-s", "target.distance_m=-1"]).unwrap_err().to_string();
        assert!(error.starts_with("-s target.distance_m=-1: "), "{error}");
        assert!(host::host().is_none());
    }
}
