//! A board and its registers.

use std::time::{Duration, Instant};

use tofsim::error::{Error, Input, Result};
use tofsim::firmware::registers::map::{IDENTITY, MAP_VERSION, Register};
use tofsim::sim::setup::Setup;

use crate::identity::Identity;
use crate::port::PortOptions;
use crate::uartbone::{BusError, Link, UartBone};

/// A board with tofsim's firmware.
///
/// A board that has taken frames is left with the laser disarmed and disabled, and frames held back, when it is dropped.
/// If the board cannot be reached any more, the firmware switches the laser off after `host_timeout`.
pub struct Board {
    bus: UartBone<Box<dyn Link>>,
    options: PortOptions,
    identity: Identity,
    last_command: Instant,
    /// Whether frames are taken with the laser.
    pub(crate) has_laser: bool,
    /// Whether the board is to be left with the laser off and frames held back.
    pub(crate) is_in_use: bool,
}

impl Board {
    /// Opens a board over a port, and checks that it has this version of the firmware.
    ///
    /// # Errors
    /// When the port cannot be opened, or what answers is no such board.
    pub fn connect(options: &PortOptions) -> Result<Board> {
        let link = options.open()?;
        Board::over(Box::new(link), options)
    }

    /// Opens a board over a port, and checks that it has this version of the firmware and the parameters of a setup,
    /// unless `any_parameters` will do.
    ///
    /// # Errors
    /// When the port cannot be opened, or what answers is no such board.
    pub fn open(options: &PortOptions, setup: &Setup, any_parameters: bool) -> Result<Board> {
        let board = Board::connect(options)?;
        if !any_parameters {
            board.identity.check_parameters(&options.port, setup)?;
        }
        Ok(board)
    }

    /// Opens a board over any connection, which `options` name.
    ///
    /// # Errors
    /// When what answers is no board with this version of the firmware.
    pub fn over(link: Box<dyn Link>, options: &PortOptions) -> Result<Board> {
        let mut board = Board {
            bus: UartBone::new(link, options.patience),
            options: options.clone(),
            identity: Identity::of_words([0; 6]),
            last_command: Instant::now(),
            has_laser: false,
            is_in_use: false,
        };
        board.identity = board.identify()?;
        if !board.identity.is_ours() {
            // It may be the end of an answer to somebody else.
            board.bus.resynchronize().map_err(|error| board.fault(IDENTITY.name, error))?;
            board.identity = board.identify()?;
        }
        board.identity.check(board.port())?;
        Ok(board)
    }

    fn identify(&mut self) -> Result<Identity> {
        let words = self.read_words(IDENTITY.name, IDENTITY.address, 6)?;
        let mut own = [0; 6];
        own.copy_from_slice(&words);
        Ok(Identity::of_words(own))
    }

    /// Returns the name of its port.
    pub fn port(&self) -> &str {
        &self.options.port
    }

    /// Returns what the board says of itself.
    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    /// Returns the longest wait for an answer.
    pub fn patience(&self) -> Duration {
        self.options.patience
    }

    /// Reads a register.
    ///
    /// # Errors
    /// When the board does not answer.
    pub fn read(&mut self, register: &Register) -> Result<u64> {
        let words = self.read_words(register.name, register.address, register.words as usize)?;
        Ok(words.iter().fold(0, |value, &word| value << 32 | u64::from(word)))
    }

    /// Reads a register of one word.
    ///
    /// # Errors
    /// When the board does not answer.
    pub fn read_word(&mut self, register: &Register) -> Result<u32> {
        Ok(self.read_words(register.name, register.address, 1)?[0])
    }

    /// Writes a register of one word. The protocol has no answer to that.
    ///
    /// # Errors
    /// When the word cannot be sent.
    pub fn write(&mut self, register: &Register, value: u32) -> Result<()> {
        let sent = self.bus.write(register.address, &[value]);
        self.last_command = Instant::now();
        sent.map_err(|error| self.fault(register.name, error))
    }

    /// Writes a register of one word, and reads it back.
    ///
    /// # Errors
    /// When another value is read.
    pub fn write_checked(&mut self, register: &Register, value: u32) -> Result<()> {
        self.write(register, value)?;
        let found = self.read_word(register)?;
        if found == value {
            return Ok(());
        }
        let expected = format!("expected {value:#x}, which was written");
        let fault = Input::new(self.port(), expected).field(register.name);
        Err(fault.value(format!("{found:#x}")).into())
    }

    /// Reads consecutive words; `name` is what they are.
    ///
    /// # Errors
    /// When the board does not answer.
    pub fn read_words(&mut self, name: &str, address: u32, words: usize) -> Result<Vec<u32>> {
        let answer = self.bus.read(address, words);
        self.last_command = Instant::now();
        answer.map_err(|error| self.fault(name, error))
    }

    /// Tells the board that the host is still there, if it has been silent for a third of `host_timeout`. Any command
    /// does; a host that computes for long between commands calls this.
    ///
    /// # Errors
    /// When the board does not answer.
    pub fn keep_alive(&mut self) -> Result<()> {
        if self.last_command.elapsed() > self.identity.host_timeout() / 3 {
            self.read_word(&MAP_VERSION)?;
        }
        Ok(())
    }

    /// Returns the error that a command failed.
    fn fault(&self, name: &str, error: BusError) -> Error {
        let PortOptions { port, baud, patience } = &self.options;
        let seconds = patience.as_secs_f64();
        let advice = format!("check power, cable and baud rate ({baud}), or increase --timeout");
        let fault = |expected: String| Input::new(port, expected).field(name);
        match error {
            BusError::Silent { received: 0, expected } => {
                fault(format!("no answer within {seconds} s, expected {expected} bytes: {advice}"))
            }
            BusError::Silent { received, expected } => {
                fault(format!("expected {expected} bytes within {seconds} s of each other: {advice}"))
                    .value(format!("{received} bytes"))
            }
            BusError::Stuck => fault(format!("nothing can be sent for {seconds} s: {advice}")),
            BusError::Lost(error) => fault(format!(
                "the connection is lost ({error}): is the cable plugged in? The firmware switches the laser off by itself"
            )),
        }
        .into()
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        if self.is_in_use {
            // If this does not arrive, the firmware does it by itself.
            let _ = self.laser_off();
        }
    }
}
