//! The table of a sweep, for people.

use tofsim_studies::Plan;
use tofsim_studies::header::header;
use tofsim_studies::table::{Cell, Field, Row};

use crate::text::table::{fitted, grouped, significant, width};

/// Rows that are printed; the files have all.
const SHOWN: usize = 36;
/// Digits of a number.
const DIGITS: i32 = 5;

/// The table, with each standard error beside its value; of `points` in all.
pub fn text(plan: &Plan, rows: &[Row], points: u64) -> String {
    let fields = header(plan);
    let (same, columns): (Vec<_>, Vec<_>) =
        columns(&fields, rows).into_iter().partition(|&(place, _)| is_same(rows, place));
    let head: Vec<_> = columns.iter().map(|(place, _)| fields[*place].name.clone()).collect();
    let cells = |row: &Row| {
        let cell = |&(place, se): &(usize, Option<usize>)| {
            let value = shown(&row.cells[place]);
            match se.map(|place| &row.cells[place]).and_then(Cell::as_number) {
                Some(se) => format!("{value} +-{se:.1e}"),
                None => value,
            }
        };
        columns.iter().map(cell).collect::<Vec<_>>()
    };
    let some: Vec<_> = rows.iter().take(SHOWN).map(cells).collect();
    let mut text = String::new();
    if !plan.file.description.is_empty() {
        text += &format!("{}\n", plan.file.description);
    }
    text += &format!(
        "plan {}, scenario {}, seed {}, {} points, {} x {} frames each\n\n",
        plan.name,
        plan.scenario,
        plan.seed,
        grouped(points),
        plan.file.repeats,
        plan.file.frames,
    );
    text += &fitted(&head, &some, width());
    text += "\n";
    for (place, _) in same {
        let value = rows.first().map_or(String::new(), |row| shown(&row.cells[place]));
        text += &format!("\n{} = {value} at all points", fields[place].name);
    }
    text += "\n";
    if points > some.len() as u64 {
        text += &format!(
            "\nand {} points more, which -o writes\n",
            grouped(points - some.len() as u64)
        );
    }
    text
}

/// Whether a column says the same of several rows.
fn is_same(rows: &[Row], place: usize) -> bool {
    let first = rows.first().map(|row| &row.cells[place]);
    rows.len() > 1 && rows.iter().all(|row| Some(&row.cells[place]) == first)
}

/// Returns the columns with values, each with that of its standard error.
fn columns(fields: &[Field], rows: &[Row]) -> Vec<(usize, Option<usize>)> {
    let place = |name: &str| fields.iter().position(|field| field.name == name);
    let shows = |place: &usize| {
        let name = &fields[*place].name;
        let is_se = name.strip_suffix("_se").is_some_and(|value| place_of(fields, value).is_some());
        let is_empty = |row: &Row| {
            matches!(&row.cells[*place], Cell::None) || row.cells[*place].text().is_empty()
        };
        !is_se && name != "seed" && !rows.iter().all(is_empty)
    };
    (0..fields.len()).filter(shows).map(|k| (k, place(&format!("{}_se", fields[k].name)))).collect()
}

fn place_of(fields: &[Field], name: &str) -> Option<usize> {
    fields.iter().position(|field| field.name == name)
}

/// A cell in five digits.
fn shown(cell: &Cell) -> String {
    let Cell::Number(number) = cell else { return cell.text() };
    match number.abs() {
        0.0 | 1e-4..1e6 => significant(*number, DIGITS, 8),
        _ => format!("{number:.3e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_in_five_digits() {
        for (number, text) in [
            (0.0, "0"),
            (0.35, "0.35"),
            (0.412_345_6, "0.41235"),
            (12.345_67, "12.346"),
            (123_456.7, "123457"),
            (1.84e-10, "1.840e-10"),
            (-2.5, "-2.5"),
        ] {
            assert_eq!(shown(&Cell::Number(number)), text);
        }
        assert_eq!(shown(&Cell::Whole(7)), "7");
        assert_eq!(shown(&Cell::None), "");
    }
}
