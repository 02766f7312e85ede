//! Reads TOML: every file of ours, and every `key=value` of the command line, comes through here.
//!
//! A document is checked against the JSON Schema of the type that it is read into, so that every
//! fault has its place: an unknown key (with the nearest known one), a wrong type, a list of the
//! wrong length, a number out of range or no number, an unknown word.

use std::ops::Range;

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value as Json};
use toml_edit::{Document, DocumentMut, Item, Table, TableLike, Value};

use crate::error::{Error, Input, Result, line_and_column, nearest};

mod number;

use number::number;

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
        Ok(walk.table(self.document.as_table(), root)?)
    }
}

/// Reads a checked table into its type.
///
/// # Errors
/// When the values do not make one.
pub fn read<T: DeserializeOwned>(source: &str, table: &Table) -> Result<T> {
    let values = toml::Value::Table(values(table));
    values.try_into().map_err(|error| Input::new(source, error.message()).into())
}

/// The values of a table without their places.
fn values(table: &dyn TableLike) -> toml::Table {
    let of_item = |item: &Item| match (item.as_table_like(), item.as_array_of_tables()) {
        (Some(table), _) => Some(values(table).into()),
        (_, Some(tables)) => {
            Some(tables.iter().map(|table| values(table)).collect::<Vec<_>>().into())
        }
        _ => item.as_value().map(value),
    };
    table.iter().filter_map(|(key, item)| Some((key.to_owned(), of_item(item)?))).collect()
}

fn value(with_place: &Value) -> toml::Value {
    match with_place {
        Value::String(text) => text.value().as_str().into(),
        Value::Integer(number) => (*number.value()).into(),
        Value::Float(number) => (*number.value()).into(),
        Value::Boolean(truth) => (*truth.value()).into(),
        Value::Datetime(moment) => (*moment.value()).into(),
        Value::Array(list) => toml::Value::Array(list.iter().map(value).collect()),
        Value::InlineTable(table) => values(table).into(),
    }
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
    fn table(&self, table: &dyn TableLike, schema: &'a Json) -> Checkup {
        let schema = self.resolve(schema);
        let required = schema.get("required").and_then(Json::as_array).filter(|_| self.whole);
        let mut required = required.into_iter().flatten().filter_map(Json::as_str);
        if let Some(key) = required.find(|key| !table.contains_key(key)) {
            let expected = self.expected(&schema["properties"][key]);
            return Err(Input::new(self.source, format!("missing; {expected}")).field(key));
        }
        let known = schema.get("properties").and_then(Json::as_object);
        let empty = Map::new();
        let known = known.unwrap_or(&empty);
        for (key, item) in table.iter() {
            let any = schema.get("additionalProperties").filter(|any| any.is_object());
            let Some(schema) = known.get(key).or(any) else {
                let span = table.get_key_value(key).and_then(|(key, _)| key.span());
                let fault = Input::new(self.source, unknown_key(key, known)).field(key);
                return Err(located(fault, self.text, span));
            };
            self.item(item, schema).map_err(|fault| fault.below(key))?;
        }
        Ok(())
    }

    fn item(&self, item: &Item, schema: &'a Json) -> Checkup {
        if let Some(value) = item.as_value() {
            return self.value(value, schema);
        }
        let resolved = self.resolve(schema);
        match (kind(resolved), item.as_table_like(), item.as_array_of_tables()) {
            ("object", Some(table), _) => self.table(table, resolved),
            ("array", _, Some(tables)) if has_length(tables.len(), resolved) => {
                let items = &resolved["items"];
                tables.iter().enumerate().try_for_each(|(k, table)| {
                    self.table(table, items).map_err(|fault| fault.below(k))
                })
            }
            _ => Err(self.fault(shown(item), item.span(), schema)),
        }
    }

    fn value(&self, value: &Value, schema: &'a Json) -> Checkup {
        let resolved = self.resolve(schema);
        let holds = match (kind(resolved), value) {
            ("object", Value::InlineTable(table)) => return self.table(table, resolved),
            ("array", Value::Array(values)) if has_length(values.len(), resolved) => {
                let items = self.resolve(&resolved["items"]);
                let each = |(k, value)| self.value(value, items).map_err(|fault| fault.below(k));
                return values.iter().enumerate().try_for_each(each);
            }
            ("number" | "integer", Value::Integer(number)) => {
                in_range(*number.value() as f64, resolved)
            }
            ("number", Value::Float(number)) => in_range(*number.value(), resolved),
            ("boolean", Value::Boolean(_)) => true,
            (_, Value::String(word)) => match words(resolved) {
                Some(words) => words.contains(&word.value().as_str()),
                None => kind(resolved) == "string",
            },
            _ => false,
        };
        if holds { Ok(()) } else { Err(self.fault(shown_value(value), value.span(), schema)) }
    }

    /// That something is not what the schema wants.
    fn fault(&self, shown: String, span: Option<Range<usize>>, schema: &'a Json) -> Input {
        located(Input::new(self.source, self.expected(schema)).value(shown), self.text, span)
    }

    /// The schema itself, or what it refers to; of what may be absent, what it is if it is there.
    fn resolve(&self, schema: &'a Json) -> &'a Json {
        let schema = schema.get("anyOf").map_or(schema, |alternatives| &alternatives[0]);
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

/// Whether a list of so many is neither too short nor too long.
fn has_length(found: usize, schema: &Json) -> bool {
    let bound = |name| schema.get(name).and_then(Json::as_u64);
    let (least, most) = (bound("minItems").unwrap_or(0), bound("maxItems").unwrap_or(u64::MAX));
    (least..=most).contains(&(found as u64))
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

fn located(input: Input, text: &str, span: Option<Range<usize>>) -> Input {
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
    item.as_value().map_or_else(|| "a table".to_owned(), shown_value)
}

fn shown_value(value: &Value) -> String {
    match value.as_array() {
        Some(list) if list.len() > LISTED => format!("a list of {}", list.len()),
        _ => value.to_string().trim().to_owned(),
    }
}
