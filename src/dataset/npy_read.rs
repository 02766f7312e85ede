//! A dataset from NumPy's arrays.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use regex::bytes::Regex;

use crate::error::{Error, Input, Result};
use crate::histogram_file;

use super::npy::{NAMES, TYPES, WIDTHS};
use super::read::check_truth;
use super::{Sample, Scene};

/// The header of a plain array: type, order and shape.
static HEADER: LazyLock<Option<Regex>> = LazyLock::new(|| {
    let text =
        r"^\{'descr': '([^']*)', 'fortran_order': (True|False), 'shape': \(([\d, ]*)\), *\}\s*$";
    Regex::new(text).ok()
});

/// Reads the three files of a folder.
pub(super) fn read(folder: &Path) -> Result<Vec<Sample>> {
    let [histograms, truth, rows] = NAMES.map(|name| folder.join(name));
    let (mut truth, mut rows) = (Array::open(truth, 1)?, Array::open(rows, 2)?);
    let mut samples = Vec::new();
    for histogram in histogram_file::open(&histograms)? {
        let histogram = histogram?;
        let number = samples.len();
        let (Some(values), Some([row, seed])) = (truth.next::<3>()?, rows.next::<2>()?) else {
            let short = if truth.left == 0 { &truth } else { &rows };
            return Err(short.fault(format!("ends here, {} goes on", NAMES[0]), number));
        };
        let [distance_m, reflectance, irradiance_w_m2_nm] = values.map(f64::from_bits);
        let scene = Scene { distance_m, reflectance, irradiance_w_m2_nm };
        check_truth(&scene).map_err(|(field, value, expected)| {
            let field = format!("row {number}, {field}");
            Input::new(truth.path.display(), expected).field(field).value(value)
        })?;
        samples.push(Sample { seed, row, scene, histogram });
    }
    for array in [truth, rows] {
        if array.left > 0 {
            let what = format!("goes on for {} rows, {} does not", array.left, NAMES[0]);
            return Err(array.fault(what, samples.len()));
        }
    }
    Ok(samples)
}

/// An array of words of 8 bytes.
struct Array {
    path: PathBuf,
    reader: BufReader<File>,
    /// Rows not read.
    left: u64,
}

impl Array {
    /// Opens file `k` of a dataset.
    fn open(path: PathBuf, k: usize) -> Result<Self> {
        let file = File::open(&path).map_err(Error::io(&path, "read"))?;
        let mut array = Array { path, reader: BufReader::new(file), left: 0 };
        let header = array.header()?;
        let fields = LazyLock::force(&HEADER).as_ref().and_then(|regex| regex.captures(&header));
        let Some(fields) = fields else {
            let expected = "expected the header of an .npy file with a plain array";
            return Err(Input::new(array.path.display(), expected).into());
        };
        let field = |k: usize| String::from_utf8_lossy(&fields[k]).into_owned();
        let fault = |field: &str, value: String, expected: String| {
            Err(Input::new(array.path.display(), expected).field(field).value(value).into())
        };
        if field(1) != TYPES[k] {
            return fault("dtype", field(1), format!("expected {}", TYPES[k]));
        }
        let lengths = field(3);
        let lengths = lengths.split(',').map(str::trim).filter(|length| !length.is_empty());
        let shape: Vec<Option<u64>> = lengths.map(|length| length.parse().ok()).collect();
        match shape[..] {
            [Some(rows), Some(width)] if width == WIDTHS[k] as u64 => array.left = rows,
            _ => {
                let expected = format!("expected (n, {})", WIDTHS[k]);
                return fault(
                    "shape",
                    format!("({})", field(3).trim_matches([',', ' '])),
                    expected,
                );
            }
        }
        if field(2) == "True" && array.left > 1 {
            let expected = "expected False: rows stored together (numpy.ascontiguousarray)";
            return fault("fortran_order", field(2), expected.to_owned());
        }
        Ok(array)
    }

    /// The text of the header, of versions 1 to 3.
    fn header(&mut self) -> Result<Vec<u8>> {
        let mut text = vec![];
        let mut take = |count: u64| {
            text.clear();
            let read = (&mut self.reader).take(count).read_to_end(&mut text);
            read.map_err(Error::io(&self.path, "read")).map(|_| text.clone())
        };
        let begin = take(8)?;
        let length = match begin.as_slice() {
            [0x93, b'N', b'U', b'M', b'P', b'Y', 1, _] => take(2)?,
            [0x93, b'N', b'U', b'M', b'P', b'Y', 2 | 3, _] => take(4)?,
            _ => return Ok(begin),
        };
        let length = length.iter().rev().fold(0, |length, &byte| length << 8 | u64::from(byte));
        take(length)
    }

    /// The next row, if there is one.
    fn next<const N: usize>(&mut self) -> Result<Option<[u64; N]>> {
        if self.left == 0 {
            return Ok(None);
        }
        let mut row = [0; N];
        for value in &mut row {
            let mut bytes = [0; 8];
            self.reader.read_exact(&mut bytes).map_err(|error| match error.kind() {
                ErrorKind::UnexpectedEof => {
                    let expected = format!("the file ends {} rows before its array", self.left);
                    Input::new(self.path.display(), expected).into()
                }
                _ => Error::io(&self.path, "read")(error),
            })?;
            *value = u64::from_le_bytes(bytes);
        }
        self.left -= 1;
        Ok(Some(row))
    }

    /// That the files do not have equally many rows.
    fn fault(&self, what: String, row: usize) -> Error {
        let expected = format!("{what}: expected as many rows in both");
        Input::new(self.path.display(), expected).field(format!("row {row}")).into()
    }
}
