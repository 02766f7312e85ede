//! Steps that simulate: a frame with its waveform, and the errors over the grid, beside the Cramer-Rao bound.

use std::path::Path;
use std::process::ExitCode;

use tofsim::error::Result;
use tofsim::files::folder;
use tofsim::network::Network;
use tofsim_learn::dataset::{GridOption, GridPurpose};
use tofsim_learn::estimation::EstimatorKind;

use crate::record::read_object;
use crate::text::table::fixed;

use super::files::NETWORK;
use super::site::Site;
use super::step::Outcome;

/// Its folder.
pub const FRAME: &str = "frame";

pub fn frame(site: &Site) -> Result<Outcome> {
    site.run(&["run", site.scenario(), "-o", FRAME])?;
    let result = read_object(&Path::new(FRAME).join("summary.json"))?;
    let found = &result["frames"][0];
    let depth = |key: &str| found[key].as_f64().map_or("-".to_owned(), |m| format!("{m:.6} m"));
    let summary = format!("depth {} of {}", depth("depth_m"), depth("true_depth_m"));
    let outputs = folder::files_below(FRAME.as_ref())?;
    Ok(Outcome { outputs, result, passed: true, summary })
}

/// Its folder.
pub const ACCURACY: &str = "accuracy";
/// Most histograms, and histograms of a quick build.
const ROWS: u64 = 130_000;
const QUICK_ROWS: u64 = 3_000;
/// Histograms of each scene where all are drawn.
const REPEATS: u64 = 5;

pub fn accuracy(site: &Site) -> Result<Outcome> {
    let scenario = &site.loaded.scenario;
    let options = scenario.training.grid_options();
    let grid = GridOption::parse(&options)?.grid(scenario, GridPurpose::Test)?;
    let most = if site.quick { QUICK_ROWS } else { ROWS };
    let rows = (grid.scenes().saturating_mul(REPEATS) > most).then(|| most.to_string());
    let own = EstimatorKind::in_socket(scenario);
    let (network, estimators) = if own.is_network() {
        let is_network = |(_, kind, _): &&(_, EstimatorKind, _)| kind.is_network();
        (NETWORK, EstimatorKind::ALL.iter().filter(is_network).map(|(name, ..)| *name).collect())
    } else {
        (Network::DEFAULT, vec![own.name()])
    };
    let estimators = estimators.join(",");
    let mut words = vec!["evaluate", network, "--scenario", site.scenario(), "-o", ACCURACY];
    words.extend(["--estimator", &estimators, "--check", "2"]);
    options.iter().for_each(|option| words.extend(["--grid", option]));
    rows.iter().for_each(|rows| words.extend(["--rows", rows]));
    let agrees = site.run(&words)? == ExitCode::SUCCESS;
    let result = read_object(&Path::new(ACCURACY).join("evaluation.json"))?;
    let all = &result["estimators"][0]["all"];
    let number = |key: &str| all[key].as_f64().map_or("-".to_owned(), |mm| fixed(mm, 2));
    let summary = format!(
        "2σ {} mm, mean error {} mm, {} outliers of {}",
        number("two_sd_mm"),
        number("mean_mm"),
        all["outliers"],
        all["estimates"]
    );
    Ok(Outcome {
        outputs: folder::files_below(ACCURACY.as_ref())?,
        result,
        passed: agrees,
        summary,
    })
}
