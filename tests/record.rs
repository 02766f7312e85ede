//! Records of what other people's tools have answered: a test asks a tool again only when what the tool reads has changed.
//!
//! A line of a record is a check, the digest of its inputs and the answer. A check that is not in it is made, and makes
//! its test slower but no less strict. With `UPDATE_RECORDS=1` a test program makes those checks and writes the record
//! anew, with what it has come by and nothing else; what is not in an empty file is made.
#![allow(dead_code, reason = "each test program uses a part of it")]

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use std::io::Write;
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, Once};
use std::{env, fs};

use tofsim::files::digest::digest;

/// Makes a test program write its records.
const UPDATE: &str = "UPDATE_RECORDS";

/// Comments that begin so are for a tool, which may do something else without them.
const FOR_TOOLS: [&str; 4] = ["verilator", "synthesis", "synopsys", "pragma"];

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

/// A digest of all that a check reads.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inputs(u64);

impl Display for Inputs {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl Inputs {
    /// With a text, letter for letter.
    pub fn text(self, name: &str, text: impl AsRef<[u8]>) -> Self {
        let text = text.as_ref();
        let head = format!("{name} {}\n", text.len());
        Inputs(digest(digest(self.0, head.as_bytes()), text))
    }

    /// With some Verilog, without comments and layout.
    pub fn verilog(self, name: &str, text: &str) -> Self {
        self.text(name, verilog(text).join("\n"))
    }

    /// With some Rust, without comments that have a line of their own.
    pub fn rust(self, name: &str, text: &str) -> Self {
        let lines = text.lines().map(str::trim).filter(|line| !line.starts_with("//"));
        self.text(name, lines.collect::<Vec<_>>().join("\n"))
    }

    /// With the version of a tool: others may answer otherwise.
    pub fn version(self, program: &str, option: &str) -> Self {
        static VERSIONS: Mutex<BTreeMap<String, String>> = Mutex::new(BTreeMap::new());
        let mut versions = VERSIONS.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let ask = || {
            let said = Command::new(program).arg(option).output().expect(program).stdout;
            String::from_utf8_lossy(&said).lines().next().expect("a version").to_owned()
        };
        self.text(program, versions.entry(program.to_owned()).or_insert_with(ask))
    }
}

/// The lines of some Verilog, without comments and layout.
fn verilog(text: &str) -> Vec<String> {
    let (mut code, mut rest) = (String::new(), text);
    while let Some(at) = rest.find(['"', '/']) {
        let (before, from) = rest.split_at(at);
        code.push_str(before);
        let until = |end: &str| from[2..].find(end).map_or(from.len(), |found| 2 + found);
        let (length, comment) = match from.as_bytes() {
            [b'/', b'/', ..] => (until("\n"), Some(&from[2..])),
            [b'/', b'*', ..] => (from.len().min(until("*/") + 2), Some(&from[2..])),
            [b'"', ..] => (string(from), None),
            _ => (1, None),
        };
        let is_for_tool =
            |text: &str| FOR_TOOLS.iter().any(|word| text.trim_start().starts_with(word));
        code.push_str(if comment.is_none_or(is_for_tool) { &from[..length] } else { " " });
        rest = &from[length..];
    }
    code.push_str(rest);
    let lines = code.lines().map(str::trim).filter(|line| !line.is_empty());
    lines.map(str::to_owned).collect()
}

/// Length of the string that a text begins with [bytes].
fn string(text: &str) -> usize {
    let mut is_escaped = false;
    let end = text[1..].find(|letter| {
        let ends = letter == '"' && !is_escaped;
        is_escaped = letter == '\\' && !is_escaped;
        ends
    });
    end.map_or(text.len(), |end| end + 2)
}
