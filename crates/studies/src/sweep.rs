//! Evaluation of a plan's points on all cores, and output of their table.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use tofsim::error::{Error, Result, poll_stop};
use tofsim::files::csv_output::CsvOutput;
use tofsim::note::Note;

use crate::header::header;
use crate::journal::{Entry, Journal};
use crate::plan::Plan;
use crate::point::work;
use crate::shard::Shard;
use crate::table::reader::TableReader;
use crate::table::{Row, parquet_file};

/// Metadata key of a table's provenance, as JSON.
pub const ABOUT: &str = "tofsim.sweep";
/// Metadata key of a table's shard.
pub const SHARD: &str = "tofsim.shard";

/// Returns the part of a table's provenance that identifies the sweep: everything but the command, which can name the
/// same plan in many ways.
pub fn identity(about: &str) -> String {
    match serde_json::from_str::<serde_json::Map<_, _>>(about) {
        Ok(mut all) => {
            all.remove("command");
            serde_json::Value::Object(all).to_string()
        }
        Err(_) => about.to_owned(),
    }
}

/// A sweep that writes to a folder.
pub struct Sweep<'a> {
    /// Plan to evaluate.
    pub plan: &'a Plan,
    /// Shard to evaluate.
    pub shard: Shard,
    /// Provenance of the table, as JSON, equal for all shards of a sweep.
    pub about: String,
    /// First line of the CSV file.
    pub comment: String,
}

/// A sweep that has begun.
pub struct Begun {
    /// Journal to which finished points are added.
    pub journal: Journal,
    /// Whether each point of the shard was already in the journal.
    pub is_there: Vec<bool>,
    /// Number of these points.
    pub resumed: u64,
}

/// Evaluates some points of a plan, in order, on all threads of the current pool.
///
/// # Errors
/// If a point is refused, or the sweep is stopped.
pub fn work_out(plan: &Plan, points: &[u64], stop: Option<&AtomicBool>) -> Result<Vec<Entry>> {
    points.par_iter().map(|point| entry(plan, *point, stop)).collect()
}

/// Evaluates one point, unless it is stopped.
fn entry(plan: &Plan, point: u64, stop: Option<&AtomicBool>) -> Result<Entry> {
    poll_stop(stop)?;
    let worked = work(plan, point, stop)?;
    Ok(Entry { cells: worked.row.cells, notes: worked.notes })
}

/// Result of a sweep.
#[derive(Debug, Default)]
pub struct Finished {
    /// Paths of the output files.
    pub files: Vec<PathBuf>,
    /// Rows of the table, unless it is large.
    pub rows: Vec<Row>,
    /// Notes with the text of the first point, and the number of points of each.
    pub notes: Vec<(Note, u64)>,
    /// Number of points that were already finished.
    pub resumed: u64,
}

/// Largest number of rows that are kept in memory for display.
pub const SHOWN: usize = 10_000;

/// Callback that receives the number of newly finished points.
pub type Done<'a> = &'a (dyn Fn(u64) + Sync);

