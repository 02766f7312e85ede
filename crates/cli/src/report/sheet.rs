//! Tables of results: aligned columns for people, CSV for files.

use tofsim_studies::table::Cell;

use crate::text::table::{self, fixed};

/// Number format of a column.
#[derive(Clone, Copy, Debug)]
pub enum Digits {
    /// As many digits as tell the number from every other.
    Shortest,
    /// The same, with a point or an exponent in every number.
    Literal,
    /// A fixed number of decimals.
    Fixed(usize),
    /// A mantissa with a fixed number of decimals, and a power of ten.
    Scientific(usize),
}

/// The text of a file, after its name.
pub type NamedText = (String, String);
/// The bytes of a file, after its name.
pub type NamedBytes = (String, Vec<u8>);

/// A table with a row for each item of a slice: of some columns as CSV, of some for people.
pub struct Sheet<'a, R> {
    rows: &'a [R],
    columns: Vec<Column>,
}

struct Column {
    /// Name in the file, which ends with the unit; `None` if people alone see the column.
    name: Option<String>,
    digits: Digits,
    /// Heading in the table and the digits there; `None` if the file alone has the column.
    shown: Option<(String, Digits)>,
    cells: Vec<Cell>,
}

impl<'a, R> Sheet<'a, R> {
    /// Creates a table without columns.
    pub fn of(rows: &'a [R]) -> Self {
        Sheet { rows, columns: Vec::new() }
    }

