//! Fractions of the pulse energy that the cover window sends to the pixels, from a CSV file with columns
//! `row,column,fraction`.

use crate::error::Result;
use crate::files::csv::Header;

use super::builtin::Source;
use super::model::Scenario;
use super::pixel_values::{self, Values};

/// Columns of the file.
const HEADER: Header = &["row", "column", "fraction"];

/// Loads the fraction of every pixel, by row, then column, if the cover names a file; its path is relative to `base` [1].
///
/// # Errors
/// If the file cannot be read, lacks a pixel or has another array's, or if a fraction is not from 0 to 1.
pub fn load(scenario: &Scenario, base: &Source) -> Result<Vec<f64>> {
    let Some(name) = &scenario.cover.fraction_file else { return Ok(Vec::new()) };
    let (source, text) = base.read(name)?;
    let expected = "expected a fraction from 0 to 1 of the pulse energy".to_owned();
    let values = Values { header: HEADER, range: 0.0..=1.0, expected };
    pixel_values::parse(&source, &text, scenario.array.size(), &values)
}
