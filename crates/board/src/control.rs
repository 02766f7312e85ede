//! Control signals, and the laser.

use tofsim::error::{Input, Result};
use tofsim::firmware::registers::map::{
    ARM, ARM_KEY, ARMED, CONTROL, DSP_EN, DSP_RST, FAULT_BITS, LASER_EN, LASER_FAULTS, LASER_FREQ,
    MODE, PINS_SELECTED, RegisterBit, STATUS, STATUS_BITS,
};
use tofsim::sim::setup::Setup;

use crate::board::Board;
use crate::names::{laser_faults, set_bits};

/// State of the laser: the words of `status` and `laser_faults`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LaserState {
    /// State of the firmware.
    pub status: u32,
    /// Why the laser went off since it was armed.
    pub faults: u32,
}

impl LaserState {
    /// Returns why the laser is off, for a message.
    fn words(self) -> String {
        let faults = set_bits(FAULT_BITS, self.faults);
        let status = set_bits(STATUS_BITS, self.status);
        let list = |words: Vec<&str>| match words.len() {
            0 => "none".to_owned(),
            _ => words.join(", "),
        };
        format!("laser_faults: {}; status: {}", list(faults), list(status))
    }

    /// Returns the faults in sentences.
    pub fn faults(self) -> Vec<&'static str> {
        laser_faults(self.faults)
    }

    /// Checks that the laser is armed; `port` is the board's.
    ///
    /// # Errors
    /// When it is not; the error says why.
    pub fn check_armed(self, port: &str) -> Result<()> {
        if ARMED.of(self.status) == 1 {
            return Ok(());
        }
        let expected = format!("the laser went off while frames were taken ({})", self.words());
        Err(Input::new(port, expected).field(ARM.name).value(0).into())
    }
}

impl Board {
    /// Reads why the laser is off, or that it is not.
    ///
    /// # Errors
    /// When the board does not answer.
    pub fn laser_state(&mut self) -> Result<LaserState> {
        let words = self.read_words(STATUS.name, STATUS.address, 2)?;
        debug_assert_eq!(LASER_FAULTS.address, STATUS.address + 1);
        Ok(LaserState { status: words[0], faults: words[1] })
    }

    /// Sets a field of `control`, and leaves the others as they are.
    ///
    /// # Errors
    /// When the board does not answer, or another value is read back.
    pub fn set_control(&mut self, field: RegisterBit, value: u32) -> Result<()> {
        let word = field.with(self.read_word(&CONTROL)?, value);
        self.write_checked(&CONTROL, word)
    }

    /// Sets the control signals of a setup, with frames held back and the laser enabled or not. [`Board::release`]
    /// lets frames begin.
    ///
    /// # Errors
    /// When the board does not answer, another value is read back, or the board's switch selects the control pins.
    pub fn prepare(&mut self, setup: &Setup, laser: bool) -> Result<()> {
        self.check_switch()?;
        let firmware = &setup.scenario.firmware;
        let fields = [
            (LASER_EN, u32::from(laser && firmware.laser_en)),
            (DSP_EN, 1),
            (DSP_RST, 1),
            (MODE, u64::from(firmware.mode) as u32),
            (LASER_FREQ, firmware.laser_freq as u32),
        ];
        (self.has_laser, self.is_in_use) = (laser, true);
        let word = fields.iter().fold(0, |word, (field, value)| field.with(word, *value));
        self.write_checked(&CONTROL, word)
    }

    /// Checks that the control signals come from the registers.
    pub(crate) fn check_switch(&mut self) -> Result<()> {
        let status = self.read_word(&STATUS)?;
        if PINS_SELECTED.of(status) == 0 {
            return Ok(());
        }
        let expected =
            "expected 0: the board's switch selects the control pins, set it to the registers";
        let field = format!("{}.{}", STATUS.name, PINS_SELECTED.name);
        Err(Input::new(self.port(), expected).field(field).value(1).into())
    }

    /// Lets frames begin.
    ///
    /// # Errors
    /// When the board does not answer, or another value is read back.
    pub fn release(&mut self) -> Result<()> {
        self.set_control(DSP_RST, 0)
    }

    /// Arms the laser.
    ///
    /// # Errors
    /// When it does not become armed; the error says what speaks against it.
    pub fn arm(&mut self) -> Result<()> {
        self.is_in_use = true;
        self.write(&ARM, ARM_KEY)?;
        if self.read_word(&ARM)? == 1 {
            return Ok(());
        }
        let state = self.laser_state()?;
        let expected = format!("expected 1 after arming ({})", state.words());
        Err(Input::new(self.port(), expected).field(ARM.name).value(0).into())
    }

    /// Checks that the laser is still armed.
    ///
    /// # Errors
    /// When it is not; the error says why.
    pub fn check_armed(&mut self) -> Result<LaserState> {
        let state = self.laser_state()?;
        state.check_armed(self.port())?;
        Ok(state)
    }

    /// Disarms and disables the laser, and holds frames back.
    ///
    /// # Errors
    /// When the words cannot be sent.
    pub fn laser_off(&mut self) -> Result<()> {
        self.write(&ARM, 0)?;
        self.write(&CONTROL, DSP_RST.with(0, 1))?;
        (self.has_laser, self.is_in_use) = (false, false);
        Ok(())
    }
}
