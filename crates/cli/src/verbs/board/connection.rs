//! The connection to a board, and frames with or without the laser.

use std::time::Duration;

use tofsim::error::{Input, Result};
use tofsim::sim::setup::Setup;
use tofsim::{Note, NoteCode};
use tofsim_board::port::BAUD;
use tofsim_board::{Board, PortOptions};

/// Serial port of a board.
#[derive(Clone, Debug, clap::Args)]
pub struct PortArgs {
    /// Serial port of the board, e.g. /dev/ttyUSB0
    #[arg(long, value_name = "PORT")]
    port: String,
    /// Baud rate, the firmware's parameter Baud
    #[arg(long, value_name = "N", default_value_t = BAUD)]
    #[arg(value_parser = clap::value_parser!(u32).range(300..=20_000_000))]
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
        let text = "the laser is not armed: frames are dark";
        (!self.laser).then(|| Note::new(NoteCode::NoLight, "--laser", false, "true", text))
    }

    /// Prepares frames of a setup, and returns the number before the first one.
    pub fn begin(self, board: &mut Board, setup: &Setup) -> Result<u32> {
        board.prepare(setup, self.laser)?;
        let before = board.begin_frames()?;
        if self.laser {
            board.arm()?;
        }
        board.release()?;
        Ok(before)
    }
}

/// Checks that the firmware alone can take the frames of a scenario.
pub fn check_frames(setup: &Setup) -> Result<()> {
    let firmware = &setup.scenario.firmware;
    let fault = |field: &str, value: String, expected: &str| {
        let fault = Input::new(format!("scenario {}", setup.name), expected);
        Err(fault.field(field).value(value).into())
    };
    if firmware.dark_frames {
        let expected = "expected false: a board does not alternate laser_en between its frames";
        return fault("firmware.dark_frames", true.to_string(), expected);
    }
    if !setup.scenario.control.is_empty() {
        let expected = "expected none: a board's control signals are constant during its frames";
        return fault("control", format!("{} changes", setup.scenario.control.len()), expected);
    }
    let held = [("dsp_en", firmware.dsp_en, true), ("dsp_rst", firmware.dsp_rst, false)];
    for (pin, value, needed) in held.into_iter().chain([("rst", firmware.rst, false)]) {
        if value != needed {
            let expected = format!("expected {needed}: no frame ends");
            return fault(&format!("firmware.{pin}"), value.to_string(), &expected);
        }
    }
    Ok(())
}

fn seconds(text: &str) -> std::result::Result<Duration, &'static str> {
    let seconds: Option<f64> = text.parse().ok().filter(|s| (0.01..=86_400.0).contains(s));
    seconds.map(Duration::from_secs_f64).ok_or("expected seconds, 0.01 to 86400")
}
