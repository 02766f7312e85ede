//! Reads TOML: every file of ours, and every `key=value` of the command line, comes through here.
//!
//! A document is checked against the JSON Schema of the type that it is read into, so that every
//! fault has its place: an unknown key (with the nearest known one), a wrong type, a list of the
//! wrong length, a number out of range or no number, an unknown word.

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value as Json};
use toml_edit::{Document, DocumentMut, Item, Table, TableLike, Value};

use crate::error::{Error, Input, Result, line_and_column, nearest};

/// A TOML document with the places of its keys.
pub struct Checked {
    source: String,
    document: Document<String>,
}

impl Checked {
    /// Parses `text`, the contents of `source`, without a look at what its keys are.
    ///
    /// # Errors
    /// When it is no TOML.
    pub fn syntax(source: &str, text: &str) -> Result<Self> {
        let document = Document::parse(text.to_owned()).map_err(|error| {
            let (line, column) = line_and_column(text, error.span().map_or(0, |span| span.start));
            Input::new(source, error.message()).at(line, column)
        })?;
        Ok(Checked { source: source.to_owned(), document })
    }

    /// Parses and checks `text`, the contents of `source`, as a `T`.
    ///
    /// # Errors
    /// When it is no TOML, or does not have what a `T` has.
    pub fn parse<T: JsonSchema>(source: &str, text: &str) -> Result<Self> {
        let checked = Checked::syntax(source, text)?;
        checked.check::<T>(true)?;
        Ok(checked)
    }

    /// The same of a text that says only a part of a `T`, to be laid over another.
    ///
    /// # Errors
    /// When it is no TOML, or has what a `T` does not have.
    pub fn part<T: JsonSchema>(source: &str, text: &str) -> Result<Self> {
        let checked = Checked::syntax(source, text)?;
        checked.check::<T>(false)?;
        Ok(checked)
    }

    /// The values as a `T`.
    ///
    /// # Errors
    /// When they do not make one.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T> {
        read(&self.source, self.table())
    }

    /// The values.
    pub fn table(&self) -> &Table {
        self.document.as_table()
    }

    /// A fault at a dotted key, with the key's place if the document has it.
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
        let schema = schemars::schema_for!(T);
        let (root, text) = (schema.as_value(), self.document.raw());
        let walk = Walk { root, source: &self.source, text, whole };
        Ok(walk.table(self.document.as_table(), root, "")?)
    }
}

/// Reads a checked table into its type.
///
/// # Errors
/// When the values do not make one.
pub fn read<T: DeserializeOwned>(source: &str, table: &Table) -> Result<T> {
    toml_edit::de::from_document(DocumentMut::from(table.clone()))
        .map_err(|error| Input::new(source, error.message()).into())
}

/// Sets one dotted key of a table that is to be a `T`, as `option` of the command line has it:
/// `key=value`. What is no TOML value is taken as a text.
///
/// # Errors
/// When it is no assignment, or a `T` has no such key or value.
pub fn assign<T: JsonSchema>(table: &mut Table, option: &str, assignment: &str) -> Result<()> {
    let source = format!("{option} {assignment}");
    let Some((key, value)) = assignment.split_once('=') else {
        return Err(Input::new(source, "expected key=value").into());
    };
    if assignment.contains(char::is_control) {
        return Err(Input::new(option, "expected one key=value, on one line").value(key).into());
    }
    let (key, value) = (key.trim(), value.trim());
    let as_toml = format!("{key} = {value}");
    let text = match as_toml.parse::<DocumentMut>() {
        Ok(_) => as_toml,
        Err(_) => format!("{key} = {}", Value::from(value)),
    };
    // A place inside an option of the command line says nothing.
    let checked = Checked::part::<T>(&source, &text).map_err(|error| match error {
        Error::Input(input) => Input { place: None, ..*input }.into(),
        other => other,
    })?;
    merge(table, checked.table());
    Ok(())
}

