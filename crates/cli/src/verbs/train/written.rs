//! What a training leaves in its folder.

use std::io::{self, Write};

use crate::report::{learning_curve, training as report};
use tofsim::error::{Error, Input, Result};
use tofsim::files::output::write_file;
use tofsim::network::Network;
use tofsim::network::file::{Accuracy, Training};
use tofsim::network::float::Float;
use tofsim::network::formats::{Fixed, Overflow};
use tofsim::sim::setup::Setup;
use tofsim_learn::quantize::datapath::{Circuit, Datapath};
use tofsim_learn::quantize::export;
use tofsim_learn::training::accuracy::Row;
use tofsim_learn::training::recipe::Recipe;
use tofsim_learn::training::tournament::Tournament;

use super::Args;
use crate::verbs::stdout::print;
use crate::verbs::talk::Talk;

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
        write("curve.csv", &learning_curve::csv(points))?;
        let svg = learning_curve::svg(points).map_err(io::Error::other);
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
