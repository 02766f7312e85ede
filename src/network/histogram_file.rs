//! Histogram files: CSV `bin,count`, or NumPy's `.npy`, distinguished by content.
//!
//! Only one histogram of a file is in memory at a time.

use std::fmt::Display;
use std::io::{self, BufReader, Chain, Cursor, Read};
use std::path::Path;

use npyz::{DType, Deserialize, Order, TypeChar};

use crate::error::open::{self, Opened};
use crate::error::{Error, Input, Result, line_and_column};
use crate::files::npy::{self, NpyInput};
use crate::firmware::histogram_builder::Params;

use super::histogram::{Histogram, checked, count_range};
use super::histogram_csv;

/// Magic number of an `.npy` file.
const MAGIC: &[u8; 6] = b"\x93NUMPY";
/// Size limit of a CSV file [bytes].
const CSV: u64 = 1 << 20;
/// Reader of a file, including the bytes that were read to detect its format.
type Reader = BufReader<Chain<Cursor<Vec<u8>>, Opened>>;
/// A count, or the text of an invalid one.
type Count = std::result::Result<u32, String>;
/// Elements of an array.
type Elements = Box<dyn Iterator<Item = io::Result<Count>>>;

/// Iterator over the histograms of a file. It must not be used after an error.
pub type Histograms = Box<dyn Iterator<Item = Result<Histogram>>>;

/// Opens a file of histograms of the given size.
///
/// # Errors
/// If the file cannot be read, or has another size or type.
pub fn open(path: &Path, p: Params) -> Result<Histograms> {
    let mut file = open::open(path)?;
    let mut first = Vec::with_capacity(MAGIC.len());
    let begin = (&mut file).take(MAGIC.len() as u64).read_to_end(&mut first);
    begin.map_err(Error::io(path, "read"))?;
    let is_npy = first == MAGIC;
    let reader = BufReader::with_capacity(1 << 16, Cursor::new(first).chain(file));
    let name = path.display().to_string();
    if !is_npy {
        return Ok(Box::new(std::iter::once(csv(reader, &name, &p))));
    }
    let (mut elements, rows) = array(reader, &name, &p)?;
    Ok(Box::new((0..rows).map(move |number| row(&mut elements, number, rows, (&name, &p)))))
}

/// Reads a histogram from a CSV file.
fn csv(reader: Reader, path: &str, p: &Params) -> Result<Histogram> {
    let mut bytes = Vec::new();
    let read = reader.take(CSV + 1).read_to_end(&mut bytes);
    read.map_err(Error::io(Path::new(path), "read"))?;
    if bytes.len() as u64 > CSV {
        let expected =
            format!("more than 1 MiB, expected CSV with {} rows, or an .npy file", p.bins);
        return Err(Input::new(path, expected).into());
    }
    match std::str::from_utf8(&bytes) {
        Ok(text) => histogram_csv::parse(path, text, p),
        Err(error) => {
            let valid = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
            let (line, column) = line_and_column(&valid, valid.len());
            let expected = "expected CSV in UTF-8, or an .npy file";
            Err(Input::new(path, expected).at(line, column).into())
        }
    }
}

/// Reads the header of an `.npy` file, and returns its elements and number of histograms.
fn array(reader: Reader, path: &str, p: &Params) -> Result<(Elements, u64)> {
    let file = npy::open(reader).map_err(|error| unreadable(path, &error))?;
    let (shape, wanted) = (file.shape().to_vec(), p.bins as u64);
    let rows = match shape[..] {
        [bins] if bins == wanted => 1,
        [rows, bins] if bins == wanted && rows > 0 => rows,
        _ => {
            let shape = format!("{shape:?}").replace('[', "(").replace(']', ")");
            let expected = format!("expected ({wanted}) or (n, {wanted}), n at least 1");
            return Err(Input::new(path, expected).field("shape").value(shape).into());
        }
    };
    if file.order() == Order::Fortran && rows > 1 {
        let expected = "columns are stored together, expected rows (numpy.ascontiguousarray)";
        return Err(Input::new(path, expected).into());
    }
    let elements = elements(file).map_err(|dtype| {
        let expected = "expected integers or floats of 4 or 8 bytes";
        Input::new(path, expected).field("dtype").value(dtype)
    })?;
    Ok((elements, rows))
}

/// Returns the elements after the header.
///
/// # Errors
/// The element type, if it is not supported.
fn elements(file: NpyInput<Reader>) -> std::result::Result<Elements, String> {
    let dtype = file.dtype();
    let DType::Plain(plain) = &dtype else { return Err(dtype.descr()) };
    let real = |x: f64| match x as u32 {
        count if f64::from(count) == x => Ok(count),
        _ => Err(x.to_string()),
    };
    let found = match (plain.type_char(), plain.size_field()) {
        (TypeChar::Uint, 1) => whole::<u8>(file),
        (TypeChar::Uint, 2) => whole::<u16>(file),
        (TypeChar::Uint, 4) => whole::<u32>(file),
        (TypeChar::Uint, 8) => whole::<u64>(file),
        (TypeChar::Int, 1) => whole::<i8>(file),
        (TypeChar::Int, 2) => whole::<i16>(file),
        (TypeChar::Int, 4) => whole::<i32>(file),
        (TypeChar::Int, 8) => whole::<i64>(file),
        (TypeChar::Float, 4) => counts(file, move |x: f32| real(x.into())),
        (TypeChar::Float, 8) => counts(file, real),
        _ => None,
    };
    found.ok_or_else(|| dtype.descr())
}

/// Returns integer elements as counts.
fn whole<T>(file: NpyInput<Reader>) -> Option<Elements>
where
    T: Deserialize + TryInto<u32> + Display + Copy + 'static,
{
    counts(file, |x: T| x.try_into().map_err(|_| x.to_string()))
}

/// Returns elements of one type as counts; `None` if the file has another type.
fn counts<T: Deserialize + 'static>(
    file: NpyInput<Reader>,
    count: impl Fn(T) -> Count + 'static,
) -> Option<Elements> {
    Some(Box::new(file.data::<T>().ok()?.map(move |x| x.map(&count))))
}

fn unreadable(path: &str, error: &io::Error) -> Error {
    Input::new(path, format!("unreadable .npy: {error}")).into()
}

/// Reads the histogram of one row.
fn row(
    elements: &mut Elements,
    row: u64,
    rows: u64,
    (path, p): (&str, &Params),
) -> Result<Histogram> {
    let mut histogram = vec![0; p.bins];
    for (bin, count) in histogram.iter_mut().enumerate() {
        let field = || format!("histogram {row}, bin {bin}");
        *count = match elements.next() {
            Some(Ok(Ok(count))) if u64::from(count) <= p.most_hits() => count,
            Some(Ok(value)) => {
                let value = value.map_or_else(|text| text, |count| count.to_string());
                return Err(Input::new(path, count_range(p)).field(field()).value(value).into());
            }
            Some(Err(error)) if error.kind() == io::ErrorKind::InvalidData => {
                return Err(unreadable(path, &error));
            }
            Some(Err(error)) if error.kind() != io::ErrorKind::UnexpectedEof => {
                return Err(Error::io(Path::new(path), "read")(error));
            }
            _ => {
                let expected = format!("the file ends here, expected {rows} histograms");
                return Err(Input::new(path, expected).field(field()).into());
            }
        };
    }
    checked(histogram, path, format!("total of histogram {row}"), p)
}
