//! `tofsim estimate`: depths of histograms from files, bit for bit as the firmware computes them, and
//! what other estimators say.

use std::path::PathBuf;

use tofsim::error::{Input, Result};
use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::scenario::{self, Loaded};
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode};
use tofsim_learn::dataset::labelled::histograms;
use tofsim_learn::dataset::sensor::Layout;
use tofsim_learn::estimation::EstimatorKind;

use crate::choice::words;
use crate::report::estimates::EstimateFindings;
use crate::report::statistics::second_opinion;
use crate::report::writer::Report;

use super::draws::from_here;
use super::pixel::common_of_counts;
use super::terminal::Console;

mod reading;
mod sensor;

pub(super) use sensor::check_bins;

use reading::Reading;
use sensor::{Request, Sensor};

/// Estimate depths of histograms, bit for bit as the firmware does
#[derive(Debug, clap::Args)]
pub struct Args {
    /// CSV with a row for each bin (bin,count, time_ns,count, time_ps,count or count), .npy of 256 or n x 256 whole
    /// numbers, or Parquet with columns b0 to b255
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Bin width of histograms from another sensor, with any number of bins [ps]
    #[arg(long, value_name = "PS", value_parser = width, conflicts_with_all = ["network", "explain"])]
    bin_ps: Option<f64>,
    /// Built-in network, such as uniform-16, or network file [default: the scenario's]
    #[arg(long, value_name = "NAME|FILE")]
    network: Option<String>,
    /// Additional estimators for the same histograms, separated by commas
    #[arg(long, value_parser = words(EstimatorKind::ALL), value_delimiter = ',')]
    estimator: Vec<EstimatorKind>,
    /// Built-in scenario, or the path of a scenario file: shots, pulse and chain for the estimators
    #[arg(long, default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a scenario key, e.g. `tdc.profile=chain.toml`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Compare every value of the datapath with double precision, and list the cost of each rounding; with
    /// --estimator likelihood_estimator, compare the stages of that estimator instead, and with
    /// network,likelihood_estimator both
    #[arg(long)]
    explain: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub(super) fn width(text: &str) -> std::result::Result<f64, String> {
    let width = text.parse().ok().filter(|ps| (1.0..=1e6).contains(ps));
    width.ok_or_else(|| "expected the width of a bin, 1 to 1e6 ps".to_owned())
}

/// Loads the scenario of histograms. A count of another sensor may be as wide as a count can be.
pub(super) fn load_for(layout: Option<Layout>, scenario: &str, set: &[String]) -> Result<Loaded> {
    let is_own = layout.is_some_and(Layout::has_times);
    let widest = is_own.then(|| "firmware.count_bits=24".to_owned());
    let set: Vec<_> = widest.into_iter().chain(set.iter().cloned()).collect();
    scenario::load(scenario, &set)
}

/// Runs the verb.
pub fn run(args: &Args, console: &Console) -> Result<()> {
    let layout = Layout::of(&args.files[0], args.bin_ps)?;
    let setup = args.setup(layout)?;
    let request = args.request();
    if let Some(sensor) = Sensor::of(&request, layout, &setup)? {
        return sensor.run(&request, &setup, console);
    }
    setup.check_estimator()?;
    let mut notes = args.notes(&setup)?;
    console.print_notes(&notes)?;
    let second = second_opinion(&setup, &mut notes, console);
    let explains = (args.explains_network(&setup), args.explains_likelihood(&setup));
    let names: Vec<String> = args.files.iter().map(|file| file.display().to_string()).collect();
    let mut reading = Reading::new(&setup, &args.estimator, second, explains)?;
    for (path, file) in args.files.iter().zip(&names) {
        for histogram in histograms(path, setup.params.histogram)? {
            reading.take(file, &histogram?);
        }
    }
    let late = reading.notes();
    console.print_notes(&late)?;
    notes.extend(late);
    let (several, explain) = (names.len() > 1, args.explain);
    let network = reading.is_network.then_some(&setup.network);
    let findings = EstimateFindings { network, sensor: None, rows: reading.rows, several, explain };
    Report::new(findings, &setup, &notes, console).deliver(None, args.json, console)
}

impl Args {
    /// Returns the setup of the histograms, as far as it is known.
    fn setup(&self, layout: Option<Layout>) -> Result<Setup> {
        let mut loaded = load_for(layout, &self.scenario, &self.set)?;
        if let Some(file) = &loaded.scenario.array.chains_file {
            let expected = "expected none: all histograms are taken to be of one chain; `evaluate --data` has that of each column";
            let fault = Input::new(format!("scenario {}", loaded.name), expected);
            return Err(fault.field("array.chains_file").value(file).into());
        }
        if let Some(network) = &self.network {
            loaded.scenario.estimator.network = from_here(network, &loaded)?;
            loaded.scenario.estimator.kind = FirmwareEstimator::Network;
        }
        common_of_counts(loaded)
    }

    fn request(&self) -> Request<'_> {
        let is_default = self.scenario == scenario::DEFAULT;
        Request {
            files: &self.files,
            estimators: &self.estimator,
            wants_firmware: self.network.is_some() || self.explain,
            set: is_default.then_some(&self.set),
            json: self.json,
        }
    }

    fn explains_likelihood(&self, setup: &Setup) -> bool {
        let is_own = setup.params.estimator == FirmwareEstimator::LikelihoodEstimator;
        self.explain && (is_own || self.estimator.contains(&EstimatorKind::LikelihoodEstimator))
    }

    /// It is explained unless it is another one that is asked for.
    fn explains_network(&self, setup: &Setup) -> bool {
        let is_asked_for = self.estimator.contains(&EstimatorKind::Network);
        self.explain && (is_asked_for || !self.explains_likelihood(setup))
    }

    /// Returns the notes on the depths; those of the network's training only if the histograms' scenario was given.
    fn notes(&self, setup: &Setup) -> Result<Vec<Note>> {
        let is_said = self.scenario != scenario::DEFAULT || !self.set.is_empty();
        let mut notes = if is_said { setup.notes()? } else { Vec::new() };
        // Whether light can have made the histogram does not matter: it is there.
        notes
            .retain(|note| matches!(note.code, NoteCode::OutsideTraining | NoteCode::ChainDrifted));
        let own = (setup.params.estimator != FirmwareEstimator::Network)
            .then(|| EstimatorKind::in_socket(&setup.scenario));
        notes.extend(own.iter().chain(&self.estimator).flat_map(|kind| kind.notes(setup)));
        Ok(notes)
    }
}
