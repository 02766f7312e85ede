//! The one way in which results are printed and written.

use std::path::Path;

use serde_json::{Value, json};

use tofsim::Note;
use tofsim::error::Result;
use tofsim::sim::setup::Setup;

use crate::record::{LazyRecord, Record};
use crate::text::table::plain;
use crate::verbs::terminal::{Console, print, print_json};

use super::sheet::{NamedBytes, NamedText};

/// Findings of a verb: the object of `--json`, tables for people, and files.
pub trait Findings {
    /// Name and version of the JSON object.
    const SCHEMA: &'static str;
    /// File of the JSON object in the folder of `--output`, for verbs that have such a folder.
    const FILE: Option<&'static str> = None;

    /// Returns what the JSON object has beside schema, record and notes.
    fn json(&self) -> Value;

    /// Returns the JSON object, but for record and notes.
    fn object(&self) -> Value {
        let mut object = json!({ "schema": Self::SCHEMA });
        if let (Some(object), Value::Object(own)) = (object.as_object_mut(), self.json()) {
            object.extend(own);
        }
        object
    }

    /// Returns the tables for people.
    fn text(&self) -> String;

    /// Returns the CSV files.
    fn sheets(&self) -> Vec<NamedText> {
        Vec::new()
    }

    /// Draws the pictures.
    ///
    /// # Errors
    /// When the plotting library fails.
    fn plots(&self) -> Result<Vec<NamedText>> {
        Ok(Vec::new())
    }

    /// Returns the files of other formats, which hold the record's line where their format has a place for it.
    ///
    /// # Errors
    /// When a file cannot be encoded.
    fn other_files(&self, _record: &str) -> Result<Vec<NamedBytes>> {
        Ok(Vec::new())
    }
}

/// Returns rows of words as an array of JSON objects with the given keys.
pub fn objects<const N: usize>(keys: [&str; N], rows: &[[String; N]]) -> Value {
    let pairs = |row: &[String; N]| {
        let values = row.iter().map(|word| json!(word));
        Value::Object(keys.iter().map(|key| (*key).to_owned()).zip(values).collect())
    };
    rows.iter().map(pairs).collect()
}

/// Prints rows of words: as an array of JSON objects, or as a table without a header.
///
/// # Errors
/// When standard output is closed.
pub fn print_list<const N: usize>(
    keys: [&str; N],
    rows: &[[String; N]],
    as_json: bool,
) -> Result<()> {
    if as_json { print_json(&objects(keys, rows)) } else { print(&format!("{}\n", plain(rows))) }
}

/// Findings with what they come from and what limits them.
pub struct Report<'a, F> {
    /// The findings.
    pub findings: F,
    /// Scenario, version and command, if they decide what is found.
    pub record: Option<LazyRecord<'a>>,
    /// Notes on the validity of the findings.
    pub notes: &'a [Note],
}

impl<'a, F: Findings> Report<'a, F> {
    /// Reports what the command found of a setup.
    pub fn new(findings: F, setup: &'a Setup, notes: &'a [Note], console: &'a Console) -> Self {
        Report { findings, record: Some(Record::lazy(setup, &console.command)), notes }
    }

    /// Reports what was found of something else than a scenario.
    pub fn without_record(findings: F) -> Self {
        Report { findings, record: None, notes: &[] }
    }

    /// Returns the JSON object, with record and notes.
    pub fn json(&self) -> Value {
        let mut object = self.findings.object();
        self.record.iter().for_each(|record| record.put_into(&mut object, self.notes));
        object
    }

    /// Writes all files into the folder, if there is one, and prints JSON or tables.
    ///
    /// # Errors
    /// When a picture cannot be drawn, or something cannot be written.
    pub fn deliver(&self, folder: Option<&Path>, as_json: bool, console: &Console) -> Result<()> {
        if let (Some(folder), Some(record)) = (folder, &self.record) {
            let line = record.comment_line();
            let sheets = self.findings.sheets().into_iter();
            let sheets = sheets.map(|(name, csv)| (name, line.clone() + &csv));
            let plots = self.findings.plots()?.into_iter();
            let plots = plots.map(|(name, svg)| (name, record.in_svg(&svg)));
            let whole = F::FILE.map(|name| (name.to_owned(), format!("{:#}\n", self.json())));
            let texts = sheets.chain(plots).chain(whole);
            let texts = texts.map(|(name, text)| (name, text.into_bytes()));
            let others = self.findings.other_files(&record.line())?;
            console.write_into(folder, texts.chain(others))?;
        }
        if as_json { print_json(&self.json()) } else { console.report(&self.findings.text()) }
    }
}