/// Lays a table over another, key by key.
pub fn merge(under: &mut dyn TableLike, over: &dyn TableLike) {
    for (key, item) in over.iter() {
        match (under.get_mut(key).and_then(Item::as_table_like_mut), item.as_table_like()) {
            (Some(under), Some(over)) => merge(under, over),
            _ => drop(under.insert(key, item.clone())),
        }
    }
}

struct Walk<'a> {
    root: &'a Json,
    source: &'a str,
    text: &'a str,
    /// Whether every key has to be there that has to be.
    whole: bool,
}

type Checkup = std::result::Result<(), Input>;

impl<'a> Walk<'a> {
    fn table(&self, table: &dyn TableLike, schema: &'a Json, path: &str) -> Checkup {
        let schema = self.resolve(schema);
        let required = schema.get("required").and_then(Json::as_array).filter(|_| self.whole);
        let mut required = required.into_iter().flatten().filter_map(Json::as_str);
        if let Some(key) = required.find(|key| !table.contains_key(key)) {
            let full = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            let expected = self.expected(&schema["properties"][key]);
            return Err(Input::new(self.source, format!("missing; {expected}")).field(full));
        }
        let known = schema.get("properties").and_then(Json::as_object);
        let empty = Map::new();
        let known = known.unwrap_or(&empty);
        for (key, item) in table.iter() {
            let full = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            let any = schema.get("additionalProperties").filter(|any| any.is_object());
            let Some(schema) = known.get(key).or(any) else {
                let span = table.get_key_value(key).and_then(|(key, _)| key.span());
                let fault = Input::new(self.source, unknown_key(key, known)).field(full);
                return Err(located(fault, self.text, span));
            };
            self.item(item, schema, &full)?;
        }
        Ok(())
    }

    fn item(&self, item: &Item, schema: &'a Json, path: &str) -> Checkup {
        let expected = self.expected(schema);
        let fault = |expected: &str| {
            let fault = Input::new(self.source, expected).field(path).value(shown(item));
            Err(located(fault, self.text, item.span()))
        };
        let schema = self.resolve(schema);
        if let Some(words) = words(schema) {
            let known = item.as_str().is_some_and(|word| words.contains(&word));
            return if known { Ok(()) } else { fault(&expected) };
        }
        match (kind(schema), item) {
            ("object", item) => match item.as_table_like() {
                Some(table) => self.table(table, schema, path),
                None => fault("expected a table"),
            },
            ("array", item) if has_other_length(item, schema) => fault(&expected),
            ("array", Item::ArrayOfTables(tables)) => {
                let elements = tables.iter().enumerate();
                elements.into_iter().try_for_each(|(k, table)| {
                    self.table(table, &schema["items"], &format!("{path}.{k}"))
                })
            }
            ("array", Item::Value(Value::Array(values))) => {
                values.iter().enumerate().try_for_each(|(k, value)| {
                    let item = Item::Value(value.clone());
                    self.item(&item, &schema["items"], &format!("{path}.{k}"))
                })
            }
            ("string", Item::Value(Value::String(_)))
            | ("boolean", Item::Value(Value::Boolean(_))) => Ok(()),
            ("number" | "integer", Item::Value(Value::Integer(number))) => {
                let number = *number.value() as f64;
                if in_range(number, schema) { Ok(()) } else { fault(&expected) }
            }
            ("number", Item::Value(Value::Float(number))) => {
                if in_range(*number.value(), schema) {
                    Ok(())
                } else {
                    fault(&expected)
                }
            }
            _ => fault(&expected),
        }
    }

