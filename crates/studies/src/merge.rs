//! Merging of the tables of a sweep's shards.

use std::path::{Path, PathBuf};

use tofsim::error::{Error, Input, Result};
use tofsim::files::csv_output::CsvOutput;

use crate::shard::Shard;
use crate::sweep::{ABOUT, SHARD, identity};
use crate::table::parquet_file;
use crate::table::reader::TableReader;

/// The tables of all shards of a sweep.
pub struct Shards {
    tables: Vec<(PathBuf, TableReader)>,
    /// Identity of the sweep, as JSON.
    pub about: String,
}

/// Returns the shards' files in the given folders, and the files that are given directly.
///
/// # Errors
/// If a folder cannot be read, or contains no shard.
pub fn files(given: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for path in given {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let mut found = Vec::new();
        for entry in std::fs::read_dir(path).map_err(Error::io(path, "read"))? {
            let entry = entry.map_err(Error::io(path, "read"))?.path();
            let name = entry.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            if name.starts_with("shard-") && name.ends_with(".parquet") {
                found.push(entry);
            }
        }
        if found.is_empty() {
            let expected = "expected shards of a sweep, such as shard-3-of-7.parquet";
            return Err(Input::new(path.display(), expected).into());
        }
        files.extend(found);
    }
    files.sort();
    files.dedup();
    Ok(files)
}

impl Shards {
    /// Opens the tables, and checks that they are complete and belong together.
    ///
    /// # Errors
    /// If one is damaged, missing, duplicate, or from another sweep.
    pub fn open(files: &[PathBuf]) -> Result<Self> {
        let mut tables: Vec<Option<(PathBuf, TableReader)>> = Vec::new();
        let mut first: Option<(PathBuf, String, u64)> = None;
        for path in files {
            let table = TableReader::open(path)?;
            let value = |key: &str| table.metadata.get(key).cloned();
            let (Some(about), Some(shard)) = (value(ABOUT), value(SHARD)) else {
                let expected =
                    "it is no shard of a sweep, expected what `tofsim sweep --shard` writes";
                return Err(Input::new(path.display(), expected).into());
            };
            let shard: Shard = shard.parse().map_err(|expected| {
                Input::new(path.display(), expected).field(SHARD).value(&shard)
            })?;
            let (other, expected_about, count) =
                first.get_or_insert_with(|| (path.clone(), about.clone(), shard.count));
            if identity(&about) != identity(expected_about) {
                let expected = format!(
                    "it is a shard of another sweep than {}: plan, seed, settings or version differ",
                    other.display()
                );
                return Err(Input::new(path.display(), expected).into());
            }
            if shard.count != *count {
                let expected = format!("expected a shard of {count}, as {} is", other.display());
                return Err(Input::new(path.display(), expected).value(shard).into());
            }
            tables.resize_with(*count as usize, || None);
            let place = &mut tables[shard.index as usize - 1];
            if let Some((other, _)) = place {
                let expected = format!("the same shard is in {} too", other.display());
                return Err(Input::new(path.display(), expected).value(shard).into());
            }
            *place = Some((path.clone(), table));
        }
        let missing: Vec<_> =
            (1..).zip(&tables).filter(|(_, table)| table.is_none()).map(|(k, _)| k).collect();
        if let Some(first) = missing.first() {
            let most = tables.len();
            let others = match missing.len() {
                1 => String::new(),
                count => format!(" and {} more", count - 1),
            };
            let expected = format!("shard {first}/{most}{others} missing, expected all {most}");
            return Err(Input::new("shards", expected).into());
        }
        let tables: Vec<_> = tables.into_iter().flatten().collect();
        // The words of the first shard's command.
        let about = tables.first().and_then(|(_, table)| table.metadata.get(ABOUT)).cloned();
        let expected = || Input::new("shards", "expected the shards of a sweep");
        let about = about.ok_or_else(expected)?;
        Ok(Shards { tables, about })
    }

    /// Writes all rows, in order, as the table of the whole sweep; `comment` is the first line of its CSV file.
    ///
    /// # Errors
    /// If a table is damaged or lacks rows, or the files cannot be written.
    pub fn write(mut self, folder: &Path, comment: &str) -> Result<Vec<PathBuf>> {
        let fields = self.tables[0].1.fields.clone();
        let path = folder.join("sweep.parquet");
        let csv = path.with_extension("csv");
        let count: u64 = self.tables.iter().map(|(_, table)| table.count).sum();
        let mut table = parquet_file::create(&path, &fields, vec![(ABOUT, self.about.clone())])?;
        let names = fields.iter().map(|field| field.name.as_str());
        let mut text = CsvOutput::create(&csv, comment, names)?;
        let shards = self.tables.len() as u64;
        for point in 0..count {
            let (from, shard) = &mut self.tables[(point % shards) as usize];
            let row = shard.next_row()?.filter(|row| row.point == point);
            let row = row.ok_or_else(|| {
                let expected = format!("expected the row of point {point}: it is not whole");
                Input::new(from.display(), expected)
            })?;
            text.record(row.texts())?;
            table.write(std::slice::from_ref(&row))?;
        }
        table.finish()?.commit()?;
        text.finish()?;
        Ok(vec![path, csv])
    }
}
