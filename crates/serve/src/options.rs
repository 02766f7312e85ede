//! What the command line says.

use tofsim::error::Result;
use tofsim::scenario::{self, Loaded};
use tofsim::sim::Stepping;

/// The acquisition computer as a page in a browser on this computer
///
/// `tofsim serve` runs this program. It prints the page's address, which holds a secret, and serves it until
/// Ctrl-C.
#[derive(Clone, Debug, clap::Parser)]
#[command(name = "tofsim-serve", version)]
pub struct Options {
    /// Built-in scenario or the path of a scenario file
    #[arg(default_value = scenario::DEFAULT)]
    pub scenario: String,
    /// Set a key of the scenario, such as target.distance_m=0.3; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Seed of every random stream, instead of the scenario's
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// How to go through time
    #[arg(long, value_enum, default_value_t = Fidelity::Cycle)]
    pub fidelity: Fidelity,
    /// Port on 127.0.0.1; 0 takes any that is free
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub port: u16,
    /// Frames a second at most
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub rate: u32,
    /// Wait for a press of Start before the first frame
    #[arg(long)]
    pub stopped: bool,
    /// Print one JSON object instead of the address
    #[arg(long)]
    pub json: bool,
    /// Leave out the notes on what results lie outside of; the page has them
    #[arg(long)]
    pub without_notes: bool,
    /// Print nothing but errors and the address
    #[arg(short, long)]
    pub quiet: bool,
}

/// How a run goes through time. The frames are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Fidelity {
    /// Every cycle, with the cause of every avalanche
    Cycle,
    /// Leaps over shots that are alike; causes are what is to be expected
    Shot,
}

impl Fidelity {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Fidelity::Cycle => "cycle",
            Fidelity::Shot => "shot",
        }
    }

    /// The way through time where nobody looks at signals.
    pub fn stepping(self) -> Stepping {
        match self {
            Fidelity::Cycle => Stepping::SkipIdle,
            Fidelity::Shot => Stepping::LeapShots,
        }
    }
}

impl Options {
    /// The scenario, with `further` keys set behind those of the command line.
    ///
    /// # Errors
    /// When there is none of that name, or a key or a value is wrong.
    pub fn load(&self, further: &[String]) -> Result<Loaded> {
        let mut loaded = scenario::load(&self.scenario, &[&self.set, further].concat())?;
        loaded.scenario.seed = self.seed.unwrap_or(loaded.scenario.seed);
        Ok(loaded)
    }
}
