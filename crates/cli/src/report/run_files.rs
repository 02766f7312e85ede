//! The files that a run leaves beside its waveform.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use serde_json::Value;

use tofsim::error::{Input, Result};
use tofsim::files::output::{write_bytes, write_file};
use tofsim::sim::setup::Setup;
use tofsim::sim::shot_recorder::Shot;
use tofsim_learn::dataset::shot_file::ShotFile;

use crate::record::LazyRecord;
use crate::verbs::terminal::Console;

use super::causes::{self, CAUSES, Causes};
use super::frame_log::FrameLog;
use super::pair_table;
use super::sheet::Digits::Shortest;
use super::sheet::Sheet;
use super::summary::Summary;

/// Files of the folder; the last one only where frames come in pairs.
const NAMES: [&str; 4] = ["summary.json", "histogram.csv", "histogram.svg", "difference.csv"];

/// Whether two paths lead to one place in one folder.
pub fn is_same(a: &Path, b: &Path) -> bool {
    let folder = |path: &Path| match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.canonicalize().ok(),
        _ => Path::new(".").canonicalize().ok(),
    };
    a.file_name() == b.file_name() && folder(a) == folder(b)
}

/// Checks that the file of an option is none of those in `folder`.
pub fn check_name(option: &str, file: Option<&Path>, folder: Option<&Path>) -> Result<()> {
    if let (Some(folder), Some(file)) = (folder, file)
        && NAMES.iter().any(|name| is_same(&folder.join(name), file))
    {
        let expected = "expected another name: the run writes a file of its own there";
        return Err(Input::new(option, expected).value(file.display()).into());
    }
    Ok(())
}

/// Files under construction, and what they are made from.
pub struct RunFiles<'a> {
    folder: Option<&'a Path>,
    events: Option<ShotFile>,
    causes: Causes,
    /// The frame that is shown: the first, or the first lit one of pairs.
    shown: u64,
    /// Rows for the scenario's TDC report.
    tdc: Vec<Shot>,
    wants_tdc: bool,
}

impl<'a> RunFiles<'a> {
    /// Begins the files: a row for each shot in `events`, the rest in `folder`.
    pub fn new(
        folder: Option<&'a Path>,
        events: Option<&Path>,
        record: &LazyRecord,
        setup: &Setup,
    ) -> Result<Self> {
        check_name("--events", events, folder)?;
        let create = |path| ShotFile::of_run(path, setup.has_pairs(), &record.line());
        let events = events.map(create).transpose()?;
        let (shown, wants_tdc) = (setup.frames_together() - 1, setup.scenario.report.tdc);
        let causes = std::array::from_fn(|_| vec![0; setup.params.histogram.bins]);
        Ok(RunFiles { folder, events, causes, shown, tdc: Vec::new(), wants_tdc })
    }

    /// Returns whether [`RunFiles::shot`] needs the shots.
    pub fn want_shots(&self) -> bool {
        self.folder.is_some() || self.events.is_some() || self.wants_tdc
    }

    /// Returns whether shots after the displayed frame are needed.
    pub fn want_all_shots(&self) -> bool {
        self.events.is_some() || self.wants_tdc
    }

    /// Rows for the scenario's TDC report.
    pub fn tdc(&self) -> &[Shot] {
        &self.tdc
    }

    /// Takes a shot.
    pub fn shot(&mut self, shot: &Shot) -> Result<()> {
        if shot.frame == self.shown {
            causes::count(&mut self.causes, shot);
        }
        if self.wants_tdc {
            self.tdc.push(*shot);
        }
        self.events.as_mut().map_or(Ok(()), |events| events.write([0, 0], shot))
    }

    /// Puts the files in place, beside those that are `written` already, and lists all of them in the
    /// summary. What an older summary lists and this one does not is named.
    pub fn finish(
        &mut self,
        record: &LazyRecord,
        setup: &Setup,
        log: &mut FrameLog,
        summary: &Summary,
        mut written: Vec<PathBuf>,
    ) -> Result<Written> {
        if let Some(events) = self.events.take() {
            written.push(events.finish()?);
        }
        let (Some(folder), Some(frame)) = (self.folder, log.rows.get(self.shown as usize).cloned())
        else {
            return Ok(Written { files: written, older: Vec::new() });
        };
        let names = &NAMES[..if log.pairs.is_some() { 4 } else { 3 }];
        written.extend(names.iter().map(|name| folder.join(name)));
        let name = |path: &PathBuf| {
            let elsewhere = || path.file_name().map(Path::new);
            let name = path.strip_prefix(folder).ok().or_else(elsewhere)?;
            Some(name.to_string_lossy().into_owned())
        };
        let names: Vec<String> = written.iter().filter_map(name).collect();
        let older = older_files(folder, &names);
        let mut summary = summary.clone();
        summary.list(names);
        if self.causes.iter().flatten().all(|&count| count == 0) {
            self.causes[CAUSES.len() - 1] = frame.histogram.clone();
        }
        let title = format!("{}, seed {}, {} shots", setup.name, setup.scenario.seed, frame.shots);
        let depth_m = match &log.pairs {
            None => Some(frame.depth_m()),
            Some(_) => log.readings[self.shown as usize].iter().find_map(|one| one.depth_m),
        };
        let svg =
            causes::svg(&title, &self.causes, &setup.scenario.tdc, setup.true_depth_m(), depth_m);
        write_file(&folder.join(NAMES[0]), |file| summary.write(record, log, file))?;
        let csv = |text: String| record.comment_line() + &text;
        write_bytes(&folder.join(NAMES[1]), csv(histogram_csv(&frame.histogram)))?;
        write_bytes(&folder.join(NAMES[2]), record.in_svg(&svg?))?;
        if log.pairs.is_some() {
            let difference = pair_table::csv(&log.rows[0], &log.rows[1]);
            write_bytes(&folder.join(NAMES[3]), csv(difference))?;
        }
        Ok(Written { files: written, older })
    }
}

/// The files of a run.
pub struct Written {
    /// Files that the run wrote.
    files: Vec<PathBuf>,
    /// Files of an older run beside them.
    older: Vec<PathBuf>,
}

impl Written {
    /// Prints which files were written, and which are of an older run.
    pub fn report(&self, console: &Console) {
        self.files.iter().for_each(|path| console.wrote(path));
        for path in &self.older {
            let path = path.display();
            console.note(format_args!("{path} is of an older run: summary.json does not list it"));
        }
    }
}

/// Files in a folder that its summary lists, but for those of some names.
fn older_files(folder: &Path, names: &[String]) -> Vec<PathBuf> {
    let summary = std::fs::read(folder.join(NAMES[0])).unwrap_or_default();
    let summary: Value = serde_json::from_slice(&summary).unwrap_or_default();
    let listed = summary["files"].as_array().into_iter().flatten().filter_map(Value::as_str);
    let is_plain = |name: &&str| Path::new(name).file_name() == Some(OsStr::new(name));
    let older = listed.filter(is_plain).filter(|name| names.iter().all(|own| own != name));
    older.map(|name| folder.join(name)).filter(|path| path.exists()).collect()
}

/// Returns a histogram as CSV, a row for each bin.
fn histogram_csv(histogram: &[u32]) -> String {
    let bins: Vec<_> = histogram.iter().enumerate().collect();
    Sheet::of(&bins)
        .column("bin", Shortest, |(bin, _)| *bin)
        .column("count", Shortest, |(_, count)| **count)
        .csv()
}
