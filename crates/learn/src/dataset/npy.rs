//! A dataset as NumPy arrays, row by row in three files: `histograms.npy` (n x 256 `u16`), `truth.npy`
//! (n x 3 `f64`: distance [m], reflectance, irradiance [W/m^2/nm], and a column more for each other key of
//! the grid) and `rows.npy` (n x 2 `u64`: row number and seed).

use std::io::{self, Write};
use std::path::Path;

use npyz::{DType, WriteOptions, WriterBuilder};

use tofsim::error::Result;
use tofsim::files::output::OutputFile;
use tofsim::firmware::histogram_builder::BINS;

use super::blocks::Sample;
use super::grid::Grid;

/// Name, type in NumPy's words and elements of a row of each file.
const FILES: [(&str, &str, usize); 3] =
    [("histograms.npy", "<u2", BINS), (TRUTH, "<f8", 3), ("rows.npy", "<u8", 2)];

/// The file of what each row looks at.
const TRUTH: &str = "truth.npy";

/// The files under construction; nothing is left of them unless they are put in place.
pub(super) type NpyFiles = Vec<OutputFile>;

/// Begins the files of so many rows of a grid.
pub(super) fn create(folder: &Path, rows: u64, grid: &Grid) -> Result<NpyFiles> {
    let create = |(name, kind, width)| {
        let width = if name == TRUTH { width + grid.others.len() } else { width };
        let mut file = OutputFile::create(&folder.join(name))?;
        header(&mut file, kind, rows, width).map_err(|error| file.fault(error))?;
        Ok(file)
    };
    FILES.into_iter().map(create).collect()
}

/// Adds rows of a grid.
pub(super) fn write(files: &mut NpyFiles, samples: &[Sample], grid: &Grid) -> Result<()> {
    for sample in samples {
        let counts: Vec<u8> = sample.histogram.iter().flat_map(|n| n.to_le_bytes()).collect();
        let scene = &sample.scene;
        let truth = [scene.distance_m, scene.reflectance, scene.irradiance_w_m2_nm];
        let others = grid.setting(scene.setting).into_iter().map(|(_, value)| value);
        let truth: Vec<u8> = truth.into_iter().chain(others).flat_map(f64::to_le_bytes).collect();
        let row = [sample.row, sample.seed].map(u64::to_le_bytes).concat();
        for (file, bytes) in files.iter_mut().zip([counts, truth, row]) {
            file.write_all(&bytes).map_err(|error| file.fault(error))?;
        }
    }
    Ok(())
}

/// Writes the header of an array.
fn header(file: &mut OutputFile, kind: &str, rows: u64, width: usize) -> io::Result<()> {
    let kind = kind.parse().map_err(io::Error::other)?;
    let options = WriteOptions::new_header_only().dtype(DType::new_scalar(kind));
    options.shape(&[rows, width as u64]).writer(file).write_header_only().map(drop)
}
