//! Histograms of somebody's own sensor: any number of bins, and their times where the file has them.

use std::fmt;
use std::io::BufReader;
use std::path::Path;

use tofsim::error::open::open_file;
use tofsim::error::{Error, Input, Result, read_text};
use tofsim::files::csv::{CsvInput, Header};
use tofsim::files::npy;
use tofsim::firmware::histogram_builder::Params;
use tofsim::kernel::Time;
use tofsim::network::Histogram;
use tofsim::network::histogram_csv::{HEADERS, check_bin, count};
use tofsim::network::histogram_file;
use tofsim::optics::Bins;

use super::labelled::histograms;
use super::parquet_columns::ParquetColumns;
use super::parquet_input::is_parquet;

/// Columns of a CSV file with the begin of each bin, and their unit [ps].
const TIMED: [(Header, f64); 2] = [(&["time_ns", "count"], 1e3), (&["time_ps", "count"], 1.0)];
/// Latest begin of a bin [ps].
const LATEST_PS: f64 = 1e9;
/// Part of a bin by which times may be off an even grid [1].
const UNEVEN: f64 = 0.01;
/// What times have to be.
const RISING: &str = "expected rising times of two bins at least";
/// Most bins [bins].
pub const MOST_BINS: usize = 1 << 16;
/// Widest count [bits].
const COUNT_BITS: u32 = 24;

/// Bins of a file of histograms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// Their number.
    pub bins: usize,
    /// Begin of the first one and width of each, where they are known [ps].
    pub times_ps: Option<[f64; 2]>,
    /// Width of each that is stated instead of that of the file [ps].
    stated_ps: Option<f64>,
}

impl Layout {
    /// The bins of a file, by its columns, rows or shape, and their width, if it is stated [ps]; `None` of a pipe, which
    /// can be read only once.
    ///
    /// # Errors
    /// When the file cannot be read, has no bins, or is a pipe with bins of a stated width.
    pub fn of(path: &Path, stated_ps: Option<f64>) -> Result<Option<Self>> {
        if !path.metadata().map_err(Error::io(path, "read"))?.is_file() {
            let Some(stated_ps) = stated_ps else { return Ok(None) };
            let expected = "expected a file, not a pipe, whose bins cannot be counted first";
            let fault = Input::new(path.display(), expected).field("--bin-ps");
            return Err(fault.value(stated_ps).into());
        }
        let (bins, own_ps) = if is_parquet(path)? {
            let names = ParquetColumns::with(path, |columns| Ok(columns.names()))?;
            let is_bin = |name: &&String| {
                name.strip_prefix('b').is_some_and(|number| number.parse::<u32>().is_ok())
            };
            (names.iter().filter(is_bin).count(), None)
        } else if let Ok(array) = npy::open(BufReader::new(open_file(path)?)) {
            (array.shape().last().map_or(0, |&bins| bins as usize), None)
        } else {
            let rows = CsvRows::read(path)?;
            (rows.histogram.len(), rows.even_ps()?)
        };
        if !(1..=MOST_BINS).contains(&bins) {
            let expected = format!("expected histograms of 1 to {MOST_BINS} bins");
            return Err(Input::new(path.display(), expected).value(bins).into());
        }
        let first_ps = own_ps.map_or(0.0, |[first_ps, _]| first_ps);
        let times_ps = stated_ps.map(|stated_ps| [first_ps, stated_ps]).or(own_ps);
        Ok(Some(Layout { bins, times_ps, stated_ps }))
    }

    /// Whether times of the bins are known.
    pub fn has_times(self) -> bool {
        self.times_ps.is_some()
    }

    /// Returns the bins in time, where it is known.
    pub fn even_bins(&self) -> Option<Bins> {
        let [first, bin] = self.times_ps?.map(Time::from_ps_f64);
        Some(Bins::even(first, bin, self.bins))
    }

    /// The histograms of a file with the bins of another file.
    ///
    /// # Errors
    /// When the file cannot be read, has other bins, or a count is none.
    pub fn histograms(&self, path: &Path, first: &Path) -> Result<histogram_file::Histograms> {
        if let Some(other) = Layout::of(path, self.stated_ps)?.filter(|other| other != self) {
            let expected = format!("expected {self} as in {}", first.display());
            return Err(Input::new(path.display(), expected).field("bins").value(other).into());
        }
        if !is_parquet(path)? && npy::open(BufReader::new(open_file(path)?)).is_err() {
            return Ok(Box::new(std::iter::once(CsvRows::read(path).map(|rows| rows.histogram))));
        }
        histograms(path, Params { bins: self.bins, count_bits: COUNT_BITS })
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.bins)?;
        self.times_ps.map_or(Ok(()), |[first_ps, width_ps]| {
            write!(f, " of {width_ps} ps from {first_ps} ps on")
        })
    }
}

/// Rows of a CSV file.
struct CsvRows {
    source: String,
    histogram: Histogram,
    /// Unit of the times, if the file has any [ps].
    unit_ps: Option<f64>,
    /// Begin of each bin [`unit_ps`].
    times: Vec<f64>,
    /// Error at each time, but for the text of what was expected.
    faults: Vec<Input>,
}

impl CsvRows {
    fn read(path: &Path) -> Result<Self> {
        let (source, text) = (path.display().to_string(), read_text(path)?);
        let headers: Vec<_> = HEADERS.into_iter().chain(TIMED.map(|(header, _)| header)).collect();
        let mut input = CsvInput::with_any(&source, &text, &headers)?;
        let timed = TIMED.iter().find(|(header, _)| *header == input.header());
        let unit_ps = timed.map(|(_, unit_ps)| *unit_ps);
        let size = Params { bins: MOST_BINS, count_bits: COUNT_BITS };
        let (mut histogram, mut times, mut faults) = (Histogram::new(), vec![], vec![]);
        while input.advance()? {
            if let Some(unit_ps) = unit_ps {
                let latest = LATEST_PS / unit_ps;
                let time = input.field(0).filter(|time| (0.0..latest).contains(time));
                let expected = || format!("expected the begin of a bin, 0 to {latest}");
                times.push(time.ok_or_else(|| input.fault(0, expected()))?);
                faults.push(input.fault(0, ""));
            }
            check_bin(&input, histogram.len())?;
            histogram.push(count(&input, &size)?);
        }
        drop(input);
        Ok(CsvRows { source, histogram, unit_ps, times, faults })
    }

    /// Returns begin of the first bin and width of each, if the file has times [ps].
    fn even_ps(mut self) -> Result<Option<[f64; 2]>> {
        let (times, bins) = (&self.times, self.histogram.len());
        let Some(unit_ps) = self.unit_ps else { return Ok(None) };
        let [first, .., last] = times[..] else {
            return Err(Input::new(self.source, RISING).into());
        };
        let width = (last - first) / (bins as f64 - 1.0);
        let place = |k: usize| first + k as f64 * width;
        if let Some(k) = (0..bins).find(|&k| (times[k] - place(k)).abs() > UNEVEN * width) {
            let expected = format!(
                "expected {:.6}: bins of equal width, {width:.6} as all of them have on average",
                place(k),
            );
            return Err(Input { expected, ..self.faults.swap_remove(k) }.into());
        }
        if width <= 0.0 {
            return Err(Input::new(self.source, RISING).into());
        }
        Ok(Some([first * unit_ps, width * unit_ps]))
    }
}