impl Sweep<'_> {
    /// Returns the path of the shard's table in a folder.
    pub fn table(&self, folder: &Path) -> PathBuf {
        folder.join(format!("{}.parquet", self.shard.stem()))
    }

    /// Returns whether a folder contains both tables of this sweep; a killed sweep may have written only one.
    pub fn is_done(&self, folder: &Path) -> bool {
        let path = self.table(folder);
        let is_own = |table: TableReader| {
            table.metadata.get(ABOUT).is_some_and(|found| identity(found) == identity(&self.about))
        };
        path.with_extension("csv").is_file() && TableReader::open(&path).is_ok_and(is_own)
    }

    /// Evaluates the points that are not in the folder's journal, on all threads of the current pool, and writes the
    /// table.
    ///
    /// # Errors
    /// If a point is refused, a file cannot be written, or the sweep is stopped. Finished points stay in the journal.
    pub fn run(
        &self,
        folder: &Path,
        restart: bool,
        stop: Option<&AtomicBool>,
        done: Done,
    ) -> Result<Finished> {
        let begun = self.begin(folder, restart)?;
        done(begun.resumed);
        self.each(&begun.is_there, stop, |entry| {
            begun.journal.add(&entry)?;
            done(1);
            Ok(())
        })?;
        self.finish(folder, begun)
    }

    /// Opens or creates the journal in the folder, for points that are evaluated elsewhere.
    ///
    /// # Errors
    /// If it belongs to another sweep, is locked by another process, or cannot be written.
    pub fn begin(&self, folder: &Path, restart: bool) -> Result<Begun> {
        let path = folder.join(format!("{}.journal", self.shard.stem()));
        if restart && path.exists() {
            fs::remove_file(&path).map_err(Error::io(&path, "remove"))?;
        }
        let size = self.shard.size(self.plan.points.count());
        let mut is_there = vec![false; size as usize];
        let mut resumed = 0;
        let about = format!("{} {}", self.shard, identity(&self.about));
        let journal = Journal::open(&path, &about, |point| {
            let place = (point / self.shard.count) as usize;
            if let Some(is_there) = is_there.get_mut(place) {
                resumed += u64::from(!*is_there);
                *is_there = true;
            }
        })?;
        Ok(Begun { journal, is_there, resumed })
    }

    /// Writes the table of a complete journal, and deletes the journal.
    ///
    /// # Errors
    /// If a file cannot be read or written.
    pub fn finish(&self, folder: &Path, begun: Begun) -> Result<Finished> {
        let finished = self.write(folder, &begun.journal)?;
        begun.journal.remove()?;
        Ok(Finished { resumed: begun.resumed, ..finished })
    }

    /// Evaluates all points in memory.
    ///
    /// # Errors
    /// If a point is refused, or the sweep is stopped.
    pub fn in_memory(&self, stop: Option<&AtomicBool>, done: Done) -> Result<Finished> {
        let entries = Mutex::new(Vec::new());
        let size = self.shard.size(self.plan.points.count());
        self.each(&vec![false; size as usize], stop, |entry| {
            entries.lock().unwrap_or_else(PoisonError::into_inner).push(entry);
            done(1);
            Ok(())
        })?;
        let mut entries = entries.into_inner().unwrap_or_else(PoisonError::into_inner);
        entries.sort_by_key(Entry::point);
        let mut finished = Finished::default();
        for entry in entries {
            finished.add_notes(&entry);
            finished.rows.extend(entry.into_row());
        }
        Ok(finished)
    }

    /// Evaluates the unfinished points, and passes each result on.
    fn each(
        &self,
        is_there: &[bool],
        stop: Option<&AtomicBool>,
        take: impl Fn(Entry) -> Result<()> + Sync,
    ) -> Result<()> {
        let missing = is_there.par_iter().enumerate().filter(|(_, is_there)| !**is_there);
        missing.try_for_each(|(place, _)| {
            take(entry(self.plan, place as u64 * self.shard.count + self.shard.index - 1, stop)?)
        })
    }

    /// Writes the table of a journal.
    fn write(&self, folder: &Path, journal: &Journal) -> Result<Finished> {
        let fields = header(self.plan);
        let names = fields.iter().map(|field| field.name.as_str());
        let is_whole = self.shard == Shard::WHOLE;
        let mut metadata = vec![(ABOUT, self.about.clone())];
        if !is_whole {
            metadata.push((SHARD, self.shard.to_string()));
        }
        let path = self.table(folder);
        let mut table = parquet_file::create(&path, &fields, metadata)?;
        let csv = path.with_extension("csv");
        let mut text =
            is_whole.then(|| CsvOutput::create(&csv, &self.comment, names)).transpose()?;
        let mut finished = Finished::default();
        journal.in_order(|entry| {
            finished.add_notes(&entry);
            let Some(row) = entry.into_row() else { return Ok(()) };
            text.as_mut().map_or(Ok(()), |text| text.record(row.texts()))?;
            table.write(std::slice::from_ref(&row))?;
            if finished.rows.len() < SHOWN {
                finished.rows.push(row);
            }
            Ok(())
        })?;
        table.finish()?.commit()?;
        finished.files.push(path);
        if let Some(text) = text {
            text.finish()?;
            finished.files.push(csv);
        }
        Ok(finished)
    }
}

impl Finished {
    fn add_notes(&mut self, entry: &Entry) {
        for note in &entry.notes {
            let known = self
                .notes
                .iter_mut()
                .find(|(known, _)| known.code == note.code && known.key == note.key);
            match known {
                Some((_, count)) => *count += 1,
                None => self.notes.push((note.clone(), 1)),
            }
        }
    }
}
