//! Text dumps that the designs print while a tool simulates them.

use std::fs;
use std::path::Path;

/// How a column states its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Digits of VHDL or Verilog, highest bit first.
    Bits,
    /// Signed decimal number, which may have a unit.
    Number,
    /// Position of a VHDL character.
    Character,
    /// Floating-point number with 17 digits.
    Real,
    /// Name of an enumeration's value, or text.
    Word,
    /// Number of events so far.
    Event,
}

/// A signal of the design.
#[derive(Clone, Debug)]
pub(super) struct Column {
    pub(super) kind: Kind,
    /// Declared indices of the highest and the lowest bit.
    pub(super) range: Option<[i64; 2]>,
    pub(super) name: String,
}

/// Cells of each instant with a change.
pub(super) struct Table {
    pub(super) columns: Vec<Column>,
    /// Times [ps], and a cell for each column.
    pub(super) rows: Vec<(u64, Vec<String>)>,
}

impl Table {
    /// Parses a file.
    pub(super) fn read(path: &Path) -> Table {
        let text = fs::read_to_string(path);
        let text = text.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut lines = text.lines();
        let (head, columns) = lines.next().unwrap().split_once(';').unwrap();
        assert_eq!(head, "time_ps");
        let columns: Vec<Column> = columns.split(';').map(Column::parse).collect();
        let rows = lines.map(|line| {
            let mut cells = line.split(';').map(str::to_owned);
            let time = cells.next().unwrap().parse().unwrap();
            let cells: Vec<String> = cells.collect();
            assert_eq!(cells.len(), columns.len(), "{}: {time} ps", path.display());
            (time, cells)
        });
        let rows = rows.collect();
        Table { columns, rows }
    }
}

impl Column {
    /// Returns its kind and name.
    pub(super) fn title(&self) -> String {
        format!("{} {}", format!("{:?}", self.kind).to_lowercase(), self.name)
    }

    /// Parses a kind, perhaps with a range, and a name: `bits[7:0] top.count`.
    fn parse(text: &str) -> Column {
        let (kind, name) = text.split_once(' ').unwrap();
        let (kind, range) = match kind.split_once('[') {
            Some((kind, range)) => {
                let (high, low) = range.trim_end_matches(']').split_once(':').unwrap();
                (kind, Some([high, low].map(|index| index.parse().unwrap())))
            }
            None => (kind, None),
        };
        let kind = match kind {
            "bits" => Kind::Bits,
            "number" => Kind::Number,
            "character" => Kind::Character,
            "real" => Kind::Real,
            "word" => Kind::Word,
            "event" => Kind::Event,
            other => panic!("{text}: unknown kind {other}"),
        };
        Column { kind, range, name: name.to_owned() }
    }
}
