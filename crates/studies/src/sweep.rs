//! Works out the points of a plan on all cores, and writes their table.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use tofsim::error::{Error, Result};
use tofsim::note::Note;

use crate::header::header;
use crate::journal::{Entry, Journal};
use crate::plan::Plan;
use crate::point::work;
use crate::shard::Shard;
use crate::table::csv_file::CsvFile;
use crate::table::reader::TableReader;
use crate::table::{Row, parquet_file};

/// Key of what a table is about in its metadata, as JSON.
pub const ABOUT: &str = "tofsim.sweep";
/// Key of which shard it is.
pub const SHARD: &str = "tofsim.shard";

/// Of what a table is about, which sweep it is: all but the command, which names the same plan in many ways.
pub fn identity(about: &str) -> String {
    match serde_json::from_str::<serde_json::Map<_, _>>(about) {
        Ok(mut all) => {
            all.remove("command");
            serde_json::Value::Object(all).to_string()
        }
        Err(_) => about.to_owned(),
    }
}

/// A sweep into a folder.
pub struct Sweep<'a> {
    /// What is worked out.
    pub plan: &'a Plan,
    /// Which part of it.
    pub shard: Shard,
    /// What the table is about, as JSON: the same for all shards of a sweep.
    pub about: String,
    /// The first line of the CSV file.
    pub comment: String,
}

/// A sweep under way.
pub struct Begun {
    /// Takes finished points.
    pub journal: Journal,
    /// Of each point of the shard whether it is in the journal from before.
    pub is_there: Vec<bool>,
    /// How many are.
    pub resumed: u64,
}

/// Works out some points of a plan, in that order, on all threads of the current pool.
///
/// # Errors
/// When a point is refused, or it is stopped.
pub fn work_out(plan: &Plan, points: &[u64], stop: Option<&AtomicBool>) -> Result<Vec<Entry>> {
    let of_point = |point: &u64| {
        if stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
            return Err(Error::Interrupted);
        }
        let worked = work(plan, *point, stop)?;
        Ok(Entry { cells: worked.row.cells, notes: worked.notes })
    };
    points.par_iter().map(of_point).collect()
}

/// What a sweep comes to.
#[derive(Debug, Default)]
pub struct Finished {
    /// The files.
    pub files: Vec<PathBuf>,
    /// The rows of a table that is not large.
    pub rows: Vec<Row>,
    /// What values lie outside of, with the first point's words, and at how many points.
    pub notes: Vec<(Note, u64)>,
    /// Points that were there already.
    pub resumed: u64,
}

/// Rows that are kept in memory to be shown.
pub const SHOWN: usize = 10_000;

/// Told how many more points are done.
pub type Done<'a> = &'a (dyn Fn(u64) + Sync);

impl Sweep<'_> {
    /// The table of the shard in a folder.
    pub fn table(&self, folder: &Path) -> PathBuf {
        folder.join(format!("{}.parquet", self.shard.stem()))
    }

    /// Whether a folder has both tables of this very sweep: it may have been killed between the two.
    pub fn is_done(&self, folder: &Path) -> bool {
        let path = self.table(folder);
        let is_own = |table: TableReader| {
            table.metadata.get(ABOUT).is_some_and(|found| identity(found) == identity(&self.about))
        };
        path.with_extension("csv").is_file() && TableReader::open(&path).is_ok_and(is_own)
    }

    /// Works out what is not in the folder's journal, on all threads of the current pool, and writes the table.
    ///
    /// # Errors
    /// When a point is refused, a file cannot be written, or it is stopped: finished points stay in the journal.
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

    /// Begins a journal in the folder, or goes on with the one that is there, for who works points out elsewhere.
    ///
    /// # Errors
    /// When it is another sweep's, another process writes to it, or it cannot be written.
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

    /// Writes the table of a journal that has all points, and removes that.
    ///
    /// # Errors
    /// When a file cannot be read or written.
    pub fn finish(&self, folder: &Path, begun: Begun) -> Result<Finished> {
        let finished = self.write(folder, &begun.journal)?;
        begun.journal.remove()?;
        Ok(Finished { resumed: begun.resumed, ..finished })
    }

    /// Works out all points, in memory.
    ///
    /// # Errors
    /// When a point is refused, or it is stopped.
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

    /// Works out the points that are not there, and hands each on when it is done.
    fn each(
        &self,
        is_there: &[bool],
        stop: Option<&AtomicBool>,
        take: impl Fn(Entry) -> Result<()> + Sync,
    ) -> Result<()> {
        let missing = is_there.par_iter().enumerate().filter(|(_, is_there)| !**is_there);
        missing.try_for_each(|(place, _)| {
            if stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
                return Err(Error::Interrupted);
            }
            let point = place as u64 * self.shard.count + self.shard.index - 1;
            let worked = work(self.plan, point, stop)?;
            take(Entry { cells: worked.row.cells, notes: worked.notes })
        })
    }

    /// Writes the table of a journal.
    fn write(&self, folder: &Path, journal: &Journal) -> Result<Finished> {
        let fields = header(self.plan);
        let is_whole = self.shard == Shard::WHOLE;
        let mut metadata = vec![(ABOUT, self.about.clone())];
        if !is_whole {
            metadata.push((SHARD, self.shard.to_string()));
        }
        let path = self.table(folder);
        let mut table = parquet_file::create(&path, &fields, metadata)?;
        let csv = path.with_extension("csv");
        let mut text =
            is_whole.then(|| CsvFile::create(&csv, &self.comment, &fields)).transpose()?;
        let mut finished = Finished::default();
        journal.in_order(|entry| {
            finished.add_notes(&entry);
            let Some(row) = entry.into_row() else { return Ok(()) };
            text.as_mut().map_or(Ok(()), |text| text.write(&row))?;
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
