//! Registers and their bits by name.

use tofsim::error::{Input, Result, hint};
use tofsim::firmware::registers::map::{
    ALL, CONTROL, CONTROL_BITS, DENSITY_CLEAR, FAULT_BITS, FRAMES_PERMITTED, Register, RegisterBit,
};

use crate::board::Board;

/// Returns the register of that name.
///
/// # Errors
/// When there is none; `source` names who asks.
pub fn register(source: &str, name: &str) -> Result<&'static Register> {
    ALL.iter().find(|register| register.name == name).ok_or_else(|| {
        let (meant, known) = hint(name, ALL.iter().map(|register| register.name));
        Input::new(source, format!("unknown register{meant}; expected one of {known}"))
            .field(name)
            .into()
    })
}

/// What a host may set, by one name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// A bit or a field of `control`.
    Control(RegisterBit),
    /// A whole register.
    Register(Register),
}

impl Setting {
    /// Returns all that can be set: the fields of `control`, then the registers.
    pub fn all() -> impl Iterator<Item = Setting> {
        let registers = ALL.iter().filter(|register| register.writable);
        let bits = CONTROL_BITS.iter().copied().map(Setting::Control);
        bits.chain(registers.copied().map(Setting::Register))
    }

    /// Returns what has that name.
    ///
    /// # Errors
    /// When nothing has, or the host may not write it.
    pub fn named(source: &str, name: &str) -> Result<Setting> {
        if let Some(found) = Setting::all().find(|setting| setting.name() == name) {
            return Ok(found);
        }
        let (meant, known) = hint(name, Setting::all().map(Setting::name));
        let is_read_only = ALL.iter().any(|register| register.name == name);
        let fault = if is_read_only { "read-only register" } else { "unknown name" };
        let meant = if is_read_only { String::new() } else { meant };
        let expected = format!("{fault}{meant}; expected one of {known}");
        Err(Input::new(source, expected).field(name).into())
    }

    /// Returns its name.
    pub fn name(self) -> &'static str {
        match self {
            Setting::Control(bit) => bit.name,
            Setting::Register(register) => register.name,
        }
    }

    /// Returns its largest value.
    pub fn most(self) -> u32 {
        match self {
            Setting::Control(bit) => bit.of(u32::MAX),
            Setting::Register(_) => u32::MAX,
        }
    }

    /// Parses a value, decimal or hexadecimal after `0x`.
    ///
    /// # Errors
    /// When it is no number, or too large.
    pub fn value(self, source: &str, text: &str) -> Result<u32> {
        let parsed = match text.strip_prefix("0x") {
            Some(digits) => u32::from_str_radix(digits, 16),
            None => text.parse(),
        };
        parsed.ok().filter(|value| *value <= self.most()).ok_or_else(|| {
            let expected = format!("expected a whole number from 0 to {}", self.most());
            Input::new(source, expected).field(self.name()).value(text).into()
        })
    }
}

impl Board {
    /// Reads the value of a setting.
    ///
    /// # Errors
    /// When the board does not answer.
    pub fn setting(&mut self, setting: Setting) -> Result<u32> {
        match setting {
            Setting::Control(field) => Ok(field.of(self.read_word(&CONTROL)?)),
            Setting::Register(register) => self.read_word(&register),
        }
    }

    /// Changes a setting.
    ///
    /// # Errors
    /// When the board does not answer, or another value is read back.
    pub fn set(&mut self, setting: Setting, value: u32) -> Result<()> {
        match setting {
            Setting::Control(field) => self.set_control(field, value),
            // These change by themselves.
            Setting::Register(register @ (DENSITY_CLEAR | FRAMES_PERMITTED)) => {
                self.write(&register, value)
            }
            Setting::Register(register) => self.write_checked(&register, value),
        }
    }
}

/// Returns the names of the bits that are set in a word.
pub fn set_bits(bits: &'static [RegisterBit], word: u32) -> Vec<&'static str> {
    bits.iter().filter(|bit| bit.of(word) != 0).map(|bit| bit.name).collect()
}

/// Returns why the laser went off, in the words of the register map.
pub fn laser_faults(word: u32) -> Vec<&'static str> {
    FAULT_BITS.iter().filter(|bit| bit.of(word) != 0).map(|bit| bit.meaning).collect()
}
