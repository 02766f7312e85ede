//! What a training leaves in its folder.

use std::io::{self, Write};

use crate::error::{Error, Input, Result};
use crate::network::datapath::{Circuit, Datapath};
use crate::network::file::{Accuracy, Training};
use crate::network::float::Float;
use crate::network::formats::{Fixed, Overflow};
use crate::network::{Network, export};
use crate::output::write_file;
use crate::sim::setup::Setup;
use crate::training::accuracy::Row;
use crate::training::recipe::Recipe;
use crate::training::tournament::Tournament;
use crate::training::{curve, report};

use super::Args;
use crate::cli::stdout::print;
use crate::cli::talk::Talk;

impl Args {
    /// Rounds, tests and writes the network.
    pub(super) fn finish(
        &self,
        setup: &Setup,
        recipe: &Recipe,
        tournament: &Tournament,
        talk: &Talk,
    ) -> Result<()> {
        let write = |name: &str, text: &str| -> Result<()> {
            let path = self.output.join(name);
            write_file(&path, |file| file.write_all(text.as_bytes()))?;
            talk.detail(format_args!("wrote {}", path.display()));
            Ok(())
        };
        let points = &tournament.state.curve;
        write("curve.csv", &curve::csv(points))?;
        let svg = curve::svg(points).map_err(io::Error::other);
        write("curve.svg", &svg.map_err(Error::io(&self.output.join("curve.svg"), "write"))?)?;
        let float = tournament.result();
        let is_firmware_s = recipe.formats == Datapath::default();
        let fixed = is_firmware_s.then(|| float.round("trained network", Overflow::Refuse));
        let fixed = fixed.transpose()?.map(|rounded| rounded.fixed);
        let circuit = Circuit::new(&float, recipe.formats)?;
        if circuit.saturated_weights > 0 {
            let expected = "weights that their words do not hold, expected none; train longer";
            let fault = Input::new("trained network", expected);
            return Err(fault.value(circuit.saturated_weights).into());
        }
        let rows = tournament.test(&circuit)?;
        write("accuracy.csv", &report::csv(&rows))?;

        let best = tournament.state.best.as_ref();
        let block = best.map_or(String::new(), |best| {
            format!(", start {} after block {}", best.start, best.block)
        });
        let training = Training {
            origin: format!("Levenberg-Marquardt on simulated histograms{block}"),
            chain: self.profile.clone().unwrap_or_else(|| setup.scenario.tdc.profile.clone()),
            command: Some(self.command()),
            seed: Some(self.seed),
            data: Some(tournament.state.data.clone()),
        };
        let (name, text) = match fixed {
            Some(fixed) => ("network.toml", network(fixed, float, training, &rows, recipe)),
            None => ("network.json", export::json(&float, &training)),
        };
        let path = self.output.join(name);
        print(&match self.json {
            true => report::json(&rows, &recipe.weighting, &path)?,
            false => report::table(&rows, &recipe.weighting),
        })?;
        write_file(&path, |file| file.write_all(text.as_bytes()))
    }
}

/// The file of the network in the firmware's words, with what is known of it.
fn network(
    fixed: Fixed,
    float: Float,
    training: Training,
    rows: &[Row],
    recipe: &Recipe,
) -> String {
    let line = &recipe.weighting.distances_m;
    let rows: Vec<&Row> = rows.iter().filter(|row| line.contains(&row.distance_m)).collect();
    let accuracy = Accuracy {
        distances_m: rows.iter().map(|row| row.distance_m).collect(),
        two_sd_mm: rows.iter().map(|row| report::hundredths(row.two_sd_mm)).collect(),
        mean_mm: Some(rows.iter().map(|row| report::hundredths(row.mean_mm)).collect()),
    };
    let (neurons, chain) = (recipe.neurons, &training.chain);
    let network = Network {
        name: String::new(),
        description: format!("256-{neurons}-1 depth network for the bins of chain {chain}"),
        fixed,
        training,
        accuracy: Some(accuracy),
        float: Some(float),
    };
    network.to_toml()
}
