//! Histograms in CSV: a row for each bin, with its number or without.

use crate::error::{Input, Result};
use crate::files::csv::{CsvInput, Header};
use crate::firmware::histogram_builder::Params;

use super::histogram::{Histogram, checked, count_range};

/// Columns of a row; the first header of their number applies to a file without one.
pub const HEADERS: [Header; 2] = [&["bin", "count"], &["count"]];

/// Parses a histogram. Errors name the text as `source`.
///
/// # Errors
/// If a row is invalid or missing.
pub fn parse(source: &str, text: &str, p: &Params) -> Result<Histogram> {
    let mut input = CsvInput::with_any(source, text, &HEADERS)?;
    let (bins, last) = (p.bins, p.last_bin());
    let mut histogram = Histogram::with_capacity(bins);
    while input.advance()? {
        if histogram.len() == bins {
            let expected = format!("a row after bin {last}, expected {bins} rows");
            return Err(input.fault(0, expected).into());
        }
        check_bin(&input, histogram.len())?;
        histogram.push(count(&input, p)?);
    }
    if histogram.len() < bins {
        let expected = format!("{} rows, expected {bins}", histogram.len());
        return Err(Input::new(source, expected).into());
    }
    checked(histogram, source, "total".to_owned(), p)
}

/// Checks the number of a row's bin, if the file has numbers.
///
/// # Errors
/// If it is another one than `bin`.
pub fn check_bin(input: &CsvInput, bin: usize) -> Result<()> {
    if input.header() != HEADERS[0] || input.whole(0) == Some(bin as u64) {
        return Ok(());
    }
    let mut expected = format!("expected {bin}: the numbers of all bins from 0 on, in order");
    if !input.has_header() {
        expected += "; times need the header `time_ns,count` or `time_ps,count`";
    }
    Err(input.fault(0, expected).into())
}

/// Reads the count of a row, which is in its last column.
///
/// # Errors
/// If it is none, or larger than a word of the histogram.
pub fn count(input: &CsvInput, p: &Params) -> Result<u32> {
    let column = input.header().len() - 1;
    let count = input.whole(column).filter(|&count| count <= p.most_hits());
    let count = count.and_then(|count| u32::try_from(count).ok());
    count.ok_or_else(|| input.fault(column, count_range(p)).into())
}
