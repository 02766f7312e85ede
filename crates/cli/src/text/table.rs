//! Plain tables and numbers for people, and colour for what matters most: green for what is well, red for what is not.

use std::io::IsTerminal;
use std::ops::RangeBounds;

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, Row, Table};

/// A table without borders; columns of `right`, counted from 0, are flush right.
pub fn table<R: Into<Row>>(
    header: impl Into<Row>,
    rows: impl IntoIterator<Item = R>,
    right: impl RangeBounds<usize>,
) -> String {
    aligned(header, rows, |column| right.contains(&column))
}

/// A table without borders; columns of which `is_right` says so are flush right.
pub fn aligned<R: Into<Row>>(
    header: impl Into<Row>,
    rows: impl IntoIterator<Item = R>,
    is_right: impl Fn(usize) -> bool,
) -> String {
    let mut table = Table::new();
    table.load_style(NOTHING).set_header(header).add_rows(rows);
    for (_, column) in table.column_iter_mut().enumerate().filter(|(k, _)| is_right(*k)) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.trim_fmt()
}

/// Columns of standard output: of its terminal, or 80 where it is none.
pub fn width() -> usize {
    const ELSEWHERE: usize = 80;
    let size = terminal_size::terminal_size_of(std::io::stdout());
    size.map_or(ELSEWHERE, |(width, _)| usize::from(width.0)).max(20)
}

/// A table, or several below each other that each begin with the first column, so that no line is
/// longer than `width` as long as two columns fit into it; all columns but the first are flush right.
pub fn fitted(header: &[String], rows: &[Vec<String>], width: usize) -> String {
    let mut tables = Vec::new();
    let mut shown = 1;
    while shown < header.len().max(2) {
        let of = |end: usize| {
            let cells = |row: &[String]| {
                let part = row.get(shown..end.min(row.len())).unwrap_or_default();
                row.iter().take(1).chain(part).cloned().collect::<Vec<_>>()
            };
            table(cells(header), rows.iter().map(|row| cells(row)), 1..)
        };
        let fits = |end: &usize| of(*end).lines().all(|line| line.chars().count() <= width);
        let end = (shown + 2..=header.len()).take_while(fits).last().unwrap_or(shown + 1);
        tables.push(of(end));
        shown = end;
    }
    tables.join("\n\n")
}

/// Rows without a header.
pub fn plain<R: Into<Row>>(rows: impl IntoIterator<Item = R>) -> String {
    Table::new().load_style(NOTHING).add_rows(rows).trim_fmt()
}

/// Names and what they stand for.
pub fn facts<N: Into<String>>(rows: impl IntoIterator<Item = (N, String)>) -> String {
    plain(rows.into_iter().map(|(name, value)| [name.into(), value]))
}

/// Formats a number with a fixed number of decimals. Zero has no sign, and nor does a number that rounds to it.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if is_zero(rest) => rest.to_owned(),
        _ => text,
    }
}

/// Formats a number as [`fixed`] does, with its sign; that of zero is `+`.
pub fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if is_zero(rest) => format!("+{rest}"),
        _ => text,
    }
}

fn is_zero(digits: &str) -> bool {
    digits.bytes().all(|digit| matches!(digit, b'0' | b'.'))
}

/// Formats a number as [`fixed`] does, or as a dash.
pub fn number_or_dash(value: Option<f64>, decimals: usize) -> String {
    value.map_or("-".to_owned(), |value| fixed(value, decimals))
}

/// Formats a number as [`signed`] does, or as a dash.
pub fn signed_or_dash(value: Option<f64>, decimals: usize) -> String {
    value.map_or("-".to_owned(), |value| signed(value, decimals))
}

