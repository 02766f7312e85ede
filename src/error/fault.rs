//! Error types, and their text.

use std::borrow::Cow;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use super::number::short_number;

/// An error that the user can act on. Every error sets exit status 2, except an interruption.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Invalid input.
    #[error("{0}")]
    Input(Box<Input>),
    /// Failed access to a file or directory.
    #[error("{}: cannot {action}: {source}", shortened(&path.display().to_string(), LONG_NAME))]
    Io {
        /// Path of the file or directory.
        path: PathBuf,
        /// Attempted action, as a verb: `read`, `write`, `create`.
        action: &'static str,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Interruption by the user (exit status 130).
    #[error("interrupted")]
    Interrupted,
}

/// Shorthand for results of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// An error in an input: its position, the value found and what was expected.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Input {
    /// Name of the file or the command-line option.
    pub source: String,
    /// Line and column, counted from 1.
    pub place: Option<(usize, usize)>,
    /// Field, row or key.
    pub field: Option<String>,
    /// Value found.
    pub value: Option<String>,
    /// Expected value, or description of the error.
    pub expected: String,
}

impl fmt::Display for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", shortened(&self.source, LONG_NAME))?;
        if let Some((line, column)) = self.place {
            write!(f, ":{line}:{column}")?;
        }
        let field = self.field.as_ref().map(|field| shortened(field, LONG_NAME));
        let value =
            self.value.as_deref().map(|value| if value.is_empty() { "\"\"" } else { value });
        match (field, value) {
            (Some(field), Some(value)) => write!(f, ": {field} = {value}")?,
            (Some(field), None) => write!(f, ": {field}")?,
            (None, Some(value)) => write!(f, ": {value}")?,
            (None, None) => {}
        }
        write!(f, ": {}", shortened(&self.expected, LONG_TEXT))
    }
}

/// Length beyond which a message shortens a value [characters].
const LONG_VALUE: usize = 60;
/// Length beyond which a message shortens the name of a file, an option or a field [characters].
const LONG_NAME: usize = 300;
/// Length beyond which a message shortens the expectation, which may quote the input [characters].
const LONG_TEXT: usize = 2000;

/// Returns a text, or its beginning and three dots if it has more than `most` characters.
pub fn shortened(text: &str, most: usize) -> Cow<'_, str> {
    match text.char_indices().nth(most) {
        None => Cow::Borrowed(text),
        Some((end, _)) => Cow::Owned(format!("{}...", &text[..end])),
    }
}

impl Input {
    /// Creates an error in `source`, the path of a file or a command-line option.
    pub fn new(source: impl fmt::Display, expected: impl fmt::Display) -> Self {
        let (source, expected) = (source.to_string(), expected.to_string());
        Input { source, expected, ..Input::default() }
    }

    /// Sets the position, counted from 1.
    pub fn at(self, line: usize, column: usize) -> Self {
        Input { place: Some((line, column)), ..self }
    }

    /// Sets the field, row or key.
    pub fn field(self, field: impl fmt::Display) -> Self {
        Input { field: Some(field.to_string()), ..self }
    }

    /// Prefixes the field with the key `above` that contains it.
    pub(crate) fn below(self, above: impl fmt::Display) -> Self {
        let field = self.field.as_ref().map_or(above.to_string(), |key| format!("{above}.{key}"));
        self.field(field)
    }

    /// Sets the value found; a long value is shortened.
    pub fn value(self, value: impl fmt::Display) -> Self {
        let value = short_number(&value.to_string()).into_owned();
        Input { value: Some(shortened(&value, LONG_VALUE).into_owned()), ..self }
    }
}

impl From<Input> for Error {
    fn from(input: Input) -> Self {
        Error::Input(Box::new(input))
    }
}

impl Error {
    /// Creates a function that converts an I/O error, for `map_err`.
    pub fn io(path: &Path, action: &'static str) -> impl FnOnce(io::Error) -> Error {
        let path = path.to_owned();
        move |source| Error::Io { path, action, source }
    }

    /// Returns whether the reader of standard output has closed it, which is not a failure.
    pub fn is_broken_pipe(&self) -> bool {
        matches!(self, Error::Io { source, .. } if source.kind() == io::ErrorKind::BrokenPipe)
    }
}

/// Converts a byte offset in `text` to line and column, counted from 1; columns count characters.
pub fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let before = &text[..text.floor_char_boundary(offset)];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

/// Returns the known name that is most similar to `name`, if one is similar enough.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let likeness = |known: &str| strsim::jaro_winkler(name, known);
    let scored = known.into_iter().map(|known| (likeness(known), known));
    let best = scored.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 > 0.75).then_some(best.1)
}

/// Formats a suggestion of the most similar known name, and the list of all known names.
pub fn hint<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> (String, String) {
    let known: Vec<_> = known.into_iter().collect();
    let meant = nearest(name, known.iter().copied());
    (meant.map_or(String::new(), |name| format!(" (`{name}`?)")), known.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_error_names_place_field_value_and_expectation() {
        let error = Input::new("a.toml", "expected metres").at(3, 7).field("target.d").value(-1);
        assert_eq!(error.to_string(), "a.toml:3:7: target.d = -1: expected metres");
    }

    #[test]
    fn no_part_of_a_message_is_longer_than_a_screen() {
        let long = "ü".repeat(50_000);
        let fault = Input::new(&long, &long).field(&long).value(&long);
        assert!(fault.to_string().chars().count() < 2_700);
        let missing = io::Error::from(io::ErrorKind::NotFound);
        let error = Error::io(Path::new(&long), "read")(missing).to_string();
        assert!(error.contains("ü...: cannot read") && error.len() < 1_000, "{error}");
        assert_eq!(shortened("as it is", 8), "as it is");
    }

    #[test]
    fn columns_count_characters() {
        assert_eq!(line_and_column("a\néb", 4), (2, 2));
        assert_eq!(line_and_column("", 0), (1, 1));
    }
}
