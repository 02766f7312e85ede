//! A dataset as NumPy arrays, row by row in three files: `histograms.npy` (n x bins `u16`, or `u32` where a word has
//! more than 16 bits), `truth.npy`
//! (n x 3 `f64`: distance [m], reflectance, irradiance [W/m^2/nm], then row and column of the pixel of an array, and a
//! column more for each other key of the grid) and `rows.npy` (n x 2 `u64`: row number and seed).

use std::io::{self, BufReader, Read, Write};
use std::path::Path;

use npyz::{DType, Deserialize, Order, TypeChar, WriteOptions, WriterBuilder};

use tofsim::error::open::open;
use tofsim::error::{Error, Input, Result};
use tofsim::files::npy::{self, NpyInput};
use tofsim::files::output::OutputFile;

use super::blocks::Sample;
use super::description::DatasetDescription;
use super::format::TRUTH_ARRAY;
use super::grid::Grid;

/// The files under construction; nothing is left of them unless they are put in place.
#[derive(Debug, Default)]
pub(super) struct NpyFiles {
    /// In order: histograms, what each row looks at, row numbers.
    pub files: Vec<OutputFile>,
    /// Bytes of a count.
    count_bytes: usize,
}

/// Begins the files of a dataset of a grid.
pub(super) fn create(
    folder: &Path,
    description: &DatasetDescription,
    grid: &Grid,
) -> Result<NpyFiles> {
    let (rows, count_bytes) = (description.rows, description.count_bytes());
    let count = format!("<u{count_bytes}");
    let create = |(name, kind, width)| {
        let mut file = OutputFile::create(&folder.join(name))?;
        array_header(&mut file, kind, &[rows, width as u64]).map_err(|error| file.fault(error))?;
        Ok(file)
    };
    // Name, type in NumPy's words and elements of a row of each file.
    let files = [
        ("histograms.npy", count.as_str(), description.settings.tdc.bins as usize),
        (TRUTH_ARRAY, "<f8", grid.columns().len()),
        ("rows.npy", "<u8", 2),
    ];
    let files = files.into_iter().map(create).collect::<Result<_>>()?;
    Ok(NpyFiles { files, count_bytes })
}

/// Adds rows of a grid.
pub(super) fn write(files: &mut NpyFiles, samples: &[Sample], grid: &Grid) -> Result<()> {
    for sample in samples {
        let bytes = |count: &u32| count.to_le_bytes().into_iter().take(files.count_bytes);
        let counts: Vec<u8> = sample.histogram.iter().flat_map(bytes).collect();
        let truth = grid.values(&sample.scene).into_iter();
        let truth: Vec<u8> = truth.flat_map(f64::to_le_bytes).collect();
        let row = [sample.row, sample.seed].map(u64::to_le_bytes).concat();
        for (file, bytes) in files.files.iter_mut().zip([counts, truth, row]) {
            file.write_all(&bytes).map_err(|error| file.fault(error))?;
        }
    }
    Ok(())
}

/// Writes the header of an array of elements of a type in NumPy's words.
///
/// # Errors
/// When it cannot be written.
pub fn array_header(file: impl Write, kind: &str, shape: &[u64]) -> io::Result<()> {
    let kind = kind.parse().map_err(io::Error::other)?;
    let options = WriteOptions::new_header_only().dtype(DType::new_scalar(kind));
    options.shape(shape).writer(file).write_header_only().map(drop)
}

/// The floats of an array of one or two dimensions, and how many there are in a row.
pub(super) fn numbers(path: &Path) -> Result<(usize, Vec<f64>)> {
    let fault = |expected: String| Error::from(Input::new(path.display(), expected));
    let file = npy::open(BufReader::new(open(path)?));
    let file = file.map_err(|error| fault(format!("unreadable .npy: {error}")))?;
    let width = match *file.shape() {
        [_] => 1,
        [_, width] if (1..=64).contains(&width) => width as usize,
        _ => {
            return Err(fault(
                "expected an array (n) or (n, k), distances in metres first".to_owned(),
            ));
        }
    };
    if file.order() == Order::Fortran && width > 1 {
        return Err(fault("expected rows together (numpy.ascontiguousarray)".to_owned()));
    }
    let size = match file.dtype() {
        DType::Plain(plain) if plain.type_char() == TypeChar::Float => plain.size_field(),
        _ => 0,
    };
    let all = match size {
        8 => floats::<f64>(file),
        4 => floats::<f32>(file),
        _ => return Err(fault("expected floats of 4 or 8 bytes".to_owned())),
    };
    Ok((width, all.map_err(|error| fault(format!("unreadable .npy: {error}")))?))
}

/// The floats after a header, one by one: it may promise more than there is.
fn floats<T: Deserialize + Into<f64>>(file: NpyInput<impl Read>) -> io::Result<Vec<f64>> {
    let values = file.data::<T>().map_err(io::Error::other)?;
    values.map(|value| Ok(value?.into())).collect()
}