    /// The schema itself, or what it refers to; of what may be absent, what it is if it is there.
    fn resolve(&self, schema: &'a Json) -> &'a Json {
        let schema = schema.pointer("/anyOf/0").unwrap_or(schema);
        let reference = schema.get("$ref").and_then(Json::as_str);
        let target = reference.and_then(|path| self.root.pointer(path.trim_start_matches('#')));
        target.unwrap_or(schema)
    }

    /// In words, what the key may hold.
    fn expected(&self, schema: &'a Json) -> String {
        let resolved = self.resolve(schema);
        if let Some(words) = words(resolved) {
            return format!("expected one of `{}`", words.join("`, `"));
        }
        let what = match kind(resolved) {
            "integer" => "a whole number",
            "number" => "a number",
            "boolean" => "true or false",
            "string" => "a text in quotes",
            "array" => return format!("expected a list{}", lengths(resolved)),
            _ => "a table",
        };
        let bound = |name| resolved.get(name).map(Json::to_string);
        let range = match (bound("minimum"), bound("maximum")) {
            (Some(low), Some(high)) => format!(" from {low} to {high}"),
            (Some(low), None) => format!(" from {low}"),
            _ => String::new(),
        };
        let unit = match schema.get("unit").and_then(Json::as_str) {
            Some(unit) if unit != "1" => format!(" [{unit}]"),
            _ => String::new(),
        };
        format!("expected {what}{range}{unit}")
    }
}

fn kind(schema: &Json) -> &str {
    match schema.get("type") {
        Some(Json::String(kind)) => kind,
        Some(Json::Array(kinds)) => kinds.first().and_then(Json::as_str).unwrap_or(""),
        _ => "",
    }
}

/// The words of an enumeration.
fn words(schema: &Json) -> Option<Vec<&str>> {
    let alternatives = schema.get("oneOf").or(schema.get("enum"))?.as_array()?;
    Some(alternatives.iter().filter_map(|a| a.as_str().or(a.get("const")?.as_str())).collect())
}

fn in_range(number: f64, schema: &Json) -> bool {
    let bound = |name| schema.get(name).and_then(Json::as_f64);
    number >= bound("minimum").unwrap_or(f64::MIN) && number <= bound("maximum").unwrap_or(f64::MAX)
}

/// Whether a list is too short or too long.
fn has_other_length(item: &Item, schema: &Json) -> bool {
    let length = item.as_array().map(|list| list.len());
    let length = length.or(item.as_array_of_tables().map(|list| list.len())).map(|n| n as u64);
    let bound = |name| schema.get(name).and_then(Json::as_u64);
    length.is_some_and(|n| {
        n < bound("minItems").unwrap_or(0) || n > bound("maxItems").unwrap_or(u64::MAX)
    })
}

/// How long a list has to be, in words.
fn lengths(schema: &Json) -> String {
    match ["minItems", "maxItems"].map(|name| schema.get(name).and_then(Json::as_u64)) {
        [Some(least), Some(most)] if least == most => format!(" of {least}"),
        [Some(least), Some(most)] => format!(" of {least} to {most}"),
        [Some(least), None] => format!(" of at least {least}"),
        _ => String::new(),
    }
}

fn unknown_key(key: &str, known: &Map<String, Json>) -> String {
    match nearest(key, known.keys().map(String::as_str)) {
        Some(known) => format!("unknown key; did you mean `{known}`?"),
        None => {
            let names: Vec<_> = known.keys().map(String::as_str).collect();
            format!("unknown key; expected one of `{}`", names.join("`, `"))
        }
    }
}

fn located(input: Input, text: &str, span: Option<std::ops::Range<usize>>) -> Input {
    match span {
        Some(span) => {
            let (line, column) = line_and_column(text, span.start);
            input.at(line, column)
        }
        None => input,
    }
}

/// Longest list that a message shows.
const LISTED: usize = 8;

fn shown(item: &Item) -> String {
    match item {
        Item::Table(_) | Item::ArrayOfTables(_) => "a table".to_owned(),
        Item::Value(Value::Array(list)) if list.len() > LISTED => {
            format!("a list of {}", list.len())
        }
        item => item.to_string().trim().to_owned(),
    }
}
