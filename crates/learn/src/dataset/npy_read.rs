//! A dataset from NumPy's arrays.

use std::fmt::Display;
use std::fs::File;
use std::io::{BufReader, ErrorKind};
use std::path::{Path, PathBuf};

use npyz::{Deserialize, NpyFile, NpyReader, Order};

use tofsim::error::{Error, Input, Result};
use tofsim::files::npy;
use tofsim::network::histogram_file;

use super::blocks::Sample;
use super::checks::check_truth;
use super::npy::{NAMES, TYPES};
use super::scene::Scene;

/// Reads the three files of a folder.
pub(super) fn read(folder: &Path) -> Result<Vec<Sample>> {
    let [histograms, truth, rows] = NAMES.map(|name| folder.join(name));
    let mut truth = Array::<f64, 3>::open(truth, 1)?;
    let mut rows = Array::<u64, 2>::open(rows, 2)?;
    let mut samples = Vec::new();
    for histogram in histogram_file::open(&histograms)? {
        let histogram = histogram?;
        let number = samples.len();
        let (Some(values), Some([row, seed])) = (truth.next()?, rows.next()?) else {
            let short = if truth.left == 0 { &truth.path } else { &rows.path };
            return Err(fault(short, &format!("ends here, {} goes on", NAMES[0]), number));
        };
        let [distance_m, reflectance, irradiance_w_m2_nm] = values;
        let scene = Scene { distance_m, reflectance, irradiance_w_m2_nm };
        check_truth(&scene).map_err(|(field, value, expected)| {
            let field = format!("row {number}, {field}");
            Input::new(truth.path.display(), expected).field(field).value(value)
        })?;
        samples.push(Sample { seed, row, scene, histogram });
    }
    for (path, left) in [(&truth.path, truth.left), (&rows.path, rows.left)] {
        if left > 0 {
            let what = format!("goes on for {left} rows, {} does not", NAMES[0]);
            return Err(fault(path, &what, samples.len()));
        }
    }
    Ok(samples)
}

/// An array of `N` numbers a row.
struct Array<T: Deserialize, const N: usize> {
    path: PathBuf,
    values: NpyReader<T, BufReader<File>>,
    /// Rows not read.
    left: u64,
}

impl<T: Deserialize + Copy + Default, const N: usize> Array<T, N> {
    /// Opens file `k` of a dataset.
    fn open(path: PathBuf, k: usize) -> Result<Self> {
        let mut reader = BufReader::new(File::open(&path).map_err(Error::io(&path, "read"))?);
        let header = npy::header(&mut reader).map_err(|error| {
            let expected =
                format!("expected the header of an .npy file with a plain array: {error}");
            Input::new(path.display(), expected)
        })?;
        let refusal = |field: &str, value: &dyn Display, expected: &str| -> Error {
            Input::new(path.display(), expected).field(field).value(value).into()
        };
        let descr = header.dtype().descr();
        let descr = descr.trim_matches('\'');
        if descr != TYPES[k] {
            return Err(refusal("dtype", &descr, &format!("expected {}", TYPES[k])));
        }
        let left = match *header.shape() {
            [rows, width] if width == N as u64 => rows,
            ref shape => {
                let lengths: Vec<_> = shape.iter().map(u64::to_string).collect();
                let shape = format!("({})", lengths.join(", "));
                return Err(refusal("shape", &shape, &format!("expected (n, {N})")));
            }
        };
        if header.order() == Order::Fortran && left > 1 {
            let expected = "expected False: rows stored together (numpy.ascontiguousarray)";
            return Err(refusal("fortran_order", &"True", expected));
        }
        let values = NpyFile::with_header(header, reader).data();
        let values = values.map_err(|error| Input::new(path.display(), error.to_string()))?;
        Ok(Array { path, values, left })
    }

    /// The next row, if there is one.
    fn next(&mut self) -> Result<Option<[T; N]>> {
        if self.left == 0 {
            return Ok(None);
        }
        let mut row = [T::default(); N];
        for value in &mut row {
            let next = self.values.next().unwrap_or_else(|| Err(ErrorKind::UnexpectedEof.into()));
            *value = next.map_err(|error| match error.kind() {
                ErrorKind::UnexpectedEof => {
                    let expected = format!("the file ends {} rows before its array", self.left);
                    Input::new(self.path.display(), expected).into()
                }
                _ => Error::io(&self.path, "read")(error),
            })?;
        }
        self.left -= 1;
        Ok(Some(row))
    }
}

/// That the files do not have equally many rows.
fn fault(path: &Path, what: &str, row: usize) -> Error {
    let expected = format!("{what}: expected as many rows in both");
    Input::new(path.display(), expected).field(format!("row {row}")).into()
}
