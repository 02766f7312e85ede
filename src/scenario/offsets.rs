//! Additional delays of the pixels' signal paths, from a CSV file with columns `row,column,offset_ps`.

use crate::error::{Input, Result};
use crate::files::csv::CsvInput;

use super::builtin::Source;
use super::model::Scenario;

/// Columns of the file.
const HEADER: [&str; 3] = ["row", "column", "offset_ps"];
/// Largest offset, the same as for `laser.delay_ps` [ps].
const MOST_PS: f64 = 1e6;

/// Loads the offset of every pixel, by row, then column, if the array names a file; its path is relative to `base` [ps].
///
/// # Errors
/// If the file cannot be read, lacks a pixel or has another array's, or if light would arrive before the laser edge.
pub fn load(scenario: &Scenario, base: &Source) -> Result<Vec<f64>> {
    let Some(name) = &scenario.array.offset_file else { return Ok(Vec::new()) };
    let (source, text) = base.read(name)?;
    let size = [scenario.array.rows, scenario.array.columns].map(|count| count as usize);
    parse(&source, &text, size, scenario.laser.delay_ps)
}

fn parse(source: &str, text: &str, [rows, columns]: [usize; 2], delay_ps: f64) -> Result<Vec<f64>> {
    let mut input = CsvInput::new(source, text, &HEADER)?;
    let mut offsets = vec![None; rows * columns];
    while input.advance()? {
        let [row, column] = [input.place(0, rows)?, input.place(1, columns)?];
        let in_range = |offset: &f64| (-delay_ps..=MOST_PS).contains(offset);
        let offset = input.field::<f64>(2).filter(in_range).ok_or_else(|| {
            let least = -delay_ps;
            input.fault(2, format!("expected {least} to {MOST_PS} [ps], {least} by laser.delay_ps"))
        })?;
        if offsets[row * columns + column].replace(offset).is_some() {
            let expected = format!("expected each pixel once, row {row} has it already");
            return Err(input.fault(1, expected).into());
        }
    }
    let lacks = |place: usize| {
        let expected = format!(
            "expected a line for each of {rows} x {columns} pixels (array.rows, array.columns)"
        );
        let missing = format!("row {}, column {}", place / columns, place % columns);
        Input::new(source, expected).field("missing").value(missing)
    };
    let whole =
        offsets.iter().enumerate().map(|(place, offset)| offset.ok_or_else(|| lacks(place)));
    Ok(whole.collect::<std::result::Result<_, _>>()?)
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
