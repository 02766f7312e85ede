//! Additional delays of the pixels' signal paths, from a CSV file with columns `row,column,offset_ps`.

use crate::error::Result;
use crate::files::csv::Header;

use super::builtin::Source;
use super::model::Scenario;
use super::pixel_values::{self, Values};

/// Columns of the file.
const HEADER: Header = &["row", "column", "offset_ps"];
/// Largest offset, the same as for `laser.delay_ps` [ps].
const MOST_PS: f64 = 1e6;

/// Loads the offset of every pixel, by row, then column, if the array names a file; its path is relative to `base` [ps].
///
/// # Errors
/// If the file cannot be read, lacks a pixel or has another array's, or if light would arrive before the laser edge.
pub fn load(scenario: &Scenario, base: &Source) -> Result<Vec<f64>> {
    let Some(name) = &scenario.array.offset_file else { return Ok(Vec::new()) };
    let (source, text) = base.read(name)?;
    parse(&source, &text, scenario.array.size(), scenario.laser.delay_ps)
}

fn parse(source: &str, text: &str, size: [usize; 2], delay_ps: f64) -> Result<Vec<f64>> {
    let least = -delay_ps;
    let expected = format!("expected {least} to {MOST_PS} [ps], {least} by laser.delay_ps");
    let values = Values { header: HEADER, range: least..=MOST_PS, expected };
    pixel_values::parse(source, text, size, &values)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(rows: &str) -> Result<Vec<f64>> {
        parse("o.csv", &format!("row,column,offset_ps\n{rows}"), [2, 2], 100.0)
    }

    #[test]
    fn every_pixel_has_an_offset_in_any_order() {
        let found = parsed("1,1,4\n0,0,-100\n0,1,2.5\n1,0,3\n").unwrap();
        assert_eq!(found, [-100.0, 2.5, 3.0, 4.0]);
    }

    #[test]
    fn faults_name_line_column_and_field() {
        let error = |rows: &str| parsed(rows).unwrap_err().to_string();
        assert_eq!(error("2,0,1\n"), "o.csv:2:1: row = 2: expected 0 to 1");
        assert_eq!(error("0,2,1\n"), "o.csv:2:3: column = 2: expected 0 to 1");
        let early = error("0,0,-101\n");
        assert!(early.starts_with("o.csv:2:5: offset_ps = -101: expected -100 to"), "{early}");
        assert!(error("0,0,NaN\n").contains("offset_ps = NaN"));
        let twice = error("0,1,1\n0,1,1\n");
        assert_eq!(twice, "o.csv:3:3: column = 1: expected each pixel once, row 0 has it already");
        let missing = error("0,0,1\n0,1,1\n1,0,1\n");
        assert!(missing.contains("missing = row 1, column 1: expected a line for each of 2 x 2"));
    }
}
