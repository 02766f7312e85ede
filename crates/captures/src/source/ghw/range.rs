//! Ranges in a GHW file.

use super::super::span::{Checked, Fault, Span};

/// Range of an array's index or of a scalar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Range {
    pub(super) left: i64,
    pub(super) right: i64,
    falls: bool,
}

impl Range {
    /// Parses a range. That of real numbers has no length.
    pub(super) fn parse(file: &mut Span) -> Checked<Range> {
        let head = file.byte()?;
        let (left, right) = match head & 0x7f {
            22 | 23 => (file.byte()?.into(), file.byte()?.into()),
            25 | 26 | 28 | 29 => (file.signed()?, file.signed()?),
            27 => {
                file.take(16)?;
                (1, 0)
            }
            kind => return Err(Fault::value("a range's kind", kind.into(), "is none of GHDL's")),
        };
        Ok(Range { left, right, falls: head & 0x80 != 0 })
    }

    /// Returns the number of values, 0 for a null range.
    pub(super) fn length(self) -> u64 {
        let (low, high) =
            if self.falls { (self.right, self.left) } else { (self.left, self.right) };
        u64::try_from(i128::from(high) - i128::from(low) + 1).unwrap_or(0)
    }

    /// Returns the values from left to right.
    pub(super) fn values(self) -> impl Iterator<Item = i64> {
        let (left, step) = (self.left, if self.falls { -1 } else { 1 });
        (0..self.length()).map(move |k| left.wrapping_add(step * k as i64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(bytes: &[u8]) -> Range {
        Range::parse(&mut Span::new(bytes, "range")).unwrap()
    }

    #[test]
    fn a_range_has_its_values_from_left_to_right() {
        let (falls, rises) = (range(&[0x99, 2, 0]), range(&[25, 0x7f, 1]));
        assert_eq!(falls.values().collect::<Vec<_>>(), [2, 1, 0]);
        assert_eq!(rises.values().collect::<Vec<_>>(), [-1, 0, 1]);
        assert_eq!((range(&[25, 1, 0]).length(), range(&[22, 0, 3]).length()), (0, 4));
    }
}
