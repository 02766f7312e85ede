//! `tofsim estimate`: depths of histograms from files, bit for bit as the firmware computes them, and
//! what other estimators say.

use std::path::PathBuf;

use serde::Serialize;
use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::firmware::tof_top::slot::EstimateWords;
use tofsim::network::{self, Network, estimate};
use tofsim::scenario;
use tofsim::sim::estimates::digits;
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode};
use tofsim_learn::dataset::labelled::histograms;
use tofsim_learn::estimation::{Estimate, EstimatorKind, Panel};
use tofsim_learn::quantize::{ExplainedLikelihood, Explanation, LikelihoodExplainer, explain};

use crate::choice::words;
use crate::report::writer::{Findings, Report};
use crate::report::{explanation, readings};
use crate::text;

use super::draws::from_here;
use super::terminal::Talk;

/// Estimate depths of histograms, bit for bit as the firmware does
#[derive(Debug, clap::Args)]
pub struct Args {
    /// CSV with header bin,count and a row for each bin, .npy of 256 or n x 256 whole numbers, or Parquet with columns
    /// b0 to b255
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Built-in network, such as uniform-16, or network file [default: the scenario's]
    #[arg(long, value_name = "NAME|FILE")]
    network: Option<String>,
    /// Estimators that see the same histograms too, separated by commas
    #[arg(long, value_parser = words(EstimatorKind::ALL), value_delimiter = ',')]
    estimator: Vec<EstimatorKind>,
    /// Built-in scenario, or the path of a scenario file: what estimators know of shots, pulse and chain
    #[arg(long, default_value = scenario::DEFAULT)]
    scenario: String,
    /// Set a scenario key, e.g. `tdc.profile=chain.toml`; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Show every value of the datapath beside its twin in double precision, where they part, and
    /// what each rounding adds to the depth; with --estimator likelihood_estimator the stages of that one instead,
    /// and of both with network,likelihood_estimator
    #[arg(long)]
    explain: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// A line of the result.
#[derive(Serialize)]
struct Row<'a> {
    /// Place among all histograms of all files.
    index: usize,
    file: &'a str,
    #[serde(flatten)]
    numbers: Numbers,
    /// Results of the other estimators.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    estimates: Vec<Estimate>,
    #[serde(skip_serializing_if = "Option::is_none")]
    explanation: Option<Explanation>,
    #[serde(skip_serializing_if = "Option::is_none")]
    likelihood_explanation: Option<ExplainedLikelihood>,
}

#[derive(Serialize)]
struct Numbers {
    /// The estimate of the network.
    #[serde(flatten)]
    estimate: Estimate,
    /// Sums of the hidden neurons as integers, with the fraction bits of their weights.
    l1_in: Vec<i64>,
}

/// Runs the verb.
pub fn run(args: &Args, talk: &Talk) -> Result<()> {
    let setup = args.setup()?;
    let network = &setup.network;
    let size = setup.params.histogram;
    let params = network.params(&size);
    let notes = args.notes(&setup)?;
    talk.heed(&notes)?;
    let panel = Panel::new(&args.estimator, &setup)?;
    let explainer = args.explains_likelihood().then(|| LikelihoodExplainer::new(&setup));
    let explainer = explainer.transpose()?;
    let names: Vec<String> = args.files.iter().map(|file| file.display().to_string()).collect();
    let mut rows = Vec::new();
    for (path, file) in args.files.iter().zip(&names) {
        for histogram in histograms(path, size)? {
            let histogram = histogram?;
            let numbers = Numbers::of(&estimate(&params, &histogram), params.neurons());
            let explanation = args.explains_network().then(|| explain(network, &histogram));
            let likelihood_explanation =
                explainer.as_ref().map(|explainer| explainer.explain(&histogram));
            let estimates = panel.read(&histogram);
            let index = rows.len();
            rows.push(Row { index, file, numbers, estimates, explanation, likelihood_explanation });
        }
    }
    let (several, explain) = (names.len() > 1, args.explain);
    let findings = EstimateFindings { network, rows, several, explain };
    Report::new(findings, &setup, &notes, talk).deliver(None, args.json, talk)
}

/// Estimates of all histograms.
struct EstimateFindings<'a> {
    network: &'a Network,
    rows: Vec<Row<'a>>,
    /// Whether there are several files.
    several: bool,
    /// Whether people see every value of the datapath.
    explain: bool,
}

