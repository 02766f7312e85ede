//! A dataset as NumPy arrays, row by row in three files: `histograms.npy` (n x 256 `u16`), `truth.npy`
//! (n x 3 `f64`: distance [m], reflectance, irradiance [W/m^2/nm]) and `rows.npy` (n x 2 `u64`: row
//! number and seed).

use std::io::{self, Write};
use std::path::Path;

use npyz::{DType, WriteOptions, WriterBuilder};

use tofsim::error::{Error, Result};
use tofsim::files::output::OutputFile;
use tofsim::firmware::histogram_builder::BINS;

use super::blocks::Sample;

/// Names of the files in a dataset's folder.
pub const NAMES: [&str; 3] = ["histograms.npy", "truth.npy", "rows.npy"];
/// Types of their elements, in NumPy's words.
pub(super) const TYPES: [&str; 3] = ["<u2", "<f8", "<u8"];
/// Elements of a row.
const WIDTHS: [usize; 3] = [BINS, 3, 2];

/// The files under construction; nothing is left of them unless they are put in place.
pub struct NpyFiles {
    files: [OutputFile; 3],
}

impl NpyFiles {
    /// Begins the files of so many rows.
    pub fn create(folder: &Path, rows: u64) -> Result<Self> {
        let create = |k: usize| {
            let mut file = OutputFile::create(&folder.join(NAMES[k]))?;
            header(&mut file, TYPES[k], rows, WIDTHS[k]).map_err(|error| file.fault(error))?;
            Ok::<_, Error>(file)
        };
        Ok(NpyFiles { files: [create(0)?, create(1)?, create(2)?] })
    }

    /// Adds rows.
    pub fn write(&mut self, samples: &[Sample]) -> Result<()> {
        for sample in samples {
            let counts: Vec<u8> = sample.histogram.iter().flat_map(|n| n.to_le_bytes()).collect();
            let scene = &sample.scene;
            let truth = [scene.distance_m, scene.reflectance, scene.irradiance_w_m2_nm];
            let truth = truth.map(f64::to_le_bytes).concat();
            let row = [sample.row, sample.seed].map(u64::to_le_bytes).concat();
            for (file, bytes) in self.files.iter_mut().zip([counts, truth, row]) {
                file.write_all(&bytes).map_err(|error| file.fault(error))?;
            }
        }
        Ok(())
    }

    /// The files, complete, which are then to be put in place.
    pub fn finish(self) -> [OutputFile; 3] {
        self.files
    }
}

/// Writes the header of an array.
fn header(file: &mut OutputFile, kind: &str, rows: u64, width: usize) -> io::Result<()> {
    let kind = kind.parse().map_err(io::Error::other)?;
    let options = WriteOptions::new_header_only().dtype(DType::new_scalar(kind));
    options.shape(&[rows, width as u64]).writer(file).write_header_only().map(drop)
}
