//! The record of its origin that every output carries.

use std::cell::LazyCell;
use std::path::Path;

use clap::parser::ValueSource;
use clap::{ArgAction, ArgMatches, Command};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use tofsim::Note;
use tofsim::error::{Input, Result, read_text};
use tofsim::sim::setup::Setup;

/// Begins the record in a file that is not JSON.
pub const MARK: &str = "tofsim-record ";

/// Options that leave the bytes of an output as they are, or only say where it goes.
const LEFT_OUT: [&str; 10] = [
    "output",
    "threads",
    "quiet",
    "verbose",
    "strict",
    "json",
    "resume",
    "restart",
    "shard",
    "checkpoints",
];

/// Origin of an output.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Version of the program.
    pub version: String,
    /// The scenario's name.
    pub scenario: String,
    /// The overrides, as given.
    pub set: Vec<String>,
    /// Seed of every random stream.
    pub seed: u64,
    /// Hash of the resolved scenario.
    pub hash: String,
    /// The verb and its options, but for those that only say where outputs go.
    pub command: Vec<String>,
}

/// A record that is made for the first output that has it: its hash goes over every parameter of the setup.
pub type LazyRecord<'a> = LazyCell<Record, Box<dyn FnOnce() -> Record + 'a>>;

/// Returns a record that is there already.
impl From<Record> for LazyRecord<'_> {
    fn from(record: Record) -> Self {
        LazyCell::new(Box::new(|| record))
    }
}

impl Record {
    /// Records a command on a setup, for the first output that has the record.
    pub fn lazy<'a>(setup: &'a Setup, command: &'a [String]) -> LazyRecord<'a> {
        LazyCell::new(Box::new(|| Record::new(setup, command)))
    }

    /// Records a command on a setup.
    pub fn new(setup: &Setup, command: &[String]) -> Self {
        Record {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scenario: setup.name.clone(),
            set: setup.set.clone(),
            seed: setup.scenario.seed,
            hash: setup.hash(),
            command: command.to_vec(),
        }
    }

    /// Lines of a comment: what a setup says of itself, and the record on one line.
    pub fn lines(&self, setup: &Setup) -> Vec<String> {
        setup.provenance().into_iter().chain([self.line()]).collect()
    }

    /// The record on one line, in characters that no comment takes for its end.
    pub fn line(&self) -> String {
        let mut text = json!(self).to_string();
        for (special, escaped) in
            [("$", "\\u0024"), ("<", "\\u003c"), (">", "\\u003e"), ("--", "-\\u002d")]
        {
            text = text.replace(special, escaped);
        }
        format!("{MARK}{text}")
    }

    /// The first line of a CSV or TOML file.
    pub fn comment_line(&self) -> String {
        format!("# {}\n", self.line())
    }

    /// A picture with the record in it.
    pub fn in_svg(&self, svg: &str) -> String {
        match svg.rfind("</svg>") {
            Some(end) => format!("{}<!-- {} -->\n{}", &svg[..end], self.line(), &svg[end..]),
            None => svg.to_owned(),
        }
    }

    /// Puts the record and the notes into a JSON object, over what has the same keys.
    pub fn put_into(&self, object: &mut Value, notes: &[Note]) {
        let Some(object) = object.as_object_mut() else { return };
        if let Value::Object(own) = json!(self) {
            object.extend(own);
        }
        object.insert("notes".to_owned(), json!(notes));
    }

