//! Checks a TOML document against the JSON Schema of the type it is read into.
//!
//! So that every fault has its place: an unknown key (with the nearest known one), a wrong type, a
//! number out of range or no number, an unknown word.

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value as Json};
use toml_edit::{Document, Item, Table, TableLike, Value};

use crate::error::{Input, Result, line_and_column};

/// A TOML document with the places of its keys.
pub struct Checked {
    source: String,
    document: Document<String>,
}

impl Checked {
    /// Parses and checks `text`, the contents of `source`, as a `T`.
    pub fn parse<T: JsonSchema>(source: &str, text: &str) -> Result<Self> {
        let document = Document::parse(text.to_owned()).map_err(|error| {
            let (line, column) = line_and_column(text, error.span().map_or(0, |span| span.start));
            Input::new(source, error.message()).at(line, column)
        })?;
        let checked = Checked { source: source.to_owned(), document };
        checked.check(schemars::schema_for!(T).as_value())?;
        Ok(checked)
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

    fn check(&self, schema: &Json) -> Result<()> {
        let walk = Walk { root: schema, source: &self.source, text: self.document.raw() };
        Ok(walk.table(self.document.as_table(), schema, "")?)
    }
}

/// Reads a checked table into its type.
pub fn read<T: DeserializeOwned>(source: &str, table: &Table) -> Result<T> {
    let document = toml_edit::DocumentMut::from(table.clone());
    toml_edit::de::from_document(document)
        .map_err(|error| Input::new(source, error.message()).into())
}

struct Walk<'a> {
    root: &'a Json,
    source: &'a str,
    text: &'a str,
}

type Checkup = std::result::Result<(), Input>;

impl<'a> Walk<'a> {
    fn table(&self, table: &dyn TableLike, schema: &'a Json, path: &str) -> Checkup {
        let schema = self.resolve(schema);
        let required = schema.get("required").and_then(Json::as_array).into_iter().flatten();
        if let Some(key) = required.filter_map(Json::as_str).find(|key| !table.contains_key(key)) {
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

    /// The schema itself, or what it refers to.
    fn resolve(&self, schema: &'a Json) -> &'a Json {
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
            "array" => "a list",
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

fn unknown_key(key: &str, known: &Map<String, Json>) -> String {
    match crate::error::nearest(key, known.keys().map(String::as_str)) {
        Some(nearest) => format!("unknown key; did you mean `{nearest}`?"),
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

fn shown(item: &Item) -> String {
    match item {
        Item::Table(_) | Item::ArrayOfTables(_) => "a table".to_owned(),
        item => item.to_string().trim().to_owned(),
    }
}
