//! Records of what other people's tools have answered: a test asks a tool again only when what the tool reads has changed.
//!
//! A line of a record is a check, the digest of its inputs and the answer. A check that is not in it is made, so that its
//! test is slower but no less strict. With `UPDATE_RECORDS=1` a test program also writes its records anew: with the checks
//! that its tests have come by, and no other. An empty record has all made again.
#![allow(dead_code, reason = "each test program uses a part of it")]

#[path = "record/inputs.rs"]
mod inputs;

use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;
use std::sync::{Mutex, Once};
use std::{env, fs};

pub use inputs::Inputs;

/// Makes a test program write its records.
const UPDATE: &str = "UPDATE_RECORDS";

/// Answers by check and digest.
type Answers = BTreeMap<(String, String), String>;

/// A record of one test program.
pub struct Record {
    path: PathBuf,
    command: &'static str,
    known: Answers,
    used: Mutex<Answers>,
    lacks: Once,
    /// True if it is written anew.
    pub updates: bool,
}

impl Record {
    /// Reads a record; `command` renews it, with [`UPDATE`].
    pub fn read(path: impl Into<PathBuf>, command: &'static str) -> Self {
        let path = path.into();
        let text = fs::read_to_string(&path).unwrap_or_default();
        let known = text.lines().filter(|line| !line.starts_with('#')).map(|line| {
            let cells: Vec<_> = line.split('\t').map(str::to_owned).collect();
            let [check, digest, answer] = cells.try_into().expect("three cells in a line");
            ((check, digest), answer)
        });
        let (known, updates) = (known.collect(), env::var_os(UPDATE).is_some());
        Record { path, command, known, used: Mutex::default(), lacks: Once::new(), updates }
    }

    /// The answer to a check of those inputs: the recorded one, or that of the tool, which is one line. An `Err` is an
    /// answer that the tool may not give again, so it is not recorded.
    pub fn answer(
        &self,
        check: &str,
        inputs: &Inputs,
        ask: impl FnOnce() -> Result<String, String>,
    ) -> String {
        let key = (check.to_owned(), inputs.to_string());
        let answer = match self.known.get(&key) {
            Some(answer) => answer.clone(),
            None => {
                self.lacks.call_once(|| self.say(check));
                match ask() {
                    Ok(answer) => answer,
                    Err(answer) => return answer,
                }
            }
        };
        if self.updates {
            self.write(key, answer.clone());
        }
        answer
    }

    /// Tells people, past the capture of tests, why they wait.
    fn say(&self, check: &str) {
        if self.updates {
            return;
        }
        let name = self.path.file_name().unwrap_or_default().display();
        let line =
            format!("{name} lacks `{check}` as it is now, or more: {UPDATE}=1 {}\n", self.command);
        std::io::stderr().write_all(line.as_bytes()).unwrap();
    }

    /// Writes what has been used so far, beside the record and then in its place.
    fn write(&self, key: (String, String), answer: String) {
        let mut used = self.used.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        used.insert(key, answer);
        let lines = used.iter().map(|((check, digest), answer)| {
            let line = [check.as_str(), digest, answer].join("\t");
            assert_eq!((line.lines().count(), line.matches('\t').count()), (1, 2), "{line}");
            line + "\n"
        });
        let lines: String = lines.collect();
        let (part, head) =
            (self.path.with_extension("part"), format!("# {UPDATE}=1 {}\n", self.command));
        fs::write(&part, head + &lines).unwrap();
        fs::rename(&part, &self.path).unwrap();
    }
}
