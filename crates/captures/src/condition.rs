//! Conditions over signals, for triggers and qualifiers: `state == 5 && (other rising || bus[7:4] != 0b1x0x)`.
//!
//! Names may contain dots, slashes, digits and brackets, or any characters in double quotes. A bare name is a one-bit
//! signal that must be 1. `!` applies to the comparison that follows it; `&&` (`and`) binds tighter than `||` (`or`).

mod bound;
mod literal;
mod parse;
mod token;
mod tree;

pub use bound::Bound;
pub use tree::{Level, Operand};

use tree::{Leaf, Node, Test};

use tofsim::error::{Error, Input, Result};

/// Widest signal of a condition [bits].
pub const WIDEST: u32 = 128;

/// A parsed condition.
#[derive(Clone, Debug)]
pub struct Condition {
    source: String,
    node: Node,
    leaves: Vec<Leaf>,
}

impl Condition {
    /// Parses a condition; errors name `source`, the option or key of the text.
    ///
    /// # Errors
    /// If the text is not a condition; with the column.
    pub fn parse(source: &str, text: &str) -> Result<Self> {
        let (node, leaves) = parse::parse(source, text)?;
        Ok(Condition { source: source.to_owned(), node, leaves })
    }

    /// Returns the names in the condition, without slices.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.leaves.iter().map(|leaf| slice(&leaf.name).map_or(&leaf.name[..], |(name, ..)| name))
    }

    /// Binds the names to signals. `find` is called with each name as written and, if that fails, without its slice.
    ///
    /// # Errors
    /// Those of `find`, with the column if they have no position; a slice outside of the signal, a value that does
    /// not fit, an edge of a multi-bit signal, or more than [`WIDEST`] bits.
    pub fn bind(&self, find: &mut dyn FnMut(&str) -> Result<Operand>) -> Result<Bound> {
        let watched = self.leaves.iter().map(|leaf| self.watch(leaf, find));
        Ok(Bound::new(self.node.clone(), watched.collect::<Result<_>>()?))
    }

    fn watch(
        &self,
        leaf: &Leaf,
        find: &mut dyn FnMut(&str) -> Result<Operand>,
    ) -> Result<bound::Watched> {
        let (place, low, width) = self.find(leaf, find)?;
        let fault = |expected: String| Err(self.fault(leaf.column, &leaf.name, expected));
        if width > WIDEST {
            return fault(format!("expected a signal of at most {WIDEST} bits, not {width}"));
        }
        if low + width > WIDEST {
            return fault(format!("expected bits of the lowest {WIDEST}"));
        }
        let signed = place.signed && width == place.width;
        match &leaf.test {
            Test::Compare(_, literal, column) => {
                let fits = literal.fits(width, signed);
                fits.map_err(|expected| self.fault(*column, &literal.text, expected))?;
            }
            Test::High | Test::Rising | Test::Falling if width != 1 => {
                return fault(format!("expected a signal of one bit, not {width}"));
            }
            _ => {}
        }
        Ok(bound::Watched::new(place.index, low, width, signed, &leaf.test))
    }

    /// Finds the bits of a test: the signal, the lowest bit, and the width.
    fn find(
        &self,
        leaf: &Leaf,
        find: &mut dyn FnMut(&str) -> Result<Operand>,
    ) -> Result<(Operand, u32, u32)> {
        let whole = match find(&leaf.name) {
            Ok(place) => return Ok((place, 0, place.width)),
            Err(error) => error,
        };
        let Some((name, high, low)) = slice(&leaf.name) else {
            return Err(self.placed(whole, leaf));
        };
        let place = match find(name) {
            Ok(place) => place,
            Err(part) => {
                let better = if leaf.name.contains(':') { part } else { whole };
                return Err(self.placed(better, leaf));
            }
        };
        if high < low || high >= place.width {
            let expected = match place.width {
                1 => format!("`{name}` has one bit, [0]"),
                width => format!("`{name}` has the bits [{}:0], the higher first", width - 1),
            };
            return Err(self.fault(leaf.column, &leaf.name, expected));
        }
        Ok((place, low, high - low + 1))
    }

    fn fault(&self, column: usize, value: &str, expected: String) -> Error {
        Input::new(&self.source, expected).at(1, column).value(value).into()
    }

    /// Adds the column of a name to an error of `find`.
    fn placed(&self, error: Error, leaf: &Leaf) -> Error {
        match error {
            Error::Input(input) if input.place.is_none() => {
                let source = self.source.clone();
                Input { source, place: Some((1, leaf.column)), ..*input }.into()
            }
            other => other,
        }
    }
}

/// Splits `name[7:4]` or `name[3]` into name, highest and lowest bit.
pub(crate) fn slice(text: &str) -> Option<(&str, u32, u32)> {
    let (name, range) = text.strip_suffix(']')?.rsplit_once('[')?;
    let (high, low) = range.split_once(':').unwrap_or((range, range));
    let bit = |digits: &str| {
        if digits.bytes().all(|byte| byte.is_ascii_digit()) { digits.parse().ok() } else { None }
    };
    Some((name, bit(high)?, bit(low)?))
}

#[cfg(test)]
mod tests;
