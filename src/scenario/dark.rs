//! Measured dark count rates of the SPAD array, from a CSV file with columns `row,output,rate_hz`, at 20 deg C.

use crate::error::Result;
use crate::files::csv::CsvInput;

use super::builtin::Source;
use super::model::{Array, Scenario};
use super::wiring::{OUTPUTS, ROWS, SELECTED};

/// Columns of the file.
const HEADER: [&str; 3] = ["row", "output", "rate_hz"];
/// Upper limit of a rate, the same as for `spad.dark_rate_hz` [1/s].
const MOST_HZ: f64 = 1e9;

/// Measured dark count rates of an array; `None` for outputs that the file does not list [1/s].
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Number of outputs of a row.
    columns: usize,
    rates: Vec<Option<f64>>,
}

impl Measured {
    /// Returns the rates of the selected row [1/s].
    pub fn selected(&self) -> &[Option<f64>] {
        &self.rates[SELECTED * self.columns..][..self.columns]
    }

    /// Returns the rate of an output, if the file lists it [1/s].
    pub fn rate(&self, row: usize, output: usize) -> Option<f64> {
        self.rates[row * self.columns + output]
    }
}

/// Loads the dark count rates, if the detector names a file. Its path is relative to `base`.
///
/// # Errors
/// If the file cannot be read, or a row is invalid.
pub fn load(scenario: &Scenario, base: &Source) -> Result<Option<Measured>> {
    let Some(name) = &scenario.spad.dark_file else { return Ok(None) };
    let (source, text) = base.read(name)?;
    let Array { rows, columns, .. } = scenario.array;
    let size = [ROWS.max(rows as usize), OUTPUTS.max(columns as usize)];
    parse(&source, &text, size).map(Some)
}

fn parse(source: &str, text: &str, [rows, columns]: [usize; 2]) -> Result<Measured> {
    let mut input = CsvInput::new(source, text, &HEADER)?;
    let mut rates = vec![None; rows * columns];
    while input.advance()? {
        let [row, output] = [input.place(0, rows)?, input.place(1, columns)?];
        let rate_hz = input.field::<f64>(2).filter(|rate| (0.0..=MOST_HZ).contains(rate));
        let expected = "expected a rate from 0 to 1e9 [1/s]";
        let rate_hz = rate_hz.ok_or_else(|| input.fault(2, expected))?;
        if rates[row * columns + output].replace(rate_hz).is_some() {
            let expected = format!("expected each output once, row {row} has it already");
            return Err(input.fault(1, expected).into());
        }
    }
    Ok(Measured { columns, rates })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(source: &str, text: &str) -> Result<Measured> {
        super::parse(source, text, [ROWS, OUTPUTS])
    }

    #[test]
    fn the_selected_row_is_taken_and_what_is_not_named_is_not_known() {
        let text = "# of chip 7\nrow,output,rate_hz\n0,15,250.5\n39,15,7\n0,0,0\n";
        let found = parse("d.csv", text).unwrap();
        let row = found.selected();
        assert_eq!((row[15], row[0], row[14]), (Some(250.5), Some(0.0), None));
        assert_eq!((found.rate(39, 15), found.rate(0, 15)), (Some(7.0), Some(250.5)));
        assert_eq!(parse("d.csv", "row,output,rate_hz\n").unwrap().selected(), [None; OUTPUTS]);
    }

    #[test]
    fn faults_are_named_by_line_column_and_field() {
        let error = |rows: &str| {
            parse("d.csv", &format!("row,output,rate_hz\n{rows}")).unwrap_err().to_string()
        };
        assert_eq!(error("40,0,1\n"), "d.csv:2:1: row = 40: expected 0 to 39");
        assert_eq!(error("0,0,1\n0,30,1\n"), "d.csv:3:3: output = 30: expected 0 to 29");
        let expected = "d.csv:2:5: rate_hz = -1: expected a rate from 0 to 1e9 [1/s]";
        assert_eq!(error("0,1,-1\n"), expected);
        assert!(error("0,1,NaN\n").contains("rate_hz = NaN"));
        assert!(error("0,1,1e10\n").contains("rate_hz = 1e10"));
        assert!(error("-1,1,1\n").contains("row = -1"));
        assert!(error("0,1.5,1\n").contains("output = 1.5"));
        let twice = error("3,7,1\n3,8,1\n3,7,2\n");
        assert_eq!(twice, "d.csv:4:3: output = 7: expected each output once, row 3 has it already");
        assert!(error("0,1\n").contains("has 2 fields, expected 3"));
        assert!(parse("d.csv", "output,rate_hz\n").unwrap_err().to_string().contains("header"));
        assert!(parse("d.csv", "").is_err());
    }
}