impl Findings for EstimateFindings<'_> {
    const SCHEMA: &'static str = "tofsim.estimate/1";

    fn json(&self) -> Value {
        let mut json = json!({ "network": self.network.name, "histograms": self.rows });
        // Once more for scripts, if there is just one histogram.
        if let [row] = &self.rows[..] {
            let numbers = json!(row.numbers);
            for key in ["depth_raw", "depth_m", "l1_in"] {
                json[key] = numbers[key].clone();
            }
        }
        json
    }

    fn text(&self) -> String {
        if self.explain {
            return self.rows.iter().map(explained).collect::<Vec<_>>().join("\n");
        }
        let fraction = self.network.datapath.w1.fraction;
        self.rows.chunks(TABLE).map(|rows| table(rows, fraction, self.several)).collect()
    }
}

impl Args {
    /// Returns the setup of the histograms, as far as it is known.
    fn setup(&self) -> Result<Setup> {
        let mut loaded = scenario::load(&self.scenario, &self.set)?;
        if let Some(network) = &self.network {
            loaded.scenario.estimator.network = from_here(network, &loaded)?;
        }
        let setup = Setup::of_counts(loaded)?;
        setup.check_network()?;
        Ok(setup)
    }

    fn explains_likelihood(&self) -> bool {
        self.explain && self.estimator.contains(&EstimatorKind::LikelihoodEstimator)
    }

    /// It is explained unless it is another one that is asked for.
    fn explains_network(&self) -> bool {
        let is_asked_for = self.estimator.contains(&EstimatorKind::Network);
        self.explain && (is_asked_for || !self.explains_likelihood())
    }

    /// Returns the notes on the depths; those of the network only if the histograms' scenario was given.
    fn notes(&self, setup: &Setup) -> Result<Vec<Note>> {
        let is_said = self.scenario != scenario::DEFAULT || !self.set.is_empty();
        let mut notes = if is_said { setup.notes()? } else { Vec::new() };
        // Whether light can have made the histogram does not matter: it is there.
        notes
            .retain(|note| matches!(note.code, NoteCode::OutsideTraining | NoteCode::ChainDrifted));
        notes.extend(self.estimator.iter().flat_map(|kind| kind.notes(setup)));
        Ok(notes)
    }
}

impl Numbers {
    fn of(pass: &network::Estimate, neurons: usize) -> Self {
        let words = EstimateWords::of_depth(pass.depth);
        Numbers {
            estimate: Estimate::of_words(FirmwareEstimator::Network, &words),
            l1_in: pass.l1_in[..neurons].iter().map(|sum| sum.get()).collect(),
        }
    }

    fn depth_m(&self) -> f64 {
        self.estimate.depth_m.unwrap_or(f64::NAN)
    }

    fn depth_raw(&self) -> String {
        self.estimate.depth_raw.map(digits).unwrap_or_default()
    }
}

/// The values of one estimation, layer by layer, or stage by stage.
fn explained(row: &Row) -> String {
    let Row { index, file, numbers, .. } = row;
    let (depth_m, depth_raw) = (numbers.depth_m(), numbers.depth_raw());
    let network = row.explanation.as_ref().map(|of| {
        format!("{file} #{index}: {depth_m:.6} m ({depth_raw})\n{}", explanation::network(of))
    });
    let likelihood = row.likelihood_explanation.as_ref().map(|of| {
        let ExplainedLikelihood { depth_raw, depth_m, sigma_m, .. } = of;
        let name = EstimatorKind::LikelihoodEstimator.name();
        let text = explanation::likelihood(of);
        format!("{file} #{index}: {depth_m:.6} m ({depth_raw}), {name}, sd {sigma_m:.6} m\n{text}")
    });
    network.into_iter().chain(likelihood).collect::<Vec<_>>().join("\n")
}

/// Rows of a table; what has more goes into several.
const TABLE: usize = 10_000;

fn table(rows: &[Row], fraction: u32, several: bool) -> String {
    let sums = format!("l1_in ({fraction} fraction bits)");
    let mut header = vec!["index", "depth_raw", "depth_m", &sums];
    let others = rows.first().map_or(&[][..], |row| &row.estimates);
    header.extend(others.iter().map(|reading| reading.estimator));
    header.extend(several.then_some("file"));
    let rows = rows.iter().map(|Row { index, file, numbers, estimates, .. }| {
        let sums = numbers.l1_in.iter().map(i64::to_string).collect::<Vec<_>>().join(" ");
        let depth_m = format!("{:.6}", numbers.depth_m());
        let mut cells = vec![index.to_string(), numbers.depth_raw(), depth_m, sums];
        let depth = |reading| readings::said(reading, |depth_m| format!("{depth_m:.6}"));
        cells.extend(estimates.iter().map(depth));
        cells.extend(several.then(|| file.to_string()));
        cells
    });
    text::table::table(header, rows, ..3) + "\n"
}
