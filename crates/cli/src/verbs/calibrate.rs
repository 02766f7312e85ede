//! `tofsim calibrate`: what an instrument's own histograms tell of it.

use std::path::PathBuf;

use clap::Subcommand;

use tofsim::error::{Input, Result};
use tofsim::scenario;
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode};
use tofsim_learn::calibration::candidates::{Calibration, Kind};
use tofsim_learn::estimation::Acquisition;

use crate::choice::{CALIBRATED, words};
use crate::report::calibration::PulseFindings;
use crate::report::writer::Report;

use super::deferred::Deferred;
use super::estimate::width;
use super::options::ResultArgs;
use super::terminal::Console;

mod files;
mod glass;

use files::HistogramFiles;
use glass::GlassArgs;

/// Fit parameters of an instrument to its histograms
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    verb: Deferred<Verb>,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Pulse(Box<PulseArgs>),
    Glass(Box<GlassArgs>),
}

/// Fit width and shape of the pulse, with standard errors
///
/// Arrival, signal and background of each histogram need not be known: they are fitted together with the pulse that
/// all have in common. A few histograms of echoes in the middle of the window, neither faint nor so strong that they
/// use up their shots, determine the width to 1 % or better. -o writes pulse.csv for laser.pulse_file, pulse.svg and
/// calibration.json.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
    tofsim calibrate pulse mine.npy --scenario mine.toml -o pulse\n  \
    tofsim run mine.toml -s laser.pulse_file=pulse/pulse.csv")]
struct PulseArgs {
    /// Histograms: CSV with a row for each bin (bin,count, time_ns,count, time_ps,count or count), .npy of 256 or
    /// n x 256 whole numbers, or Parquet with columns b0 to b255
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Built-in scenario, or the path of a scenario file: shots and chain of the histograms, and the pulse to
    /// compare
    #[arg(long, default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a scenario key, e.g. `firmware.shots_per_frame=10000`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Bin width of histograms from another sensor, with any number of bins [ps]
    #[arg(long, value_name = "PS", value_parser = width)]
    bin_ps: Option<f64>,
    /// Shape to fit [default: the first that describes the histograms]
    #[arg(long, value_parser = words(CALIBRATED))]
    shape: Option<Kind>,
    /// Interval between samples of a measured pulse [default: a bin]
    #[arg(long, value_name = "PS")]
    step_ps: Option<f64>,
    #[command(flatten)]
    result: ResultArgs,
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    match &args.verb.0 {
        Verb::Pulse(args) => args.run(console),
        Verb::Glass(args) => args.run(console),
    }
}

impl PulseArgs {
    fn run(&self, console: &Console) -> Result<()> {
        let files = HistogramFiles::new(&self.files, self.bin_ps, &self.scenario, &self.set)?;
        let (setup, bins) = (&files.setup, &files.bins);
        if let Some(file) = &setup.scenario.estimator.glass_file {
            let expected =
                "expected none: the pulse is fitted to echoes without a cover window's light";
            let fault = Input::new("calibrate pulse", expected).field("estimator.glass_file");
            return Err(fault.value(file).into());
        }
        let shots = setup.params.frame_ctrl.shots_per_frame.into();
        let acquisition = Acquisition::of(setup, bins, shots);
        let histograms = files.read(&acquisition)?.into_iter().map(|(.., histogram)| histogram);
        let step_ps = self.step_ps.unwrap_or(bins.bin_ps());
        let calibration =
            Calibration::new(&acquisition, histograms.collect(), self.shape, step_ps)?;
        let notes = notes(setup, &calibration);
        console.print_notes(&notes)?;
        let report = Report::new(PulseFindings { calibration, shots }, setup, &notes, console);
        self.result.deliver(&report, console)
    }
}

/// Returns the notes on light that is not one echo, and on a pulse that does not describe the histograms.
fn notes(setup: &Setup, calibration: &Calibration) -> Vec<Note> {
    let not_one_echo = setup.scenario.complex_scene().map(|found| {
        let text = format!("calibrate pulse: {}", found.effect.why());
        let expected = found.expected();
        Note::new(NoteCode::EstimatorOutsideModel, found.key, found.value, expected, text)
    });
    let goodness = calibration.taken().goodness;
    let text = "the pulse does not describe the histograms: try another --shape, and look whether shots and \
                chain are those of the scenario";
    let note = || {
        let value = goodness.chi_square / goodness.degrees_of_freedom;
        Note::new(NoteCode::DoubtfulFit, "chi_square", value, "about 1 a degree of freedom", text)
    };
    let doubtful = calibration.is_doubtful().then(note);
    not_one_echo.into_iter().chain(doubtful).collect()
}
