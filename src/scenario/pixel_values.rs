//! A value for each pixel of an array, from a CSV file with columns `row`, `column` and the value's name.

use std::ops::RangeInclusive;

use crate::error::{Input, Result};
use crate::files::csv::{CsvInput, Header};

/// What a file has for each pixel.
pub struct Values {
    /// Columns of the file: `row`, `column`, and that of the values.
    pub header: Header,
    /// Values that are accepted.
    pub range: RangeInclusive<f64>,
    /// What is expected, in words.
    pub expected: String,
}

/// Parses the value of every pixel of an array with so many rows and columns, by row, then column.
///
/// # Errors
/// The line and column of a pixel that is not in the array or is there twice, or of a value that is not accepted, and
/// the first pixel without a value.
pub fn parse(
    source: &str,
    text: &str,
    [rows, columns]: [usize; 2],
    values: &Values,
) -> Result<Vec<f64>> {
    let mut input = CsvInput::new(source, text, values.header)?;
    let mut found = vec![None; rows * columns];
    while input.advance()? {
        let [row, place] = [input.place(0, rows)?, input.place(1, columns)?];
        let value = input.field::<f64>(2).filter(|value| values.range.contains(value));
        let value = value.ok_or_else(|| input.fault(2, &*values.expected))?;
        if found[row * columns + place].replace(value).is_some() {
            let expected = format!("expected each pixel once, row {row} has it already");
            return Err(input.fault(1, expected).into());
        }
    }
    let lacks = |place: usize| {
        let expected = format!(
            "expected a line for each of {rows} x {columns} pixels (array.rows, array.columns)"
        );
        let missing = format!("row {}, column {}", place / columns, place % columns);
        Input::new(source, expected).field("missing").value(missing)
    };
    let whole = found.iter().enumerate().map(|(place, value)| value.ok_or_else(|| lacks(place)));
    Ok(whole.collect::<std::result::Result<_, _>>()?)
}
