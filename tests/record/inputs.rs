//! A digest of all that a check reads.

use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};
use std::process::Command;
use std::sync::Mutex;

use tofsim::files::digest::digest;

/// Comments that begin so are for a tool, which may do something else without them.
const FOR_TOOLS: [&str; 4] = ["verilator", "synthesis", "synopsys", "pragma"];

/// The digest, of what has been added so far.
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

    /// With other inputs.
    pub fn all(self, name: &str, inputs: &[Inputs]) -> Self {
        let digests: Vec<_> = inputs.iter().map(Inputs::to_string).collect();
        self.text(name, digests.join(" "))
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
