//! A table of rows that come in order: Parquet and CSV.

pub mod csv_file;
pub mod parquet_file;
pub mod reader;

use serde::{Deserialize, Serialize};

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// What its cells hold.
    pub kind: Kind,
}

/// What the cells of a column hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Whole numbers from 0.
    Whole,
    /// Numbers.
    Number,
    /// Words.
    Text,
}

/// A cell.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Cell {
    /// Nothing.
    #[default]
    None,
    /// A whole number.
    Whole(u64),
    /// A finite number.
    Number(f64),
    /// Words.
    Text(String),
}

/// A row.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its point.
    pub point: u64,
    /// A cell for each column.
    pub cells: Vec<Cell>,
}

impl Field {
    /// A column of that name.
    pub fn new(name: &str, kind: Kind) -> Field {
        Field { name: name.to_owned(), kind }
    }
}

impl Cell {
    /// A number, if it is one.
    pub fn number(value: Option<f64>) -> Cell {
        value.filter(|value| value.is_finite()).map_or(Cell::None, Cell::Number)
    }

    /// The number in it.
    pub fn as_number(&self) -> Option<f64> {
        match self {
            Cell::Whole(number) => Some(*number as f64),
            Cell::Number(number) => Some(*number),
            Cell::None | Cell::Text(_) => None,
        }
    }

    /// As a CSV file has it.
    pub fn text(&self) -> String {
        match self {
            Cell::None => String::new(),
            Cell::Whole(number) => number.to_string(),
            Cell::Number(number) => number.to_string(),
            Cell::Text(text) => text.clone(),
        }
    }
}
