//! The folder of a build, and what its steps know of the instrument.

use std::process::ExitCode;

use tofsim::Note;
use tofsim::error::Result;
use tofsim::files::digest::digest_of;
use tofsim::scenario::{self, Loaded};
use tofsim::sim::setup::Setup;
use tofsim_learn::estimation::notes::notes_of_firmware;

use crate::verbs::terminal::{Console, RunCommand};
use crate::verbs::{train, verify};

use super::files::InstrumentFiles;
use super::journal::Journal;
use super::step::Step;

/// The folder of a build, which is the current one, and what its steps know.
pub struct Site<'a> {
    /// The instrument's files.
    pub files: &'a InstrumentFiles,
    /// The scenario with any network.
    pub loaded: Loaded,
    /// The scenario, ready to run.
    pub setup: Setup,
    /// Notes on the instrument's results, whatever its network.
    pub notes: Vec<Note>,
    /// Whether all is to be quick.
    pub quick: bool,
    pub console: &'a Console,
    run_command: RunCommand,
}

impl<'a> Site<'a> {
    /// Prepares the build of an instrument.
    ///
    /// # Errors
    /// When what its scenario says does not fit together.
    pub fn new(
        files: &'a InstrumentFiles,
        quick: bool,
        console: &'a Console,
        run_command: RunCommand,
    ) -> Result<Self> {
        let loaded = files.with_any_network();
        let setup = Setup::of_counts(loaded.clone())?;
        train::check(&loaded)?;
        let mut notes: Vec<Note> = setup.no_depth().cloned().into_iter().collect();
        notes.extend(notes_of_firmware(&setup));
        Ok(Site { files, loaded, setup, notes, quick, console, run_command })
    }

    /// The scenario's file in the folder.
    pub fn scenario(&self) -> &str {
        &self.files.files[0].0
    }

    /// The instrument with its own network.
    ///
    /// # Errors
    /// When its files have gone.
    pub fn with_network(&self) -> Result<Setup> {
        Setup::new(scenario::load(self.scenario(), &[])?)
    }

    /// Does what a command of another verb asks for, which says nothing but errors.
    ///
    /// # Errors
    /// When there is no such command, and its own.
    pub fn run(&self, words: &[&str]) -> Result<ExitCode> {
        (self.run_command)(words, self.console)
    }

    /// The options of `verify`, and its voice.
    ///
    /// # Errors
    /// When it has no such options.
    pub fn verify(&self, words: &[&str]) -> Result<(verify::Args, Console)> {
        Ok((verify::Args::of(words)?, self.console.within(Vec::new())))
    }

    /// A digest of all that decides what a step comes to.
    pub fn input(&self, step: Step, journal: &Journal) -> String {
        let mut scenario = self.loaded.scenario.clone();
        let (training, windows) = (scenario.training.clone(), std::mem::take(&mut scenario.report));
        let description = std::mem::take(&mut scenario.description);
        // What they say is in the files beside.
        let beside = &self.files.files[1..];
        let own = match step {
            Step::Network => format!("{training:?} {:?}", self.files.network().ok().flatten()),
            Step::Accuracy => format!("{:?}", training.grid),
            Step::Frame => format!("{windows:?}"),
            Step::Report => format!("{description} {:?}", self.files.files),
            _ => String::new(),
        };
        let needs: Vec<_> = (step.needs().into_iter())
            .map(|need| journal.of(need).map(|record| (&record.outputs, &record.summary)))
            .collect();
        let version = env!("CARGO_PKG_VERSION");
        let (name, quick) = (&self.loaded.name, self.quick);
        let text =
            format_args!("{version} {step} {name} {quick} {scenario:?} {beside:?} {own} {needs:?}");
        format!("{:016x}", digest_of(text))
    }
}
