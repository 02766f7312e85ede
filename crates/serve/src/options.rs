//! Command-line options.

use std::time::Duration;

use tofsim::error::{Input, Result};
use tofsim::scenario::{self, Loaded};
use tofsim::sim::Stepping;
use tofsim::sim::image::ImageFidelity;
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
    /// Simulation fidelity [default: cycle, and histogram for an array]
    #[arg(long, value_enum)]
    pub fidelity: Option<Fidelity>,
    /// Port on 127.0.0.1; 0 selects any free one
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub port: u16,
    #[command(flatten)]
    pub(crate) board: BoardOptions,
    /// Largest number of frames, or of images, per second
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

/// Simulation fidelity. Frames of cycle and shot are identical.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Fidelity {
    /// Simulate every cycle, with the cause of every avalanche
    Cycle,
    /// Skip cycles between events; causes are expected values
    Shot,
    /// Draw each frame's histogram; for arrays only
    Histogram,
}

impl Fidelity {
    /// Returns its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Fidelity::Cycle => "cycle",
            Fidelity::Shot => "shot",
            Fidelity::Histogram => "histogram",
        }
    }

    /// Returns the stepping to use while no signals are observed.
    pub fn stepping(self) -> Stepping {
        match self {
            Fidelity::Cycle | Fidelity::Histogram => Stepping::SkipIdle,
            Fidelity::Shot => Stepping::LeapShots,
        }
    }

    /// Returns how images are simulated.
    pub fn of_images(self) -> ImageFidelity {
        match self {
            Fidelity::Cycle | Fidelity::Shot => ImageFidelity::Shots(self.stepping()),
            Fidelity::Histogram => ImageFidelity::Histograms,
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

    /// Loads the scenario again, with `further` overrides.
    ///
    /// # Errors
    /// If it is not `base` any more, or a key or value is invalid.
    pub fn reload(&self, base: &Loaded, further: &[String]) -> Result<Loaded> {
        if self.load(&[])? != *base {
            let expected = "the file has changed since the start: start again to have it as it is";
            return Err(Input::new("scenario", expected).value(&self.scenario).into());
        }
        self.load(further)
    }

    /// Returns whether the page shows the images of an array.
    pub fn shows_images(&self, loaded: &Loaded) -> bool {
        self.board.board.is_none() && loaded.scenario.array.count() > 1
    }

    /// Returns the simulation fidelity of a scenario: the given one, or the default.
    ///
    /// # Errors
    /// If it does not apply.
    pub fn fidelity(&self, loaded: &Loaded) -> Result<Fidelity> {
        match (self.fidelity, self.shows_images(loaded)) {
            (Some(Fidelity::Histogram), false) => {
                let expected = "expected cycle or shot for a single pixel: a drawn histogram has no inputs to control";
                Err(Input::new("--fidelity", expected).value("histogram").into())
            }
            (Some(given), _) => Ok(given),
            (None, true) => Ok(Fidelity::Histogram),
            (None, false) => Ok(Fidelity::Cycle),
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[test]
    fn the_default_fidelity_is_live_for_a_pixel_and_for_an_array() {
        let fidelity = |words: &[&str]| {
            let options = Options::parse_from([&["tofsim-serve"], words].concat());
            options.fidelity(&options.load(&[]).unwrap()).map_err(|fault| fault.to_string())
        };
        assert_eq!(fidelity(&[]), Ok(Fidelity::Cycle));
        assert_eq!(fidelity(&["array"]), Ok(Fidelity::Histogram));
        assert_eq!(fidelity(&["array", "--fidelity", "shot"]), Ok(Fidelity::Shot));
        let fault = fidelity(&["--fidelity", "histogram"]).unwrap_err();
        assert!(fault.starts_with("--fidelity: histogram: expected cycle or shot"), "{fault}");
    }
}
