//! Tables that are written row by row: Parquet and CSV.

pub mod parquet_file;
pub mod reader;

use serde::{Deserialize, Serialize};

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Field {
    /// Name.
    pub name: String,
    /// Type of its cells.
    pub kind: Kind,
}

/// Type of a column's cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Whole numbers from 0.
    Whole,
    /// Numbers.
    Number,
    /// Texts.
    Text,
}

/// A cell.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Cell {
    /// No value.
    #[default]
    None,
    /// A whole number.
    Whole(u64),
    /// A finite number.
    Number(f64),
    /// A text.
    Text(String),
}

/// A row.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Number of its point.
    pub point: u64,
    /// A cell for each column.
    pub cells: Vec<Cell>,
}

impl Row {
    /// Returns the cells as a CSV file has them.
    pub fn texts(&self) -> impl Iterator<Item = String> {
        self.cells.iter().map(Cell::text)
    }
}

impl Field {
    /// Creates a column.
    pub fn new(name: &str, kind: Kind) -> Field {
        Field { name: name.to_owned(), kind }
    }
}

/// Makes cells from values of these types.
macro_rules! cells {
    ($($type:ty, $value:ident => $cell:expr;)+) => {$(
        impl From<$type> for Cell {
            fn from($value: $type) -> Self {
                $cell
            }
        }
    )+};
}

cells! {
    f64, number => Cell::Number(number);
    i32, number => Cell::Number(number.into());
    u64, number => Cell::Whole(number);
    u32, number => Cell::Whole(number.into());
    usize, number => Cell::Whole(number as u64);
    String, text => Cell::Text(text);
    &str, text => Cell::Text(text.to_owned());
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Cell::None, Into::into)
    }
}

impl Cell {
    /// Creates a cell with a number, if there is one.
    pub fn number(value: Option<f64>) -> Cell {
        value.filter(|value| value.is_finite()).map_or(Cell::None, Cell::Number)
    }

    /// Returns the number in the cell, if there is one.
    pub fn as_number(&self) -> Option<f64> {
        match self {
            Cell::Whole(number) => Some(*number as f64),
            Cell::Number(number) => Some(*number),
            Cell::None | Cell::Text(_) => None,
        }
    }

    /// Formats the cell for CSV.
    pub fn text(&self) -> String {
        match self {
            Cell::None => String::new(),
            Cell::Whole(number) => number.to_string(),
            Cell::Number(number) => number.to_string(),
            Cell::Text(text) => text.clone(),
        }
    }
}