    /// The record in the bytes of a file, if it has one.
    pub fn find(bytes: &[u8]) -> Option<Record> {
        if bytes.trim_ascii_start().starts_with(b"{") {
            let mut object: Value = serde_json::from_slice(bytes).ok()?;
            // A network as plain arrays has numbers beside.
            let within = object.pointer_mut("/training/record").map(Value::take);
            return serde_json::from_value(within.unwrap_or(object)).ok();
        }
        // A page has its own record last, after those of its pictures.
        let is_page = bytes.starts_with(b"<!DOCTYPE html>");
        let mut marked = places(bytes, MARK.as_bytes());
        let marked = if is_page { marked.last() } else { marked.next() };
        let marked = marked.map(|place| place + MARK.len());
        // A dataset's description is an object in the Parquet file's metadata.
        let begin = marked.or_else(|| places(bytes, br#"{"schema":"tofsim."#).next())?;
        serde_json::Deserializer::from_slice(&bytes[begin..]).into_iter().next()?.ok()
    }
}

/// Reads the JSON object of a file.
///
/// # Errors
/// When the file cannot be read, or is no JSON.
pub fn read_object(path: &Path) -> Result<Value> {
    let text = read_text(path)?;
    serde_json::from_str(&text).map_err(|error| Input::new(path.display(), error).into())
}

/// Returns the places of `wanted` in `bytes`.
fn places(bytes: &[u8], wanted: &'static [u8]) -> impl Iterator<Item = usize> {
    let windows = bytes.windows(wanted.len()).enumerate();
    windows.filter(move |(_, window)| *window == wanted).map(|(place, _)| place)
}

/// The verb and the options that were given, as a command line has them.
pub fn command_line(command: &Command, matches: &ArgMatches) -> Vec<String> {
    let Some((verb, given)) = matches.subcommand() else { return Vec::new() };
    let mut words = vec![verb.to_owned()];
    let Some(command) = command.find_subcommand(verb) else { return words };
    let mut places = Vec::new();
    for argument in command.get_arguments() {
        let id = argument.get_id().as_str();
        let is_given = given.value_source(id) == Some(ValueSource::CommandLine);
        if !is_given || LEFT_OUT.contains(&id) {
            continue;
        }
        let values = given.get_raw(id).into_iter().flatten();
        let values = values.map(|value| value.to_string_lossy().into_owned());
        // The shots and transactions of a run go where it is told; only the name of their file is part of it.
        let name = |path: String| match Path::new(&path).file_name() {
            Some(name) if ["events", "transactions"].contains(&id) => {
                name.to_string_lossy().into_owned()
            }
            _ => path,
        };
        let values = values.map(name);
        match (argument.get_long(), argument.get_action()) {
            (None, _) => places.extend(values),
            (Some(long), ArgAction::Set | ArgAction::Append) => {
                words.extend(values.map(|value| format!("--{long}={value}")));
            }
            (Some(long), _) => words.push(format!("--{long}")),
        }
    }
    words.extend(command_line(command, given));
    words.extend(places);
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record() -> Record {
        Record {
            version: "0.1.0".into(),
            scenario: "kc705".into(),
            set: vec!["target.distance_m=0.3".into()],
            seed: 7,
            hash: "0123456789abcdef".into(),
            command: ["run", "--set=description=a $end --> b"].map(str::to_owned).into(),
        }
    }

    #[test]
    fn a_record_is_found_in_a_comment_of_any_format() {
        let record = record();
        for text in [
            format!("$comment {} $end\n#0\n", record.line()),
            format!("{}bin,count\n0,1\n", record.comment_line()),
            record.in_svg("<svg>\n</svg>\n"),
        ] {
            assert_eq!(Record::find(text.as_bytes()), Some(record.clone()), "{text}");
            assert_eq!(text.matches("$end").count(), text.matches("$comment").count(), "{text}");
            assert!(text.matches("--").count() <= 2, "{text}");
        }
        let mut object = json!({ "schema": "tofsim.run/1", "frames": [1] });
        record.put_into(&mut object, &[]);
        assert_eq!(Record::find(object.to_string().as_bytes()).as_ref(), Some(&record));
        let network = json!({ "b": [[0.5]], "training": { "seed": 1, "record": record } });
        assert_eq!(Record::find(network.to_string().as_bytes()), Some(record));
        assert_eq!(Record::find(b"bin,count\n"), None);
        assert_eq!(Record::find(b"tofsim-record {\"version\":"), None);
    }
}
