//! Files of a training.

use std::path::{Path, PathBuf};

use tofsim::error::Result;
use tofsim::files::output::write_bytes;
use tofsim::kernel::Overflow;
use tofsim::network::Fixed;
use tofsim::network::file::{Accuracy, Training};
use tofsim::network::float::Float;
use tofsim::network::unrounded::Unrounded;
use tofsim::network::{Domain, Network};
use tofsim_learn::quantize::Circuit;
use tofsim_learn::training::accuracy::DistanceErrors;
use tofsim_learn::training::recipe::Recipe;
use tofsim_learn::training::tournament::Tournament;

use crate::record::Record;
use crate::report::training as report;
use crate::verbs::terminal::Console;

/// Origin of a network.
pub struct TrainingOrigin<'a> {
    /// Chain on whose bins it was trained.
    pub chain: String,
    /// Command that trains it again.
    pub command: String,
    /// Seed of data and starts.
    pub seed: u64,
    /// Domain of its training.
    pub domain: Option<Domain>,
    /// Record in its files.
    pub record: &'a Record,
}

/// Rounds, tests and writes a network; the network's file, and its errors.
pub fn write(
    folder: &Path,
    recipe: &Recipe,
    tournament: &Tournament,
    made: TrainingOrigin,
    console: &Console,
) -> Result<(PathBuf, Vec<DistanceErrors>)> {
    let write = |name: &str, text: &str| -> Result<PathBuf> {
        let path = folder.join(name);
        write_bytes(&path, text)?;
        console.wrote(&path);
        Ok(path)
    };
    let points = &tournament.state.curve;
    let line = made.record.comment_line();
    write("curve.csv", &(line.clone() + &report::curve_csv(points)))?;
    write("curve.svg", &made.record.in_svg(&report::curve_svg(points)?))?;
    let float = tournament.result();
    let rounded = float.round("trained network", &recipe.formats, Overflow::Saturate)?;
    if rounded.saturated > 0 {
        // The errors below are those with the saturated ones.
        console.note(format_args!(
            "note: weights that do not fit their words and are saturated: {} (expected none: train longer, \
             or with a larger limits.penalty)",
            rounded.saturated
        ));
    }
    let rows = tournament.test(&Circuit::of_words(&rounded.fixed, &recipe.formats));
    write("accuracy.csv", &(line.clone() + &report::csv(&rows)))?;

    let best = tournament.state.best.as_ref();
    let block = best
        .map_or(String::new(), |best| format!(", start {} after block {}", best.start, best.block));
    let training = Training {
        origin: format!("Levenberg-Marquardt on simulated histograms{block}"),
        chain: made.chain,
        command: Some(made.command),
        seed: Some(made.seed),
        data: Some(tournament.state.data.clone()),
    };
    let network = network(rounded.fixed, float, training, &rows, recipe);
    let network = Network { domain: made.domain, ..network };
    Ok((write("network.toml", &(line + &network.to_toml()))?, rows))
}

/// The file of the network in the firmware's words, with what is known of it.
fn network(
    fixed: Fixed,
    float: Float,
    training: Training,
    rows: &[DistanceErrors],
    recipe: &Recipe,
) -> Network {
    let line = &recipe.weighting.distances_m;
    let rows: Vec<&DistanceErrors> =
        rows.iter().filter(|row| line.contains(&row.distance_m)).collect();
    let accuracy = Accuracy {
        distances_m: rows.iter().map(|row| row.distance_m).collect(),
        two_sd_mm: rows.iter().map(|row| report::hundredths(row.two_sd_mm)).collect(),
        mean_mm: Some(rows.iter().map(|row| report::hundredths(row.mean_mm)).collect()),
    };
    let (bins, neurons, chain) = (fixed.bins(), recipe.neurons, &training.chain);
    Network {
        name: String::new(),
        description: format!("{bins}-{neurons}-1 depth network for the bins of chain {chain}"),
        datapath: recipe.formats,
        fixed,
        training,
        domain: None,
        accuracy: Some(accuracy),
        float: Unrounded::Known(float),
    }
}
