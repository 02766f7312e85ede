//! Findings as text for a terminal.

use crate::text::table::{plain, table};

use super::finding::{Finding, tally};
use super::verdict::Verdict;

/// Columns of a line of words.
const WIDTH: usize = 79;
/// Columns of what is beside the names of rows, if it is in words.
const OURS: usize = 26;

/// A line for each item, and how many have which verdict.
pub fn overview(findings: &[Finding]) -> String {
    let rows = findings.iter().map(|one| {
        let (same, all) = one.score();
        let score = if all == 0 { String::new() } else { format!("{same} of {all}") };
        [one.id.clone(), one.verdict.words().to_owned(), score, shortened(&one.title)]
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
            reason => format!("\n{}\n", wrapped(reason, WIDTH)),
        };
        head + &rows(one) + &reason + &format!("\n{}\n", one.command)
    });
    each.collect::<Vec<_>>().join("\n") + &format!("\n{}\n", counts(findings))
}

fn rows(finding: &Finding) -> String {
    let rows: Vec<[String; 4]> = (finding.rows.iter())
        .map(|row| {
            let unit = if row.unit.is_empty() { String::new() } else { format!(" [{}]", row.unit) };
            let thesis = row.thesis.as_ref().map_or("-".to_owned(), |side| side.words());
            let verdict = row.verdict.map_or("", Verdict::words);
            let ours = wrapped(&row.ours.words(), OURS);
            [format!("{}{unit}", row.what), wrapped(&thesis, OURS), ours, verdict.to_owned()]
        })
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    let longest = |cell: &String| cell.lines().map(|line| line.chars().count()).max().unwrap_or(0);
    let width = |column: usize| rows.iter().map(|row| longest(&row[column])).max().unwrap_or(0);
    // Two blanks after each column, and one before the first.
    let left = WIDTH.saturating_sub((1..4).map(width).sum::<usize>() + 8).max(OURS);
    let rows = rows.iter().map(|row| {
        let [what, rest @ ..] = row.clone();
        let [thesis, ours, verdict] = rest;
        [wrapped(&what, left), thesis, ours, verdict]
    });
    format!("{}\n", table(["", "thesis", "here", ""], rows, ..0))
}

/// How many items have each verdict.
fn counts(findings: &[Finding]) -> String {
    let counts =
        tally(findings).map(|(verdict, count)| [count.to_string(), verdict.words().to_owned()]);
    plain(counts)
}

/// At most as much of a title as fits beside the rest.
fn shortened(title: &str) -> String {
    const MOST: usize = 30;
    match title.char_indices().nth(MOST) {
        None => title.to_owned(),
        Some((end, _)) => format!("{}...", title[..end].trim_end()),
    }
}

/// In lines that a terminal shows whole.
fn wrapped(words: &str, width: usize) -> String {
    let mut lines = vec![String::new()];
    for word in words.split_whitespace() {
        let last = lines.last().map_or(0, |line| line.chars().count());
        if last > 0 && last + 1 + word.chars().count() > width {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            *line += if line.is_empty() { "" } else { " " };
            *line += word;
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_words_are_broken_into_lines() {
        let text = wrapped(&"word ".repeat(40), WIDTH);
        assert!(
            text.lines().count() == 3 && text.lines().all(|line| line.len() <= WIDTH),
            "{text}"
        );
        assert_eq!(shortened("short"), "short");
        assert!(shortened(&"x".repeat(60)).ends_with("x..."));
    }
}
