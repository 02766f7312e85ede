//! Check of a TOML document against a JSON Schema.

use std::ops::{Range, RangeInclusive};

use serde_json::{Map, Value as Json};
use toml_edit::{Array, Item, TableLike, Value};

use crate::error::{Input, line_and_column, nearest};

/// Recursive check of a document against its schema.
pub(super) struct Walk<'a> {
    /// Root of the schema, to which its references are relative.
    pub root: &'a Json,
    /// Name of the document in errors.
    pub source: &'a str,
    /// Text of the document.
    pub text: &'a str,
    /// Whether required keys must be present.
    pub whole: bool,
}

/// Result of a check.
type Checkup = std::result::Result<(), Input>;

impl<'a> Walk<'a> {
    /// Checks a table against its schema.
    pub fn table(&self, table: &dyn TableLike, schema: &'a Json) -> Checkup {
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
            let former = || by_former_name(key, known);
            let Some(schema) = known.get(key).or_else(former).or(any) else {
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
            // The schema takes anything.
            _ if *resolved == Json::Bool(true) => true,
            ("object", Value::InlineTable(table)) => return self.table(table, resolved),
            ("array", Value::Array(values)) if has_length(values.len(), resolved) => {
                return self.list(values, self.resolve(&resolved["items"]));
            }
            (_, Value::Integer(_) | Value::Float(_)) => {
                Numbers::of(resolved).is_some_and(|numbers| numbers.contain(value))
            }
            (_, Value::Boolean(_)) => may_be(resolved, "boolean"),
            (_, Value::String(word)) => match words(resolved) {
                Some(words) => words.contains(&word.value().as_str()),
                None => kind(resolved) == "string",
            },
            _ => false,
        };
        if holds { Ok(()) } else { Err(self.fault(shown_value(value), value.span(), schema)) }
    }

    /// Checks the values of a list against the schema of each.
    fn list(&self, values: &Array, items: &'a Json) -> Checkup {
        let numbers = Numbers::of(items);
        let is_number = |value| numbers.as_ref().is_some_and(|numbers| numbers.contain(value));
        let mut others = values.iter().enumerate().filter(|(_, value)| !is_number(value));
        others.try_for_each(|(k, value)| self.value(value, items).map_err(|fault| fault.below(k)))
    }

    /// Creates an error for a value that does not match its schema.
    fn fault(&self, shown: String, span: Option<Range<usize>>, schema: &'a Json) -> Input {
        located(Input::new(self.source, self.expected(schema)).value(shown), self.text, span)
    }

    fn resolve(&self, schema: &'a Json) -> &'a Json {
        resolve(self.root, schema)
    }

    /// Describes the values that a schema accepts.
    fn expected(&self, schema: &'a Json) -> String {
        let resolved = self.resolve(schema);
        if let Some(words) = words(resolved) {
            return format!("expected one of `{}`", words.join("`, `"));
        }
        let what = match kind(resolved) {
            "integer" => "a whole number",
            "number" => "a number",
            "boolean" => "true or false",
            "string" if may_be(resolved, "boolean") => "true or a text in quotes",
            "string" => "a text in quotes",
            "array" => return format!("expected a list{}", lengths(resolved)),
            _ => "a table",
        };
        let bound = |name| resolved.get(name).map(Json::to_string);
        let range = match (bound("minimum"), bound("maximum")) {
            (Some(low), Some(high)) => format!(" from {low} to {high}"),
            // TOML has no greater ones.
            (Some(low), None) if what == "a whole number" => format!(" from {low} to {}", i64::MAX),
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

/// Resolves a reference and the alternative of an optional value, if the schema is one.
pub(super) fn resolve<'a>(root: &'a Json, schema: &'a Json) -> &'a Json {
    let schema = schema.get("anyOf").map_or(schema, |alternatives| &alternatives[0]);
    let reference = schema.get("$ref").and_then(Json::as_str);
    let target = reference.and_then(|path| root.pointer(path.trim_start_matches('#')));
    target.unwrap_or(schema)
}

/// Returns the schema of the property whose former name is `key`.
fn by_former_name<'a>(key: &str, known: &'a Map<String, Json>) -> Option<&'a Json> {
    known.values().find(|schema| schema["formerly"] == key)
}

fn kind(schema: &Json) -> &str {
    match schema.get("type") {
        Some(Json::String(kind)) => kind,
        Some(Json::Array(kinds)) => kinds.first().and_then(Json::as_str).unwrap_or(""),
        _ => "",
    }
}

/// Returns whether the schema accepts the type `wanted`.
fn may_be(schema: &Json, wanted: &str) -> bool {
    let kinds = schema.get("type").and_then(Json::as_array);
    kind(schema) == wanted || kinds.is_some_and(|kinds| kinds.iter().any(|kind| kind == wanted))
}

/// Returns the words of an enumeration, if the schema is one.
fn words(schema: &Json) -> Option<Vec<&str>> {
    let alternatives = schema.get("oneOf").or(schema.get("enum"))?.as_array()?;
    Some(alternatives.iter().filter_map(|a| a.as_str().or(a.get("const")?.as_str())).collect())
}

/// Numbers that a schema accepts.
struct Numbers {
    /// Whether they have to be whole.
    whole: bool,
    range: RangeInclusive<f64>,
}

impl Numbers {
    /// Returns the numbers that a schema accepts, if it is one of numbers.
    fn of(schema: &Json) -> Option<Self> {
        let whole = match kind(schema) {
            "integer" => true,
            "number" => false,
            _ => return None,
        };
        let bound = |name| schema.get(name).and_then(Json::as_f64);
        let (least, most) = (bound("minimum"), bound("maximum"));
        let range = least.unwrap_or(f64::MIN)..=most.unwrap_or(f64::MAX);
        Some(Numbers { whole, range })
    }

    /// Returns whether `value` is one of them.
    fn contain(&self, value: &Value) -> bool {
        match value {
            Value::Integer(number) => self.range.contains(&(*number.value() as f64)),
            Value::Float(number) => !self.whole && self.range.contains(number.value()),
            _ => false,
        }
    }
}

/// Returns whether the schema accepts a list of this length.
fn has_length(found: usize, schema: &Json) -> bool {
    let bound = |name| schema.get(name).and_then(Json::as_u64);
    let (least, most) = (bound("minItems").unwrap_or(0), bound("maxItems").unwrap_or(u64::MAX));
    (least..=most).contains(&(found as u64))
}

/// Describes the lengths that a schema accepts.
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

/// Adds a position in the document to an error.
pub(super) fn located(input: Input, text: &str, span: Option<Range<usize>>) -> Input {
    match span {
        Some(span) => {
            let (line, column) = line_and_column(text, span.start);
            input.at(line, column)
        }
        None => input,
    }
}

/// Longest list that a message shows in full.
const LISTED: usize = 8;

/// Formats an item for a message.
pub(super) fn shown(item: &Item) -> String {
    item.as_value().map_or_else(|| "a table".to_owned(), shown_value)
}

fn shown_value(value: &Value) -> String {
    match value.as_array() {
        Some(list) if list.len() > LISTED => format!("a list of {}", list.len()),
        _ => value.to_string().trim().to_owned(),
    }
}
