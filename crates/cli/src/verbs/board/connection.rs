//! The connection to a board, and whether its laser is armed.

use std::time::Duration;

use tofsim::Note;
use tofsim::error::Result;
use tofsim::sim::setup::Setup;
use tofsim_board::port::{BAUD, BAUDS, TIMEOUTS_S};
use tofsim_board::{Board, PortOptions, dark_note};

/// Serial port of a board.
#[derive(Clone, Debug, clap::Args)]
pub struct PortArgs {
    /// Serial port of the board, e.g. /dev/ttyUSB0
    #[arg(long, value_name = "PORT")]
    port: String,
    /// Baud rate, the firmware's parameter Baud
    #[arg(long, value_name = "N", default_value_t = BAUD)]
    #[arg(value_parser = clap::value_parser!(u32).range(i64::from(*BAUDS.start())..=i64::from(*BAUDS.end())))]
    baud: u32,
    /// Longest wait for an answer, and for a frame to go on [s]; a simulated board needs more
    #[arg(long, value_name = "S", default_value = "1", value_parser = seconds)]
    timeout: Duration,
}

/// Parameters of the board.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct ParametersArgs {
    /// Accept a board that was built with other parameters than those of the scenario
    #[arg(long)]
    any_parameters: bool,
}

/// Laser of the board.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct LaserArgs {
    /// Arm the laser; without it, frames are dark
    #[arg(long)]
    pub laser: bool,
}

impl PortArgs {
    /// Opens a board with any parameters.
    pub fn connect(&self) -> Result<Board> {
        Board::connect(&self.options())
    }

    /// Opens a board with the parameters of a setup, or with any if that is asked for.
    pub fn open(&self, setup: &Setup, parameters: ParametersArgs) -> Result<Board> {
        Board::open(&self.options(), setup, parameters.any_parameters)
    }

    fn options(&self) -> PortOptions {
        PortOptions { port: self.port.clone(), baud: self.baud, patience: self.timeout }
    }
}

impl LaserArgs {
    /// Returns the note that frames are dark, if they are.
    pub fn note(self) -> Option<Note> {
        dark_note("--laser", self.laser)
    }
}

fn seconds(text: &str) -> std::result::Result<Duration, &'static str> {
    let seconds: Option<f64> = text.parse().ok().filter(|s| TIMEOUTS_S.contains(s));
    seconds.map(Duration::from_secs_f64).ok_or("expected seconds, 0.01 to 86400")
}
