//! Findings as text for a terminal.

use comfy_table::presets::NOTHING;
use comfy_table::{ContentArrangement, Table};

use crate::text::table::{plain, table};

use super::finding::{Finding, tally};
use super::verdict::{Row, Verdict};

/// Columns of a line.
const WIDTH: u16 = 79;

/// A line for each item, and how many have which verdict.
pub fn overview(findings: &[Finding]) -> String {
    let rows = findings.iter().map(|one| {
        let (same, all) = one.score();
        let score = if all == 0 { String::new() } else { format!("{same} of {all}") };
        [one.id.clone(), one.verdict.words(), score, shortened(&one.title)]
    });
    format!(
        "{}\n\n{}\n",
        table(["item", "verdict", "same", "what it shows"], rows, ..0),
        counts(findings)
    )
}

/// All rows of each item, with the reason.
pub fn in_full(findings: &[Finding]) -> String {
    let each = findings.iter().map(|one| {
        let head = format!("{}: {} -- {}\n", one.id, one.title, one.verdict.words());
        let reason = match one.reason.as_str() {
            "" => String::new(),
            reason => format!("\n{}\n", wrapped().add_row([reason]).trim_fmt()),
        };
        head + &rows(one) + &reason + &format!("\n{}\n", one.command)
    });
    each.collect::<Vec<_>>().join("\n") + &format!("\n{}\n", counts(findings))
}

fn rows(finding: &Finding) -> String {
    let row = |row: &Row| {
        let [what, thesis, ours] = row.cells();
        [what, thesis, ours, row.verdict.map_or(String::new(), Verdict::words)]
    };
    match finding.rows.as_slice() {
        [] => String::new(),
        rows => format!(
            "{}\n",
            wrapped()
                .set_header(["", "thesis", "here", ""])
                .add_rows(rows.iter().map(row))
                .trim_fmt()
        ),
    }
}

/// An empty table whose cells are wrapped, so that a terminal shows it whole.
fn wrapped() -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING).set_content_arrangement(ContentArrangement::Dynamic).set_width(WIDTH);
    table
}

/// Formats the number of items of each verdict.
fn counts(findings: &[Finding]) -> String {
    plain(tally(findings).map(|(verdict, count)| [count.to_string(), verdict.words()]))
}

/// At most as much of a title as fits beside the rest.
fn shortened(title: &str) -> String {
    const MOST: usize = 30;
    match title.char_indices().nth(MOST) {
        None => title.to_owned(),
        Some((end, _)) => format!("{}...", title[..end].trim_end()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_words_are_broken_into_lines() {
        let text = wrapped().add_row(["word ".repeat(40)]).trim_fmt();
        let fits = text.lines().all(|line| line.len() <= usize::from(WIDTH));
        assert!(text.lines().count() == 3 && fits, "{text}");
        assert_eq!(shortened("short"), "short");
        assert!(shortened(&"x".repeat(60)).ends_with("x..."));
    }
}
