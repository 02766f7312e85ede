//! The errors over the grid, beside the Cramer-Rao bound.

use std::path::Path;
use std::process::ExitCode;

use serde_json::Value;

use tofsim::error::{Input, Result, read_text};
use tofsim::files::folder;
use tofsim::network::Network;
use tofsim_learn::dataset::{GridOption, GridPurpose};
use tofsim_learn::estimation::EstimatorKind;

use super::files::NETWORK;
use super::site::Site;
use super::step::Outcome;

/// Its folder.
pub const FOLDER: &str = "accuracy";
/// Most histograms, and histograms of a quick build.
const ROWS: u64 = 130_000;
const QUICK_ROWS: u64 = 3_000;
/// Histograms of each scene where all are drawn.
const REPEATS: u64 = 5;

pub fn run(site: &Site) -> Result<Outcome> {
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
    let mut words = vec!["evaluate", network, "--scenario", site.scenario(), "-o", FOLDER];
    words.extend(["--estimator", &estimators, "--check", "2"]);
    options.iter().for_each(|option| words.extend(["--grid", option]));
    rows.iter().for_each(|rows| words.extend(["--rows", rows]));
    let agrees = site.run(&words)? == ExitCode::SUCCESS;
    let path = Path::new(FOLDER).join("evaluation.json");
    let result: Value = serde_json::from_str(&read_text(&path)?)
        .map_err(|error| Input::new(path.display(), error))?;
    let all = &result["estimators"][0]["all"];
    let number = |key: &str| all[key].as_f64().map_or("-".to_owned(), |mm| format!("{mm:.2}"));
    let summary = format!(
        "2σ {} mm, mean error {} mm, {} outliers of {}",
        number("two_sd_mm"),
        number("mean_mm"),
        all["outliers"],
        all["estimates"]
    );
    Ok(Outcome { outputs: folder::files_below(FOLDER.as_ref())?, result, passed: agrees, summary })
}
