//! TOML input: all configuration files, and the `key=value` arguments of the command line.
//!
//! A document is checked against the JSON Schema of its type, so that errors have a position: unknown keys (with the
//! nearest known key), wrong types, lists of the wrong length, numbers out of range, and unknown words.

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use toml_edit::{Document, DocumentMut, Item, Table, TableLike, Value};

use crate::error::{Error, Input, Result, line_and_column};

mod node;
mod number;
mod renamed;
mod schema;
mod walk;

pub use renamed::{RenamedKey, rename};
pub use schema::schema_of;

use node::Node;
use number::number;
use walk::{Walk, located, shown};

/// A TOML document with the positions of its keys.
pub struct Checked {
    source: String,
    document: Document<String>,
}

impl Checked {
    /// Parses `text`, the contents of `source`, without checking its keys.
    ///
    /// # Errors
    /// If it is not valid TOML.
    pub fn syntax(source: &str, text: &str) -> Result<Self> {
        let document = Document::parse(text.to_owned()).map_err(|error| {
            let (line, column) = line_and_column(text, error.span().map_or(0, |span| span.start));
            Input::new(source, error.message()).at(line, column)
        })?;
        Ok(Checked { source: source.to_owned(), document })
    }

    /// Parses `text`, the contents of `source`, and checks it against the schema of `T`.
    ///
    /// # Errors
    /// If it is not valid TOML, or does not match the schema.
    pub fn parse<T: JsonSchema>(source: &str, text: &str) -> Result<Self> {
        let checked = Checked::syntax(source, text)?;
        checked.check::<T>(true)?;
        Ok(checked)
    }

    /// Parses `text`, and checks it against the schema of `T` without requiring any key, for overrides.
    ///
    /// # Errors
    /// If it is not valid TOML, or a key or value does not match the schema.
    pub fn part<T: JsonSchema>(source: &str, text: &str) -> Result<Self> {
        let checked = Checked::syntax(source, text)?;
        checked.check::<T>(false)?;
        Ok(checked)
    }

    /// Deserializes the document.
    ///
    /// # Errors
    /// If its values do not make a `T`.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T> {
        read(&self.source, self.table())
    }

    /// Returns the document's root table.
    pub fn table(&self) -> &Table {
        self.document.as_table()
    }

    /// Creates an error at a dotted key, with its position if the document contains it.
    pub fn fault(&self, key: &str, expected: impl std::fmt::Display) -> Input {
        let input = Input::new(&self.source, expected).field(key);
        let mut item = Some(self.document.as_item());
        for part in key.split('.') {
            item = item.and_then(|item| match part.parse::<usize>() {
                Ok(index) => item.get(index),
                Err(_) => item.get(part),
            });
        }
        match item {
            Some(item) => located(input.value(shown(item)), self.document.raw(), item.span()),
            None => input,
        }
    }

    fn check<T: JsonSchema>(&self, whole: bool) -> Result<()> {
        let (root, text) = (&*schema_of::<T>(), self.document.raw());
        let walk = Walk { root, source: &self.source, text, whole };
        Ok(walk.table(self.document.as_table(), root)?)
    }
}

/// Deserializes a table that has been checked.
///
/// # Errors
/// If its values do not make a `T`.
pub fn read<T: DeserializeOwned>(source: &str, table: &Table) -> Result<T> {
    let read = T::deserialize(Node::Table(table));
    read.map_err(|error| Input::new(source, error).into())
}

/// Sets one dotted key of a table of type `T` from the `key=value` argument of `option`. A value that is not valid
/// TOML is taken as a text.
///
/// # Errors
/// If it is not an assignment, or `T` has no such key or value.
pub fn assign<T: JsonSchema>(table: &mut Table, option: &str, assignment: &str) -> Result<()> {
    let source = format!("{option} {assignment}");
    let pair = assignment.split_once('=').filter(|(key, _)| !key.trim().is_empty());
    let Some((key, value)) = pair else {
        return Err(Input::new(source, "expected key=value").into());
    };
    if assignment.contains(char::is_control) {
        return Err(Input::new(option, "expected one key=value, on one line").value(key).into());
    }
    let (key, value) = (key.trim(), value.trim());
    let text = format!("{key} = {}", Value::from(value));
    let as_toml = format!("{key} = {value}");
    let checked = match (as_toml.parse::<DocumentMut>(), number(value)) {
        (Ok(_), _) => Checked::part::<T>(&source, &as_toml),
        // The key says whether it is to be a number or a text.
        (_, Some(number)) => {
            let number = Checked::part::<T>(&source, &format!("{key} = {number}"));
            number.or_else(|fault| Checked::part::<T>(&source, &text).map_err(|_| fault))
        }
        _ => Checked::part::<T>(&source, &text),
    };
    // A place inside an option of the command line says nothing.
    let checked = checked.map_err(|error| match error {
        Error::Input(input) => Input { place: None, ..*input }.into(),
        other => other,
    })?;
    merge(table, checked.table());
    Ok(())
}

/// Merges `over` into `under`, key by key.
pub fn merge(under: &mut dyn TableLike, over: &dyn TableLike) {
    for (key, item) in over.iter() {
        match (under.get_mut(key).and_then(Item::as_table_like_mut), item.as_table_like()) {
            (Some(under), Some(over)) => merge(under, over),
            _ => drop(under.insert(key, item.clone())),
        }
    }
}
