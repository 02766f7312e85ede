//! The network: the one that the file names if it fits, or else one that is trained.

use std::path::{Path, PathBuf};

use serde_json::json;

use tofsim::error::{Error, Result, read_text};
use tofsim::files::output::write_bytes;
use tofsim::firmware::tof_top::FirmwareEstimator;
use tofsim::network::Network;
use tofsim::sim::domain;
use tofsim_learn::dataset::{GridOption, GridPurpose};

use super::files::NETWORK;
use super::site::Site;
use super::step::Outcome;

/// Folder of a training.
const TRAINING: &str = "training";

pub fn run(site: &Site, anew: bool) -> Result<Outcome> {
    if site.loaded.scenario.estimator.kind != FirmwareEstimator::Network {
        let result = json!({ "how": "none" });
        let summary = "none: the estimator is no network".to_owned();
        return Ok(Outcome { outputs: Vec::new(), result, passed: true, summary });
    }
    let named = site.files.network()?;
    let reason = match &named {
        None => format!("{} is not there", site.files.loaded.scenario.estimator.network),
        Some((name, text)) => match why_not(site, name, text)? {
            None => {
                write_bytes(Path::new(NETWORK), text)?;
                let neurons = Network::parse(text, name)?.fixed.neurons();
                let result = json!({ "how": "taken", "from": name, "neurons": neurons });
                let summary = format!("{name}, as the file says: {neurons} neurons");
                let outputs = vec![PathBuf::from(NETWORK)];
                return Ok(Outcome { outputs, result, passed: true, summary });
            }
            Some(reason) => reason,
        },
    };
    site.console.note(format_args!("network: trained, because {reason}"));
    train(site, anew)?;
    let trained = Path::new(TRAINING).join(NETWORK);
    let text = read_text(&trained)?;
    write_bytes(Path::new(NETWORK), &text)?;
    let neurons = Network::parse(&text, NETWORK)?.fixed.neurons();
    let result = json!({ "how": "trained", "because": reason, "neurons": neurons });
    let summary = format!("trained: {neurons} neurons, because {reason}");
    let files = ["network.toml", "accuracy.csv", "curve.csv", "curve.svg"];
    let mut outputs: Vec<_> = files.iter().map(|name| Path::new(TRAINING).join(name)).collect();
    outputs.push(PathBuf::from(NETWORK));
    Ok(Outcome { outputs, result, passed: true, summary })
}

/// Why a network is not this instrument's, if it is not. One of the user's own only has to fit, one that comes
/// with the program has to have been trained for what the file says.
fn why_not(site: &Site, name: &str, text: &str) -> Result<Option<String>> {
    let (scenario, histogram) = (&site.loaded.scenario, site.setup.params.histogram);
    let network = Network::parse(text, name)?;
    if !network.fits(&histogram) {
        let (has, bins) = (network.fixed.bins(), histogram.bins);
        return Ok(Some(format!("{name} has {has} inputs and not {bins}")));
    }
    let (has, wanted) = (network.fixed.neurons(), scenario.training.neurons);
    if let Some(wanted) = wanted.filter(|wanted| *wanted != has as u64) {
        return Ok(Some(format!("{name} has {has} neurons and not {wanted}")));
    }
    let option = GridOption::parse(&scenario.training.grid_options())?;
    let grid = option.grid(scenario, GridPurpose::Test)?;
    let notes = domain::notes(&network, scenario, &grid.ranges())?;
    if Network::builtin_text(name).is_some() {
        let other = notes.first();
        return Ok(
            other.map(|note| format!("{name} was not trained for {} = {}", note.key, note.value))
        );
    }
    notes.iter().for_each(|note| site.console.note(note));
    Ok(None)
}

/// Trains one, from where an earlier training of the same kind was stopped.
fn train(site: &Site, anew: bool) -> Result<()> {
    let checkpoint = Path::new(TRAINING).join("checkpoint");
    // The scenario names the network that is about to be made.
    let any = format!("estimator.network={}", Network::DEFAULT);
    let mut words = vec!["train", site.scenario(), "-s", &any, "-o", TRAINING];
    words.extend(site.quick.then_some("--quick"));
    let resumed = [&words[..], &["--resume"]].concat();
    if checkpoint.exists() && !anew {
        match site.run(&resumed) {
            // It is another training's.
            Err(Error::Input(_)) => {}
            ended => return ended.map(drop),
        }
    }
    site.run(&words).map(drop)
}
