//! The page of what was found.

use crate::page::html::{
    Document, badge, commands, comparison, escaped, figure, section, tiles, wide_figure,
};
use crate::page::timing;
use crate::record::Record;

use super::finding::{Finding, tally};
use super::verdict::{RULE, Row, Verdict};

/// The whole page.
pub fn page(findings: &[Finding], record: &Record, quick: bool) -> String {
    let lead = "Tables and numbered figures of M. Chen, 1D time-of-flight LIDAR (master's thesis, TU Delft, 2022), made again \
                by this simulator.";
    let counts = tally(findings).map(|(verdict, count)| (verdict.words(), count.to_string()));
    let size = if quick {
        "<p class=\"bad\">This was a quick run: a tenth of the histograms, so that standard errors are three times those of a \
         full one.</p>\n"
    } else {
        ""
    };
    let about = format!(
        "{size}<p>{}</p>\n<p>Of a claim in words, \"here\" says by what one sees whether it holds. A verdict of an item is \
         that of its rows: one that differs is enough.</p>\n<p>Seed {}, scenario {}, hash {}, tofsim {}.</p>\n",
        escaped(RULE),
        record.seed,
        escaped(&record.scenario),
        escaped(&record.hash),
        escaped(&record.version),
    );
    let body = tiles(counts)
        + &section("How it is judged", &about)
        + &section("Contents", &contents(findings))
        + &findings.iter().map(item).collect::<String>();
    let title = "tofsim: the thesis's tables and figures";
    let heading = "The thesis, reproduced";
    Document { title, heading, lead, body, record }.html()
}

fn verdict(verdict: Verdict) -> String {
    badge(verdict.class(), &verdict.words())
}

fn contents(findings: &[Finding]) -> String {
    let line = |one: &Finding| {
        let (id, title) = (&one.id, escaped(&one.title));
        format!("<li>{}<a href=\"#{id}\">{id}</a> {title}</li>\n", verdict(one.verdict))
    };
    format!("<ul class=\"contents\">\n{}</ul>\n", findings.iter().map(line).collect::<String>())
}

fn item(finding: &Finding) -> String {
    let pictures: String = (finding.figures.iter())
        .map(|one| {
            let figure = if one.is_wide { wide_figure } else { figure };
            figure(&one.svg, &escaped(&one.words))
        })
        .collect();
    let traces: String = (finding.traces.iter())
        .map(|(words, trace)| figure(&timing::svg(trace), &escaped(words)))
        .collect();
    let reason = match finding.reason.as_str() {
        "" => String::new(),
        reason => format!("<p class=\"reason\">{}</p>\n", escaped(reason)),
    };
    let made_by: Vec<_> =
        [finding.command.clone()].into_iter().chain(finding.commands.clone()).collect();
    let made_by = if finding.rows.is_empty() { String::new() } else { commands(&made_by) };
    format!(
        "<section id=\"{id}\">\n<h3>{} {id}: {}</h3>\n{}{pictures}{traces}{reason}{made_by}</section>\n",
        verdict(finding.verdict),
        escaped(&finding.title),
        rows(&finding.rows),
        id = finding.id,
    )
}

fn rows(rows: &[Row]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let row = |row: &Row| {
        let [what, sides @ ..] = row.cells();
        let [thesis, ours] = sides.map(|words| words.replace("+-", "\u{b1}"));
        [what, thesis, ours, row.verdict.map_or(String::new(), verdict)]
    };
    comparison(["thesis", "here"], rows.iter().map(row))
}
