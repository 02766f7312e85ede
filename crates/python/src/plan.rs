//! Plans of sweeps, whose points are worked out anywhere and come together in one table.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tempfile::TempDir;

use tofsim::error::{Input, read_text};
use tofsim::files::output::create_directory;
use tofsim::scenario::builtin::Source;
use tofsim::scenario::bundle::Bundle;
use tofsim_cli::record::Record;
use tofsim_cli::verbs::sweep::{about, draw, notes};
use tofsim_studies::header::header;
use tofsim_studies::journal::Entry;
use tofsim_studies::parts::Parts;
use tofsim_studies::plan::{Plan as Planned, builtin};
use tofsim_studies::sweep::{Begun, work_out};
use tofsim_studies::{Shard, Sweep};

use crate::errors::{Result, internal};
use crate::objects::assignments;
use crate::running::{self, Terms};

/// Which points of a scenario, and what is wanted of them: a plan that comes with the program, by name, or the path or
/// text of a plan file. It travels as text, with the scenario and the files that this names.
#[pyclass(module = "tofsim", frozen)]
pub struct Plan {
    plan: Planned,
    source: String,
    /// Overrides and seed, as they were given.
    given: (Vec<String>, Option<u64>),
    _home: Option<TempDir>,
}

impl Plan {
    /// Returns the provenance of the table.
    fn record(&self) -> Result<Record> {
        let (set, seed) = &self.given;
        let setup = self.plan.setup()?;
        let set = set.iter().map(|set| format!("--set={set}"));
        let seed = seed.map(|seed| format!("--seed={seed}"));
        let command = ["sweep".to_owned()].into_iter().chain(set).chain(seed);
        let command: Vec<_> = command.chain([self.source.clone()]).collect();
        Ok(Record::new(&setup, &command))
    }

    fn sweep(&self, record: &Record) -> Sweep<'_> {
        let about = about(&self.plan, record).to_string();
        Sweep { plan: &self.plan, shard: Shard::WHOLE, about, comment: record.comment_line() }
    }
}

#[pymethods]
impl Plan {
    #[new]
    #[pyo3(signature = (source, set = None, *, seed = None))]
    fn new(
        source: PathBuf,
        set: Option<&Bound<'_, pyo3::types::PyDict>>,
        seed: Option<u64>,
    ) -> Result<Self> {
        let source = source.display().to_string();
        let set = set.map_or(Ok(Vec::new()), assignments)?;
        let plan = match source.contains('\n') {
            true => Planned::parse("plan", "plan", &source, Path::new(""), &set, seed)?,
            false => Planned::load(&source, &set, seed)?,
        };
        let source = if source.contains('\n') { "plan.toml".to_owned() } else { source };
        Ok(Plan { plan, source, given: (set, seed), _home: None })
    }

    /// Built-in name, or the file's stem.
    #[getter]
    fn name(&self) -> &str {
        &self.plan.name
    }

    /// The plan as its file has it.
    #[getter]
    fn text(&self) -> &str {
        &self.plan.text
    }

    /// Names of the table's columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        let fields = header(&self.plan);
        fields.into_iter().map(|field| field.name).collect()
    }

    /// Number of points.
    fn __len__(&self) -> usize {
        self.plan.points.count() as usize
    }

    /// Evaluates some points; returns their rows.
    #[pyo3(signature = (points, *, threads = None))]
    fn work(
        slf: &Bound<'_, Self>,
        points: Vec<u64>,
        threads: Option<usize>,
    ) -> Result<Vec<String>> {
        let plan = slf.get();
        let count = plan.plan.points.count();
        if let Some(beyond) = points.iter().find(|point| **point >= count) {
            let expected = format!("expected points below {count}");
            return Err(Input::new("points", expected).value(beyond).into());
        }
        // The task may be left to itself, and the plan not.
        let own = plan.plan.clone();
        let terms = Terms { threads, progress: None };
        let entries =
            running::run(slf.py(), terms, move |watch| work_out(&own, &points, Some(&watch.stop)))?;
        let line = |entry: &Entry| serde_json::to_string(entry);
        let lines: std::result::Result<Vec<_>, _> = entries.iter().map(line).collect();
        lines.map_err(|fault| internal(&fault.to_string()))
    }

    fn __repr__(&self) -> String {
        format!("<tofsim.Plan {}: {} points>", self.plan.name, self.plan.points.count())
    }

    /// Travels as its text, with the scenario's file and the files that this names.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> Result<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, plan) = (slf.py(), slf.get());
        let base = plan.plan.base()?;
        let mut files = Bundle::of(&base.files, &base.scenario)?;
        let mut scenario = plan.plan.scenario.clone();
        if let Source::Folder(folder) = &base.files {
            for axis in plan.plan.points.axes.iter().filter(|axis| axis.is_text) {
                for value in axis.texts() {
                    files.add(folder, &value)?;
                }
            }
            let text = read_text(Path::new(&scenario))?;
            scenario = format!("{}.toml", base.name);
            files.files.insert(scenario.clone(), text.into_bytes());
        }
        let make = py.get_type::<Plan>().getattr("_travelled")?;
        let (set, seed) = plan.given.clone();
        let (text, set) = (&plan.plan.text, [set, files.set].concat());
        let parts = (&plan.plan.name, &plan.source, text, scenario, files.files, set, seed);
        Ok((make, parts.into_pyobject(py)?))
    }

    #[staticmethod]
    fn _travelled(
        name: &str,
        source: &str,
        text: &str,
        scenario: &str,
        files: BTreeMap<String, Vec<u8>>,
        set: Vec<String>,
        seed: Option<u64>,
    ) -> Result<Self> {
        let (home, folder) = Bundle { files, ..Bundle::default() }.unpack()?;
        let label = if builtin::plan(name).is_some_and(|(_, known)| known == text) {
            format!("plan {name}")
        } else {
            source.to_owned()
        };
        let plan = Planned::parse_for(name, &label, text, (scenario, &folder), &set, seed)?;
        let given = (set, seed);
        Ok(Plan { plan, source: source.to_owned(), given, _home: Some(home) })
    }
}