/// A number with so many significant digits and at most so many decimals, without zeros at its end.
pub fn significant(number: f64, digits: i32, most: i32) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    let whole = number.abs().log10().floor() as i32 + 1;
    let decimals = (digits - whole).clamp(0, most) as usize;
    let text = format!("{number:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
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

/// A word in its colour, if `out` is a terminal that shows colours and the user does not mind.
pub fn coloured(word: &str, is_well: bool, out: &impl IsTerminal) -> String {
    paint(word, is_well, out.is_terminal() && is_wanted(|name| std::env::var(name).ok()))
}

/// A table with the last word of each row after its header in its colour.
pub fn coloured_ends(table: &str, rows: &[(&str, bool)], out: &impl IsTerminal) -> String {
    let mut rows = [None].into_iter().chain(rows.iter().map(Some));
    let lines = table.lines().map(|line| match rows.next().flatten() {
        Some((word, is_well)) if line.ends_with(word) => {
            format!("{}{}", &line[..line.len() - word.len()], coloured(word, *is_well, out))
        }
        _ => line.to_owned(),
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Whether the environment lets us (<https://no-color.org>).
fn is_wanted(variable: impl Fn(&str) -> Option<String>) -> bool {
    let is_dumb = variable("TERM").is_some_and(|terminal| terminal == "dumb");
    variable("NO_COLOR").is_none_or(|value| value.is_empty()) && !is_dumb
}

fn paint(word: &str, is_well: bool, with_colour: bool) -> String {
    let colour = if is_well { "32" } else { "31" };
    if with_colour { format!("\x1b[{colour}m{word}\x1b[0m") } else { word.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_has_no_minus() {
        let numbers = [-0.0, -0.004, -0.005001, 0.004, -12.0];
        assert_eq!(
            numbers.map(|number| fixed(number, 2)),
            ["0.00", "0.00", "-0.01", "0.00", "-12.00"]
        );
        assert_eq!(
            numbers.map(|number| signed(number, 2)),
            ["+0.00", "+0.00", "-0.01", "+0.00", "-12.00"]
        );
        assert_eq!([fixed(-0.4, 0), signed(-0.4, 0)], ["0", "+0"]);
        assert_eq!([number_or_dash(Some(-0.001), 2), signed_or_dash(None, 2)], ["0.00", "-"]);
    }

    #[test]
    fn a_table_that_is_too_wide_is_several() {
        let cells = |texts: &[&str]| texts.iter().map(|text| text.to_string()).collect::<Vec<_>>();
        let header = cells(&["name", "first", "second", "third"]);
        let rows = [cells(&["a", "1", "2", "3"]), cells(&["b", "10", "20", "30"])];
        let one = fitted(&header, &rows, 80);
        assert_eq!(one.lines().count(), 3);
        assert_eq!(one.lines().last().unwrap().split_whitespace().count(), 4);
        let longest = one.lines().map(|line| line.chars().count()).max().unwrap();
        assert_eq!(fitted(&header, &rows, longest), one);
        let several = fitted(&header, &rows, longest - 1);
        assert!(several.lines().all(|line| line.chars().count() < longest), "{several}");
        let tables: Vec<_> = several.split("\n\n").collect();
        assert_eq!(tables.len(), 2, "{several}");
        assert!(tables[1].trim_start().starts_with("name") && tables[1].contains("third"));
        // What never fits is shown all the same.
        assert_eq!(fitted(&header, &rows, 3).split("\n\n").count(), 3);
        assert!(fitted(&header[..1], &rows, 80).contains('b'));
    }

    #[test]
    fn thousands_are_set_apart() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_000), "1,000");
        assert_eq!(grouped(12_345_678), "12,345,678");
    }

    #[test]
    fn colours_are_for_terminals_whose_user_wants_them() {
        assert_eq!(paint("pass", true, true), "\x1b[32mpass\x1b[0m");
        assert_eq!(paint("differs", false, true), "\x1b[31mdiffers\x1b[0m");
        assert_eq!(paint("pass", true, false), "pass");
        let with = |set: &'static str, to: &'static str| {
            is_wanted(move |name| (name == set).then(|| to.to_owned()))
        };
        assert!(with("TERM", "xterm") && with("NO_COLOR", ""));
        assert!(!with("NO_COLOR", "1") && !with("TERM", "dumb"));
    }
}