    /// Adds a column of the file.
    pub fn column<C: Into<Cell>>(
        self,
        name: impl Into<String>,
        digits: Digits,
        value: impl Fn(&'a R) -> C,
    ) -> Self {
        self.with(Some(name.into()), digits, None, value)
    }

    /// Adds a column of the file and of the table, with the digits in each.
    pub fn both<C: Into<Cell>>(
        self,
        (name, digits): (&str, Digits),
        (heading, shown): (&str, Digits),
        value: impl Fn(&'a R) -> C,
    ) -> Self {
        debug_assert!(has_unit_of(heading, name), "{heading}: another unit than {name}");
        self.with(Some(name.to_owned()), digits, Some((heading.to_owned(), shown)), value)
    }

    /// Adds a column that people alone see.
    pub fn words<C: Into<Cell>>(
        self,
        heading: impl Into<String>,
        value: impl Fn(&'a R) -> C,
    ) -> Self {
        self.with(None, Digits::Shortest, Some((heading.into(), Digits::Shortest)), value)
    }

    fn with<C: Into<Cell>>(
        mut self,
        name: Option<String>,
        digits: Digits,
        shown: Option<(String, Digits)>,
        value: impl Fn(&'a R) -> C,
    ) -> Self {
        let cells = self.rows.iter().map(|row| value(row).into()).collect();
        self.columns.push(Column { name, digits, shown, cells });
        self
    }

    /// Adds the columns of another table of the same rows.
    pub fn and(mut self, other: Self) -> Self {
        self.columns.extend(other.columns);
        self
    }

    /// Returns the CSV file: a header, and a line for each row. What has no value is empty.
    pub fn csv(&self) -> String {
        let columns = || self.columns.iter().filter_map(|one| Some((one.name.as_ref()?, one)));
        let mut writer = csv::Writer::from_writer(Vec::new());
        // Writing to memory does not fail.
        let _ = writer.write_record(columns().map(|(name, _)| name));
        for row in 0..self.rows.len() {
            let cells = columns().map(|(_, one)| written(&one.cells[row], one.digits));
            let _ = writer.write_record(cells);
        }
        String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
    }

    /// Returns the CSV file with its name.
    pub fn file(&self, name: &str) -> NamedText {
        (name.to_owned(), self.csv())
    }

    /// Returns the table for people.
    pub fn table(&self) -> String {
        self.table_of(0..self.rows.len())
    }

    /// Returns some rows of the table for people, by their places. What has no value is a dash.
    pub fn table_of(&self, places: impl IntoIterator<Item = usize>) -> String {
        let columns = || self.columns.iter().filter_map(|one| Some((one.shown.as_ref()?, one)));
        let rows = places.into_iter().map(|row| {
            let cell = |((_, digits), one): (&(String, Digits), &Column)| match &one.cells[row] {
                Cell::None => "-".to_owned(),
                cell => written(cell, *digits),
            };
            columns().map(cell).collect::<Vec<_>>()
        });
        let is_left: Vec<_> = columns().enumerate().map(|(k, (_, one))| one.is_left(k)).collect();
        let header: Vec<_> = columns().map(|((heading, _), _)| heading.clone()).collect();
        table::aligned(header, rows, |column| !is_left[column])
    }
}

impl Column {
    /// Returns whether the column's cells are words; all texts of the first column are.
    fn is_left(&self, place: usize) -> bool {
        let is_word = |cell: &Cell| match cell {
            Cell::Text(text) => place == 0 || text == "-" || text.starts_with(char::is_alphabetic),
            Cell::None => true,
            Cell::Whole(_) | Cell::Number(_) => false,
        };
        self.cells.iter().all(is_word)
    }
}

/// Returns the places of at most `most` of `count` rows, evenly chosen, with the first and the last.
pub fn evenly(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let steps = count.min(most).saturating_sub(1);
    (0..count.min(most)).map(move |k| (k * (count - 1)).checked_div(steps).unwrap_or(0))
}

fn written(cell: &Cell, digits: Digits) -> String {
    let Cell::Number(number) = cell else { return cell.text() };
    match digits {
        Digits::Shortest => number.to_string(),
        Digits::Literal => format!("{number:?}"),
        Digits::Fixed(decimals) => fixed(*number, decimals),
        Digits::Scientific(decimals) => format!("{number:.decimals$e}"),
    }
}

/// Whether the unit in brackets of a heading, if there is one, is that in the name of the column.
fn has_unit_of(heading: &str, name: &str) -> bool {
    let unit = heading.split_once('[').and_then(|(_, rest)| rest.strip_suffix(']'));
    let ends = |unit: &str| match unit {
        "degC" => "_c".to_owned(),
        "1/s" => "_hz".to_owned(),
        unit => format!("_{}", unit.to_lowercase().replace('^', "")),
    };
    unit.is_none_or(|unit| name.ends_with(&ends(unit)))
}

#[cfg(test)]
mod tests {
    use super::Digits::{Fixed, Shortest};
    use super::*;

    const ROWS: [(&str, Option<f64>, u64); 2] = [("a, b", Some(0.125), 7), ("c", None, 12_000)];

    fn sheet() -> Sheet<'static, (&'static str, Option<f64>, u64)> {
        Sheet::of(&ROWS)
            .both(("name", Shortest), ("name", Shortest), |row| row.0)
            .both(("width_ps", Fixed(4)), ("width [ps]", Fixed(1)), |row| row.1)
            .column("count", Digits::Shortest, |row| row.2)
            .words("of all", |row| format!("{} of 2", row.2))
    }

    #[test]
    fn a_file_and_a_table_have_the_same_values_in_columns_of_their_own() {
        assert_eq!(sheet().csv(), "name,width_ps,count\n\"a, b\",0.1250,7\nc,,12000\n");
        let table = sheet().table();
        let lines: Vec<_> = table.lines().map(|line| line.trim()).collect();
        assert_eq!(lines[0], "name  width [ps]      of all");
        assert_eq!(lines[1], "a, b         0.1      7 of 2");
        assert_eq!(lines[2], "c              -  12000 of 2");
        assert_eq!(sheet().table_of([1]).lines().count(), 2);
    }

    #[test]
    #[should_panic(expected = "another unit")]
    fn a_heading_has_the_unit_of_its_column() {
        sheet().both(("width_ns", Shortest), ("width [ps]", Shortest), |row| row.2);
    }

    #[test]
    fn numbers_are_written_as_their_column_says() {
        let one = |digits| Sheet::of(&[5.0]).column("x", digits, |x| *x).csv();
        assert_eq!(one(Digits::Shortest), "x\n5\n");
        assert_eq!(one(Digits::Literal), "x\n5.0\n");
        assert_eq!(one(Digits::Fixed(2)), "x\n5.00\n");
        assert_eq!(one(Digits::Scientific(3)), "x\n5.000e0\n");
    }

    #[test]
    fn rows_are_chosen_evenly_with_both_ends() {
        let all = |count, most| evenly(count, most).collect::<Vec<_>>();
        assert_eq!(all(3, 16), [0, 1, 2]);
        assert_eq!(all(101, 5), [0, 25, 50, 75, 100]);
        assert_eq!((all(1, 4), all(0, 4)), (vec![0], vec![]));
    }
}
