//! Walks a TOML text and says, for anything wrong in it, which field, where, and what was expected.

use std::fmt::Display;
use std::ops::RangeInclusive;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{Error, Input, Result, line_and_column, nearest};

/// The text and its name in messages.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub text: &'a str,
    pub name: &'a str,
}

/// A table whose keys are taken one by one; what is left over in the end is unknown.
pub(super) struct Table<'a> {
    source: Source<'a>,
    path: String,
    start: usize,
    entries: Vec<(&'a str, usize, &'a Spanned<DeValue<'a>>)>,
    known: Vec<&'static str>,
}

/// A value and the path of keys and indices that leads to it.
pub(super) struct Value<'a> {
    source: Source<'a>,
    path: String,
    value: &'a Spanned<DeValue<'a>>,
}

impl<'a> Source<'a> {
    /// The document's tree.
    pub fn parse(self) -> Result<Spanned<DeTable<'a>>> {
        DeTable::parse(self.text).map_err(|error| {
            let message = error.message().trim_end().replace('\n', ", ");
            let input = Input::new(self.name, format!("not TOML: {message}"));
            match error.span() {
                Some(span) => self.place(input, span.start),
                None => input.into(),
            }
        })
    }

    fn place(self, input: Input, offset: usize) -> Error {
        let (line, column) = line_and_column(self.text, offset);
        input.at(line, column).into()
    }
}

impl<'a> Table<'a> {
    /// The document's top table.
    pub fn root(source: Source<'a>, table: &'a Spanned<DeTable<'a>>) -> Self {
        Table::new(source, String::new(), 0, table.get_ref())
    }

    fn new(source: Source<'a>, path: String, start: usize, table: &'a DeTable<'a>) -> Self {
        let entries =
            table.iter().map(|(key, value)| (&**key.get_ref(), key.span().start, value)).collect();
        Table { source, path, start, entries, known: Vec::new() }
    }

    fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    /// Takes a key that may be absent.
    pub fn optional(&mut self, key: &'static str) -> Option<Value<'a>> {
        self.known.push(key);
        let found = self.entries.iter().position(|(name, ..)| *name == key)?;
        let (_, _, value) = self.entries.swap_remove(found);
        Some(Value { source: self.source, path: self.path_of(key), value })
    }

    /// Takes a key that has to be there.
    pub fn required(&mut self, key: &'static str) -> Result<Value<'a>> {
        self.optional(key).ok_or_else(|| {
            let missing = Input::new(self.source.name, "missing").field(self.path_of(key));
            self.source.place(missing, self.start)
        })
    }

    /// Refuses the keys that nobody took.
    pub fn finish(mut self) -> Result<()> {
        self.entries.sort_by_key(|&(_, start, _)| start);
        let Some(&(key, start, _)) = self.entries.first() else { return Ok(()) };
        let hint = match nearest(key, self.known.iter().copied()) {
            Some(near) => format!("; did you mean {near}?"),
            None => format!("; expected {}", self.known.join(", ")),
        };
        let unknown =
            Input::new(self.source.name, format!("unknown key{hint}")).field(self.path_of(key));
        Err(self.source.place(unknown, start))
    }
}

impl<'a> Value<'a> {
    /// An error that shows this value and says what was expected in its place.
    pub fn fault(&self, expected: impl Display) -> Error {
        let input = Input::new(self.source.name, expected).field(&self.path);
        let span = self.value.span();
        let input = match self.value.get_ref() {
            DeValue::Array(_) | DeValue::Table(_) => input,
            _ => input.value(self.source.text.get(span.clone()).unwrap_or_default()),
        };
        self.source.place(input, span.start)
    }

    /// As a table.
    pub fn table(self) -> Result<Table<'a>> {
        match self.value.get_ref() {
            DeValue::Table(table) => {
                Ok(Table::new(self.source, self.path, self.value.span().start, table))
            }
            _ => Err(self.fault("expected a table")),
        }
    }

    /// As an integer of that range.
    pub fn integer(&self, range: RangeInclusive<i64>, what: impl Display) -> Result<i64> {
        let number = self.value.get_ref().as_integer();
        number
            .and_then(|number| i64::from_str_radix(number.as_str(), number.radix()).ok())
            .filter(|integer| range.contains(integer))
            .ok_or_else(|| self.fault(what))
    }

    /// As a whole number from 0.
    pub fn natural(&self) -> Result<u64> {
        self.integer(0..=i64::MAX, "expected a whole number from 0").map(i64::unsigned_abs)
    }

    /// As that very integer.
    pub fn exactly(&self, integer: i64) -> Result<()> {
        self.integer(integer..=integer, format!("expected {integer}, as in the firmware")).map(drop)
    }

    /// As a finite number.
    pub fn number(&self) -> Result<f64> {
        let text = match self.value.get_ref() {
            DeValue::Float(number) => number.as_str(),
            DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
            _ => "",
        };
        let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
        number.ok_or_else(|| self.fault("expected a finite number"))
    }

    /// As a text.
    pub fn text(&self) -> Result<String> {
        let text = self.value.get_ref().as_str().map(str::to_owned);
        text.ok_or_else(|| self.fault("expected a text in quotes"))
    }

    /// As that very text.
    pub fn keyword(&self, word: &str) -> Result<()> {
        match self.value.get_ref().as_str() {
            Some(text) if text == word => Ok(()),
            _ => Err(self.fault(format!("expected \"{word}\""))),
        }
    }

    /// As a list.
    pub fn list(&self) -> Result<Vec<Value<'a>>> {
        let DeValue::Array(array) = self.value.get_ref() else {
            return Err(self.fault("expected a list"));
        };
        let item = |(place, value)| Value {
            source: self.source,
            path: format!("{}[{place}]", self.path),
            value,
        };
        Ok(array.iter().enumerate().map(item).collect())
    }

    /// As a list of `N` of `what`, each read by `read`.
    pub fn array<T, const N: usize>(
        &self,
        what: &str,
        read: impl FnMut(&Value<'a>) -> Result<T>,
    ) -> Result<[T; N]> {
        let items = self.many(what, N..=N, read)?;
        let found = items.len();
        items.try_into().map_err(|_| self.fault(format!("{found} {what}, expected {N}")))
    }

    /// As a list of so many of `what`, each read by `read`.
    pub fn many<T>(
        &self,
        what: &str,
        range: RangeInclusive<usize>,
        read: impl FnMut(&Value<'a>) -> Result<T>,
    ) -> Result<Vec<T>> {
        let items = self.list()?;
        if !range.contains(&items.len()) {
            let expected = match (range.start(), range.end()) {
                (least, most) if least == most => least.to_string(),
                (least, most) => format!("{least} to {most}"),
            };
            return Err(self.fault(format!("{} {what}, expected {expected}", items.len())));
        }
        items.iter().map(read).collect()
    }
}