/// The table of a plan in a folder, to which points come in any order; those that were there stay.
#[pyclass(module = "tofsim", frozen)]
pub struct PlanTable {
    plan: Py<Plan>,
    folder: PathBuf,
    record: Record,
    parts: Parts,
    begun: Mutex<Option<Begun>>,
}

impl PlanTable {
    fn begun(&self) -> MutexGuard<'_, Option<Begun>> {
        self.begun.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl PlanTable {
    #[new]
    #[pyo3(signature = (plan, folder, *, restart = false))]
    fn new(plan: Bound<'_, Plan>, folder: PathBuf, restart: bool) -> Result<Self> {
        let record = plan.get().record()?;
        create_directory(&folder)?;
        let sweep = plan.get().sweep(&record);
        let is_done = !restart && sweep.is_done(&folder);
        let begun = if is_done { None } else { Some(sweep.begin(&folder, restart)?) };
        let parts = Parts::new(&folder, header(&plan.get().plan));
        if restart {
            parts.remove()?;
        }
        Ok(PlanTable { plan: plan.unbind(), folder, record, parts, begun: Mutex::new(begun) })
    }

    /// Points that are not there yet; none of a table that is whole.
    fn missing(&self) -> Vec<u64> {
        let begun = self.begun();
        let is_there = begun.as_ref().map_or(&[][..], |begun| &begun.is_there);
        (0..).zip(is_there).filter(|(_, is_there)| !**is_there).map(|(point, _)| point).collect()
    }

    /// Takes points that were worked out: into the journal, and as a Parquet file of their own until the table is
    /// whole.
    fn add(&self, lines: Vec<String>) -> Result<()> {
        let mut begun = self.begun();
        let Some(begun) = begun.as_mut() else { return Ok(()) };
        let mut rows = Vec::new();
        for line in lines {
            let entry: std::result::Result<Entry, _> = serde_json::from_str(&line);
            let entry = entry.map_err(|fault| internal(&fault.to_string()))?;
            let place = entry.point().and_then(|point| usize::try_from(point).ok());
            let place = place.and_then(|place| begun.is_there.get_mut(place));
            let Some(is_there) = place else {
                return Err(internal("a point that the plan does not have"));
            };
            // A block that was worked out twice is the same.
            if !std::mem::replace(is_there, true) {
                begun.journal.add(&entry)?;
                rows.extend(entry.into_row());
            }
        }
        Ok(self.parts.add(rows)?)
    }

    /// Writes the table, as Parquet and CSV, and its plan's picture; their paths, and what has to be said of them.
    fn finish(&self, py: Python<'_>) -> Result<(Vec<PathBuf>, Vec<String>)> {
        let plan = &self.plan.get().plan;
        let sweep = self.plan.get().sweep(&self.record);
        let parquet = sweep.table(&self.folder);
        let missing = self.missing().len();
        if missing > 0 {
            let expected = format!("expected all points, {missing} are missing");
            return Err(Input::new(parquet.display(), expected).into());
        }
        let Some(begun) = self.begun().take() else {
            let all = ["parquet", "csv", "svg"].map(|end| parquet.with_extension(end));
            return Ok((all.into_iter().filter(|path| path.is_file()).collect(), Vec::new()));
        };
        let finished = py.detach(|| sweep.finish(&self.folder, begun))?;
        self.parts.remove()?;
        let notes = notes(&finished, plan.points.count());
        let mut said: Vec<_> = notes.iter().map(ToString::to_string).collect();
        let mut files = finished.files;
        match draw(plan, &self.record, &finished.rows, &self.folder)? {
            Some(Ok(path)) => files.push(path),
            Some(Err(fault)) => said.push(fault),
            None => {}
        }
        Ok((files, said))
    }
}
