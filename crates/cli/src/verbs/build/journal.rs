//! Journal of a build's folder: `build.json`, with a checksum.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use tofsim::error::open::open_file;
use tofsim::error::{Error, Input, Result, read_text};
use tofsim::files::digest::digest;
use tofsim::files::output::write_bytes;
use tofsim_rtl::verify::process::Tool;

use super::step::Step;

/// Its file.
pub const FILE: &str = "build.json";
const SCHEMA: &str = "tofsim.build/1";

/// Steps that have been done.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Journal {
    schema: String,
    /// Digest of the steps; none if an older tofsim wrote the file.
    checksum: Option<String>,
    /// Steps by their names.
    pub steps: BTreeMap<String, StepRecord>,
}

/// Result of a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepRecord {
    /// Digest of all that decides what comes out; none of a step that could not be done.
    pub input: Option<String>,
    /// Its files, and a digest of each.
    pub outputs: BTreeMap<PathBuf, String>,
    /// Whether no fault was found.
    pub passed: bool,
    /// Summary in a line.
    pub summary: String,
    /// Results for the report.
    pub result: Value,
}

fn digest_of_file(path: &Path) -> Result<String> {
    let mut bytes = Vec::new();
    open_file(path)?.read_to_end(&mut bytes).map_err(Error::io(path, "read"))?;
    Ok(format!("{:016x}", digest(0, &bytes)))
}

fn checksum(steps: &BTreeMap<String, StepRecord>) -> Result<String> {
    let text = serde_json::to_string(steps).map_err(|error| Input::new(FILE, error))?;
    Ok(format!("{:016x}", digest(0, text.as_bytes())))
}

impl StepRecord {
    /// Records a step that has been done.
    ///
    /// # Errors
    /// When an output cannot be read.
    pub fn done(
        input: String,
        outputs: &[PathBuf],
        result: Value,
        passed: bool,
        summary: String,
    ) -> Result<Self> {
        let digests = outputs.iter().map(|path| Ok((path.clone(), digest_of_file(path)?)));
        let outputs = digests.collect::<Result<_>>()?;
        Ok(StepRecord { input: Some(input), outputs, passed, summary, result })
    }

    /// Records a step whose tool is missing.
    pub fn without(tool: &Tool) -> Self {
        let Tool { program, package } = tool;
        let summary =
            format!("not done: {program} is not on PATH; install it: apt-get install {package}");
        let (outputs, result) = (BTreeMap::new(), Value::Null);
        StepRecord { input: None, outputs, passed: false, summary, result }
    }

    /// Returns whether the files of the step are unchanged.
    fn is_whole(&self) -> bool {
        let is_same = |(path, known): (&PathBuf, &String)| {
            digest_of_file(path).is_ok_and(|found| found == *known)
        };
        self.input.is_some() && self.outputs.iter().all(is_same)
    }
}

impl Journal {
    /// Reads the journal of the current folder, or creates an empty one.
    ///
    /// # Errors
    /// When the file cannot be read, is no such journal, or does not match its checksum.
    pub fn read() -> Result<Self> {
        let path = Path::new(FILE);
        if !path.exists() {
            let (schema, steps) = (SCHEMA.to_owned(), BTreeMap::new());
            return Ok(Journal { schema, checksum: None, steps });
        }
        let journal: Option<Journal> = serde_json::from_str(&read_text(path)?).ok();
        let journal = journal.filter(|journal| journal.schema == SCHEMA).ok_or_else(|| {
            Input::new(FILE, "expected what a build leaves; remove it to begin anew")
        })?;
        if journal.checksum.is_some() && journal.checksum != Some(checksum(&journal.steps)?) {
            let expected = "damaged: does not match its checksum; remove it to begin anew";
            return Err(Input::new(FILE, expected).into());
        }
        Ok(journal)
    }

    /// Keeps what came of a step.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn put(&mut self, step: Step, record: StepRecord) -> Result<()> {
        self.steps.insert(step.name().to_owned(), record);
        self.checksum = Some(checksum(&self.steps)?);
        let text = serde_json::to_string_pretty(self).map_err(|error| Input::new(FILE, error))?;
        write_bytes(Path::new(FILE), text + "\n")
    }

    /// Result of a step.
    pub fn of(&self, step: Step) -> Option<&StepRecord> {
        self.steps.get(step.name())
    }

    /// Whether a step has been done with that input, and all its files are there.
    pub fn is_done(&self, step: Step, input: &str) -> bool {
        let is_same = |record: &&StepRecord| record.input.as_deref() == Some(input);
        self.of(step).filter(is_same).is_some_and(StepRecord::is_whole)
    }

    /// Whether a step has been done, and all its files are there.
    pub fn is_whole(&self, step: Step) -> bool {
        self.of(step).is_some_and(StepRecord::is_whole)
    }

    /// Why a step could not be done, if it was tried.
    pub fn missing(&self, step: Step) -> Option<&str> {
        let record = self.of(step).filter(|record| record.input.is_none())?;
        Some(&record.summary)
    }

    /// Whether a step has been done and found no fault.
    pub fn has_passed(&self, step: Step) -> bool {
        self.of(step).is_some_and(|record| record.passed)
    }
}
