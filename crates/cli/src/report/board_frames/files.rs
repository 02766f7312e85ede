//! Files with the frames of a board.

use std::io::Write;
use std::path::{Path, PathBuf};

use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int32Type, Int64Type};

use tofsim::error::{Error, Result};
use tofsim::files::csv_output::CsvOutput;
use tofsim::files::output::{OutputFile, create_directory, write_file};
use tofsim::sim::frames::Frame;
use tofsim::sim::setup::Setup;
use tofsim_learn::dataset::npy::array_header;
use tofsim_learn::dataset::parquet_table::ParquetTable;

use crate::record::LazyRecord;
use crate::report::frame_log::FrameLog;
use crate::report::summary::Summary;
use crate::verbs::terminal::Console;

/// Names of the files, after the summary.
const SUMMARY: &str = "summary.json";
const CSV: &str = "frames.csv";
const PARQUET: &str = "frames.parquet";
const HISTOGRAMS: &str = "histograms.npy";
const DEPTHS: &str = "depths.npy";

/// Formats of the frames.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct Formats {
    /// Write frames.csv into the folder of -o: a row for each frame with depth and histogram
    #[arg(long, requires = "output")]
    csv: bool,
    /// Write histograms.npy and depths.npy (depth and sigma, in metres) into the folder of -o
    #[arg(long, requires = "output")]
    npy: bool,
    /// Write frames.parquet into the folder of -o, with the columns of frames.csv
    #[arg(long, requires = "output")]
    parquet: bool,
}

/// The files under construction.
pub struct FrameFiles<'a> {
    folder: Option<&'a Path>,
    csv: Option<CsvOutput>,
    parquet: Option<ParquetTable<Frame>>,
    /// Histograms, and depths with their sigma.
    npy: Option<[OutputFile; 2]>,
    written: Vec<PathBuf>,
}

impl<'a> FrameFiles<'a> {
    /// Begins the files of so many frames of a setup.
    pub fn new(
        folder: Option<&'a Path>,
        formats: Formats,
        record: &LazyRecord,
        (setup, frames): (&Setup, u32),
    ) -> Result<Self> {
        let mut files =
            FrameFiles { folder, csv: None, parquet: None, npy: None, written: Vec::new() };
        let Some(folder) = folder else { return Ok(files) };
        create_directory(folder)?;
        let bins = setup.params.histogram.bins;
        let mut place = |name: &str| {
            files.written.push(folder.join(name));
            folder.join(name)
        };
        place(SUMMARY);
        if formats.csv {
            let bins: Vec<_> = (0..bins).map(|bin| format!("b{bin}")).collect();
            let head = ["frame", "depth_m", "depth_raw", "sigma_m", "valid", "status", "hits"];
            let names = head.into_iter().chain(bins.iter().map(String::as_str));
            files.csv = Some(CsvOutput::create(&place(CSV), &record.comment_line(), names)?);
        }
        if formats.parquet {
            files.parquet = Some(parquet(&place(PARQUET), bins, record)?);
        }
        if formats.npy {
            let mut create = |name, kind, width| {
                let mut file = OutputFile::create(&place(name))?;
                array_header(&mut file, kind, &[frames.into(), width as u64])
                    .map_err(|error| file.fault(error))?;
                Ok::<_, Error>(file)
            };
            files.npy = Some([create(HISTOGRAMS, "<u4", bins)?, create(DEPTHS, "<f8", 2)?]);
        }
        Ok(files)
    }

    /// Adds a frame.
    pub fn write(&mut self, frame: &Frame) -> Result<()> {
        if let Some(csv) = &mut self.csv {
            csv.record(cells(frame))?;
        }
        if let Some(parquet) = &mut self.parquet {
            parquet.write(std::slice::from_ref(frame))?;
        }
        if let Some([histograms, depths]) = &mut self.npy {
            let counts: Vec<u8> = frame.histogram.iter().flat_map(|n| n.to_le_bytes()).collect();
            let sigma_m = frame.estimate().sigma_m.unwrap_or(f64::NAN);
            let depth = [frame.depth_m(), sigma_m].map(f64::to_le_bytes).concat();
            histograms.write_all(&counts).map_err(|error| histograms.fault(error))?;
            depths.write_all(&depth).map_err(|error| depths.fault(error))?;
        }
        Ok(())
    }

    /// Puts the files in place, with the summary, which names them.
    pub fn finish(
        self,
        record: &LazyRecord,
        log: &mut FrameLog,
        summary: &Summary,
        console: &Console,
    ) -> Result<()> {
        let Some(folder) = self.folder else { return Ok(()) };
        self.csv.map_or(Ok(()), CsvOutput::finish)?;
        if let Some(parquet) = self.parquet {
            parquet.finish()?.commit()?;
        }
        self.npy.into_iter().flatten().try_for_each(OutputFile::commit)?;
        let mut summary = summary.clone();
        let name = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into());
        summary.list(self.written.iter().filter_map(name).collect());
        write_file(&folder.join(SUMMARY), |file| summary.write(record, log, file))?;
        self.written.iter().for_each(|path| console.wrote(path));
        Ok(())
    }
}

/// Returns the row of a frame.
fn cells(frame: &Frame) -> impl Iterator<Item = String> {
    let estimate = frame.estimate();
    let head = [
        frame.index.to_string(),
        frame.depth_m().to_string(),
        frame.depth().to_bits().to_string(),
        estimate.sigma_m.map_or(String::new(), |sigma_m| sigma_m.to_string()),
        u8::from(estimate.valid).to_string(),
        estimate.status.words().join(";"),
        frame.hits().to_string(),
    ];
    head.into_iter().chain(frame.histogram.iter().map(u32::to_string))
}

fn parquet(path: &Path, bins: usize, record: &LazyRecord) -> Result<ParquetTable<Frame>> {
    let columns: String =
        (0..bins).map(|bin| format!("required int32 b{bin} (INTEGER(32,false)); ")).collect();
    let schema = format!(
        "message frames {{ required int64 frame; required double depth_m; required int64 depth_raw; optional double \
         sigma_m; required boolean valid; required binary status (UTF8); required int64 hits; {columns} }}"
    );
    let file = OutputFile::create(path)?;
    let provenance = ("provenance", record.line());
    ParquetTable::create(file, &schema, [provenance], move |group, frames: &[Frame]| {
        let rows = || frames.iter();
        group.required::<Int64Type>(rows().map(|frame| frame.index as i64))?;
        group.required::<DoubleType>(rows().map(Frame::depth_m))?;
        group.required::<Int64Type>(rows().map(|frame| frame.depth().to_bits()))?;
        group.optional::<DoubleType>(rows().map(|frame| frame.estimate().sigma_m))?;
        group.required::<BoolType>(rows().map(|frame| frame.estimate().valid))?;
        let status = |frame: &Frame| frame.estimate().status.words().join(";");
        group.required::<ByteArrayType>(
            rows().map(|frame| ByteArray::from(status(frame).as_str())),
        )?;
        group.required::<Int64Type>(rows().map(|frame| frame.hits() as i64))?;
        (0..bins).try_for_each(|bin| {
            group.required::<Int32Type>(rows().map(|frame| frame.histogram[bin] as i32))
        })
    })
}
