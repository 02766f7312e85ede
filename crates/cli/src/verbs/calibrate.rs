//! `tofsim calibrate`: what an instrument's own histograms tell of it.

use std::path::PathBuf;

use clap::Subcommand;

use tofsim::error::Result;
use tofsim::network::Histogram;
use tofsim::scenario;
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode};
use tofsim_learn::calibration::candidates::{Calibration, Kind};
use tofsim_learn::dataset::labelled::histograms;
use tofsim_learn::dataset::sensor::Layout;
use tofsim_learn::estimation::Acquisition;

use crate::choice::{CALIBRATED, words};
use crate::report::calibration::PulseFindings;
use crate::report::writer::Report;

use super::estimate::{check_bins, load_for, width};
use super::options::ResultArgs;
use super::terminal::Console;

/// Fit parameters of an instrument to its histograms
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Pulse(Box<PulseArgs>),
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
    match &args.verb {
        Verb::Pulse(args) => args.run(console),
    }
}

impl PulseArgs {
    fn run(&self, console: &Console) -> Result<()> {
        let layout = Layout::of(&self.files[0], self.bin_ps)?;
        let setup = Setup::of_counts(load_for(layout, &self.scenario, &self.set)?)?;
        let sensor = layout.filter(|layout| layout.has_times());
        if let (Some(layout), None) = (layout, sensor) {
            check_bins(&self.files[0], layout, &setup)?;
        }
        let bins = sensor.and_then(|layout| layout.even_bins());
        let bins = bins.unwrap_or_else(|| setup.known_bins());
        let shots = setup.params.frame_ctrl.shots_per_frame.into();
        let acquisition = Acquisition::of(&setup, &bins, shots);
        let histograms = self.all(sensor, &setup, &acquisition)?;
        let step_ps = self.step_ps.unwrap_or(bins.bin_ps());
        let calibration = Calibration::new(&acquisition, histograms, self.shape, step_ps)?;
        let notes = notes(&setup, &calibration);
        console.print_notes(&notes)?;
        let report = Report::new(PulseFindings { calibration, shots }, &setup, &notes, console);
        self.result.deliver(&report, console)
    }

    /// The histograms of all files, of the scenario's firmware or of another sensor.
    fn all(
        &self,
        sensor: Option<Layout>,
        setup: &Setup,
        acquisition: &Acquisition,
    ) -> Result<Vec<Histogram>> {
        let mut all = Vec::new();
        for path in &self.files {
            let found = match sensor {
                Some(layout) => layout.histograms(path, &self.files[0])?,
                None => histograms(path, setup.params.histogram)?,
            };
            for (number, histogram) in found.enumerate() {
                let histogram = histogram?;
                acquisition.check_hits(&path.display().to_string(), number, &histogram)?;
                all.push(histogram);
            }
        }
        Ok(all)
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
