//! Histograms of somebody's own sensor: any number of bins, and their times where the file has them.

use std::io::BufReader;
use std::path::Path;

use tofsim::error::open::open_file;
use tofsim::error::{Error, Input, Result, read_text};
use tofsim::files::csv::CsvInput;
use tofsim::files::npy;
use tofsim::firmware::histogram_builder::Params;
use tofsim::network::histogram_file;

use super::labelled::histograms;
use super::parquet_columns::ParquetColumns;
use super::parquet_input::is_parquet;

/// Columns of a CSV file with times in place of numbers of bins.
const TIMES: [&str; 2] = ["time_ns", "count"];
/// Part of a bin by which times may be off an even grid [1].
const UNEVEN: f64 = 0.01;
/// Most bins [bins].
pub const MOST_BINS: usize = 1 << 16;
/// Widest count [bits].
const COUNT_BITS: u32 = 24;

/// Bins of a file of histograms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// Their number.
    pub bins: usize,
    /// Begin of the first one and width of each, where the file has times [ps].
    pub times_ps: Option<[f64; 2]>,
}

impl Layout {
    /// The bins of a file, by its columns, rows or shape; `None` of a pipe, which can be read only once.
    ///
    /// # Errors
    /// When the file cannot be read, or has no bins.
    pub fn of(path: &Path) -> Result<Option<Self>> {
        if !path.metadata().map_err(Error::io(path, "read"))?.is_file() {
            return Ok(None);
        }
        let numbered = |bins| Layout { bins, times_ps: None };
        let layout = if is_parquet(path)? {
            let names = ParquetColumns::with(path, |columns| Ok(columns.names()))?;
            let is_bin = |name: &&String| {
                name.strip_prefix('b').is_some_and(|number| number.parse::<u32>().is_ok())
            };
            numbered(names.iter().filter(is_bin).count())
        } else if let Ok(array) = npy::open(BufReader::new(open_file(path)?)) {
            numbered(array.shape().last().map_or(0, |&bins| bins as usize))
        } else {
            let text = read_text(path)?;
            match times(&text) {
                true => Layout::of_times(path, &text)?,
                false => numbered(rows(&text).count().saturating_sub(1)),
            }
        };
        if !(1..=MOST_BINS).contains(&layout.bins) {
            let expected = format!("expected histograms of 1 to {MOST_BINS} bins");
            return Err(Input::new(path.display(), expected).value(layout.bins).into());
        }
        Ok(Some(layout))
    }

    /// Whether the file has times.
    pub fn has_times(self) -> bool {
        self.times_ps.is_some()
    }

    /// Of a CSV file with the begin of each bin.
    fn of_times(path: &Path, text: &str) -> Result<Self> {
        let source = path.display().to_string();
        let mut input = CsvInput::new(&source, text, &TIMES)?;
        let (mut times, mut faults) = (Vec::new(), Vec::new());
        while input.advance()? {
            let time = input.field(0).filter(|ns: &f64| (0.0..1e6).contains(ns));
            let expected = "expected the begin of a bin, 0 to 1e6 [ns]";
            times.push(time.ok_or_else(|| input.fault(0, expected))? * 1e3);
            faults.push(input.fault(0, ""));
        }
        let [Some(&first), Some(&last)] = [times.first(), times.last()] else {
            return Ok(Layout { bins: 0, times_ps: None });
        };
        let bin_ps = (last - first) / (times.len() as f64 - 1.0).max(1.0);
        let is_off = |k: usize, ps: f64| (ps - first - k as f64 * bin_ps).abs() > UNEVEN * bin_ps;
        if let Some(k) = (0..times.len()).find(|&k| is_off(k, times[k])) {
            let expected = format!(
                "expected {:.6}: bins of equal width, {:.6} ns as all of them have on average",
                1e-3 * (first + k as f64 * bin_ps),
                1e-3 * bin_ps
            );
            return Err(Input { expected, ..faults.swap_remove(k) }.into());
        }
        if times.len() < 2 || bin_ps <= 0.0 {
            return Err(Input::new(source, "expected rising times of two bins at least").into());
        }
        Ok(Layout { bins: times.len(), times_ps: Some([first, bin_ps]) })
    }

    /// The histograms of a file with such bins.
    ///
    /// # Errors
    /// When the file cannot be read, or a count is none.
    pub fn histograms(&self, path: &Path) -> Result<histogram_file::Histograms> {
        let size = Params { bins: self.bins, count_bits: COUNT_BITS };
        if self.times_ps.is_none() {
            return histograms(path, size);
        }
        let (source, text) = (path.display().to_string(), read_text(path)?);
        let mut input = CsvInput::new(&source, &text, &TIMES)?;
        let mut histogram = Vec::with_capacity(self.bins);
        while input.advance()? {
            let count = input.field(1).filter(|&count: &u32| u64::from(count) <= size.most_hits());
            let count = count.ok_or_else(|| input.fault(1, histogram_file::count_range(&size)))?;
            histogram.push(count);
        }
        Ok(Box::new(std::iter::once(Ok(histogram))))
    }
}

/// Lines of a CSV file with something on them, the header first.
fn rows(text: &str) -> impl Iterator<Item = &str> {
    text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'))
}

/// Whether a CSV file has times.
fn times(text: &str) -> bool {
    let header = rows(text).next().unwrap_or_default();
    header.split(',').map(str::trim).eq(TIMES)
}
