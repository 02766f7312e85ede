//! Plain tables, and numbers for people.

use std::ops::RangeBounds;

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, Row, Table};

/// A table without borders; columns of `right`, counted from 0, are flush right.
pub fn table<R: Into<Row>>(
    header: impl Into<Row>,
    rows: impl IntoIterator<Item = R>,
    right: impl RangeBounds<usize>,
) -> String {
    let mut table = Table::new();
    table.load_style(NOTHING).set_header(header).add_rows(rows);
    for (_, column) in table.column_iter_mut().enumerate().filter(|(k, _)| right.contains(k)) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.trim_fmt()
}

/// Rows without a header.
pub fn plain<R: Into<Row>>(rows: impl IntoIterator<Item = R>) -> String {
    Table::new().load_style(NOTHING).add_rows(rows).trim_fmt()
}

/// Names and what they stand for.
pub fn facts<N: Into<String>>(rows: impl IntoIterator<Item = (N, String)>) -> String {
    plain(rows.into_iter().map(|(name, value)| [name.into(), value]))
}

/// A number with so many decimals, or a dash.
pub fn number_or_dash(value: Option<f64>, decimals: usize) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.decimals$}"))
}

/// A number with its thousands apart.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy);
    groups.collect::<Vec<_>>().join(",")
}

/// A number of things, of which one is called so without its last letter.
pub fn counted(count: u64, things: &str) -> String {
    let things = if count == 1 { things.trim_end_matches('s') } else { things };
    format!("{} {things}", grouped(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_set_apart() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_000), "1,000");
        assert_eq!(grouped(12_345_678), "12,345,678");
    }
}
