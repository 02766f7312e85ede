//! Inference of a column's radix, for files that do not state it.
//!
//! Hexadecimal values always have all digits of their width and decimal values have no leading zeros, so that one
//! radix remains for most columns. Octal is considered only on request: no such file is known.

use tofsim::error::{Input, Result};

use super::super::capture::Radix;
use super::digits;
use super::opened::Column;
use super::table::Row;

/// Radices that are tried, in order of preference if all give the same values.
const TRIED: [Radix; 5] = [Radix::Hex, Radix::Unsigned, Radix::Signed, Radix::Binary, Radix::Octal];

/// Possible radices of a column.
#[derive(Clone)]
pub(super) struct Guess {
    /// Remaining radices of [`TRIED`].
    left: Vec<Radix>,
    /// Whether binary numbers may still have all digits, and no leading zeros.
    padded: bool,
    bare: bool,
    /// Whether there was a cell.
    pub(super) seen: bool,
    /// First cell whose value depends on the radix.
    telling: Option<Input>,
}

impl Guess {
    pub(super) fn new(hint: Option<Radix>) -> Self {
        let octal = hint == Some(Radix::Octal);
        let left = TRIED.into_iter().filter(|&radix| octal || radix != Radix::Octal).collect();
        Guess { left, padded: true, bare: true, seen: false, telling: None }
    }

    /// Evaluates a cell of the column.
    pub(super) fn take(&mut self, row: &Row, index: usize, column: &Column) -> Result<()> {
        let before = self.left.clone();
        if self.look(&row.field(index), column.width) {
            self.telling = Some(row.fault(index, "").field(column.head()));
        }
        if self.left.is_empty() {
            let expected = if self.seen {
                self.left = before;
                format!("expected {} of {} bits, as above", self.names(), column.width)
            } else {
                format!("expected a number of {} bits", column.width)
            };
            return Err(row.fault(index, expected).field(column.head()).into());
        }
        self.seen = true;
        Ok(())
    }

    fn names(&self) -> String {
        let names: Vec<_> = self.left.iter().map(Radix::to_string).collect();
        names.join(" or ")
    }

    /// Excludes radices that do not fit a cell; returns true for the first cell whose value depends on the radix.
    fn look(&mut self, cell: &[u8], width: u32) -> bool {
        if digits::is_unknown(cell) {
            return false;
        }
        let zeros = cell.iter().take_while(|&&digit| digit == b'0').count();
        let bare = zeros == 0 || cell == b"0";
        self.padded &= cell.len() == width as usize;
        self.bare &= bare;
        let binary = self.padded || self.bare;
        self.left.retain(|&radix| {
            let spelled = match radix {
                Radix::Hex => cell.len() == width.div_ceil(4) as usize,
                Radix::Unsigned => bare,
                Radix::Signed => bare && !cell.starts_with(b"-0"),
                Radix::Octal => cell.len() == width.div_ceil(3) as usize,
                Radix::Binary => binary,
            };
            spelled && digits::read(cell, radix, width).is_ok()
        });
        self.telling.is_none() && cell.len() - zeros > 1
    }

    /// Decides on the radix of the column.
    pub(super) fn decide(&self, hint: Option<Radix>) -> Result<Radix> {
        if let Some(hint) = hint.filter(|hint| self.left.contains(hint)) {
            return Ok(hint);
        }
        // Signed and unsigned are the same bits wherever both are possible.
        let decimal = |radix| matches!(radix, Radix::Unsigned | Radix::Signed);
        let mut different = self.left.clone();
        different.dedup_by(|radix, before| decimal(*radix) && decimal(*before));
        match &self.telling {
            Some(cell) if different.len() > 1 => {
                let names = self.names();
                let expected = format!("may be {names}; select one with --radix");
                Err(Input { expected, ..cell.clone() }.into())
            }
            _ => Ok(different.first().copied().unwrap_or(Radix::Hex)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guess(width: u32, cells: &[&str]) -> String {
        let mut guess = Guess::new(None);
        for cell in cells {
            if guess.look(cell.as_bytes(), width) {
                guess.telling = Some(Input::new("a.csv", "").value(cell));
            }
        }
        if guess.left.is_empty() {
            "none".to_owned()
        } else {
            match guess.decide(None) {
                Ok(radix) => radix.to_string(),
                Err(error) => error.to_string(),
            }
        }
    }

    #[test]
    fn cells_that_allow_one_radix_decide_it() {
        assert_eq!(guess(16, &["00ff", "1000"]), "HEX");
        assert_eq!(guess(16, &["0010", "1234"]), "HEX");
        assert_eq!(guess(16, &["-12", "7"]), "SIGNED");
        assert_eq!(guess(16, &["65535", "7"]), "UNSIGNED");
        assert_eq!(guess(8, &["00001010", "11110000"]), "BINARY");
        assert_eq!(guess(8, &["FF", "0A"]), "HEX");
        assert_eq!(guess(4, &["10", "15"]), "UNSIGNED");
        assert_eq!(guess(128, &["-170141183460469231731687303715884105728"]), "SIGNED");
    }

    #[test]
    fn cells_of_the_same_value_in_every_radix_need_no_decision() {
        assert_eq!(guess(1, &["0", "1"]), "HEX");
        assert_eq!(guess(4, &["7", "3"]), "HEX");
        assert_eq!(guess(16, &["5", "9"]), "UNSIGNED");
        assert_eq!(guess(16, &[]), "HEX");
        assert_eq!(guess(4, &["X", "7"]), "HEX");
    }

    #[test]
    fn cells_with_several_values_are_an_error_that_shows_one() {
        let error = guess(16, &["1010"]);
        let radices = "may be HEX or UNSIGNED or SIGNED or BINARY";
        assert_eq!(error, format!("a.csv: 1010: {radices}; select one with --radix"));
        assert!(guess(8, &["10", "99"]).contains("may be HEX or UNSIGNED or SIGNED;"));
        assert!(guess(4, &["1010", "0001"]) == "BINARY");
        assert!(guess(4, &["10", "11"]).contains("may be UNSIGNED or BINARY;"));
    }

    #[test]
    fn cells_that_allow_nothing_are_told() {
        assert_eq!(guess(8, &["0x1"]), "none");
        assert_eq!(guess(8, &["256"]), "none");
        assert_eq!(guess(8, &["0a", "-1"]), "none");
    }
}
