//! Command-line options.

use std::time::Duration;

use tofsim::error::Result;
use tofsim::scenario::{self, Loaded};
use tofsim::sim::Stepping;
use tofsim_board::PortOptions;
use tofsim_board::port::{BAUD, BAUDS};

/// Run the acquisition computer as a page in a browser on this computer
///
/// `tofsim serve` runs this program. It prints the page's URL, which includes a secret token, and serves the page
/// until Ctrl-C.
#[derive(Clone, Debug, clap::Parser)]
#[command(name = "tofsim-serve", version)]
pub struct Options {
    /// Built-in scenario or the path of a scenario file
    #[arg(default_value = scenario::DEFAULT)]
    pub scenario: String,
    /// Set a key of the scenario, such as target.distance_m=0.3; may be repeated
    #[arg(short, long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Seed of all random streams, instead of the scenario's
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Simulation fidelity
    #[arg(long, value_enum, default_value_t = Fidelity::Cycle)]
    pub fidelity: Fidelity,
    /// Port on 127.0.0.1; 0 selects any free one
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub port: u16,
    #[command(flatten)]
    pub(crate) board: BoardOptions,
    /// Largest number of frames per second
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub rate: u32,
    /// Wait for Start to be pressed before the first frame
    #[arg(long)]
    pub stopped: bool,
    /// Print one JSON object instead of the URL
    #[arg(long)]
    pub json: bool,
    /// Do not print notes; the page shows them
    #[arg(long)]
    pub without_notes: bool,
    /// Print only errors and the URL
    #[arg(short, long)]
    pub quiet: bool,
}

/// A board in place of the simulated run.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct BoardOptions {
    /// Serial port of a board, whose frames are shown instead of simulated ones
    #[arg(long, value_name = "PORT")]
    pub board: Option<String>,
    /// Baud rate of the board
    #[arg(long, value_name = "N", default_value_t = BAUD, requires = "board")]
    #[arg(value_parser = clap::value_parser!(u32).range(i64::from(*BAUDS.start())..=i64::from(*BAUDS.end())))]
    pub baud: u32,
    /// Longest wait for the board's answer [s]
    #[arg(long, value_name = "S", default_value_t = 1, requires = "board")]
    #[arg(value_parser = clap::value_parser!(u64).range(1..=86_400))]
    pub timeout: u64,
    /// Accept a board that was built with other parameters than those of the scenario
    #[arg(long, requires = "board")]
    pub any_parameters: bool,
}

impl BoardOptions {
    /// Returns the options of a serial port.
    pub fn port(&self, port: &str) -> PortOptions {
        let patience = Duration::from_secs(self.timeout);
        PortOptions { baud: self.baud, patience, ..PortOptions::new(port) }
    }
}

/// Simulation fidelity of a run. It does not affect the frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Fidelity {
    /// Simulate every cycle, with the cause of every avalanche
    Cycle,
    /// Skip cycles between events; causes are expected values
    Shot,
}

impl Fidelity {
    /// Returns its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Fidelity::Cycle => "cycle",
            Fidelity::Shot => "shot",
        }
    }

    /// Returns the stepping to use while no signals are observed.
    pub fn stepping(self) -> Stepping {
        match self {
            Fidelity::Cycle => Stepping::SkipIdle,
            Fidelity::Shot => Stepping::LeapShots,
        }
    }
}

impl Options {
    /// Loads the scenario, with `further` overrides after those of the command line.
    ///
    /// # Errors
    /// If there is no such scenario, or a key or value is invalid.
    pub fn load(&self, further: &[String]) -> Result<Loaded> {
        let mut loaded = scenario::load(&self.scenario, &[&self.set, further].concat())?;
        loaded.scenario.seed = self.seed.unwrap_or(loaded.scenario.seed);
        Ok(loaded)
    }
}
