//! The reports as a table, as JSON and as JUnit XML.

use std::io::stdout;
use std::path::Path;

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim_rtl::verify::cycle_counts::Count;
use tofsim_rtl::verify::{BlockReport, Verdict};

use crate::text::colour::coloured_ends;
use crate::text::junit::{self, JunitCase};
use crate::text::table::{grouped, table};

/// A line for each block, and the cycles around each first mismatch.
pub fn text(reports: &[BlockReport]) -> String {
    let rows = reports.iter().map(|report| {
        let (met, goals) = report.coverage;
        [
            report.name.clone(),
            grouped(report.cycles as u64),
            grouped(report.mismatches() as u64),
            if goals == 0 { "-".to_owned() } else { format!("{met} of {goals}") },
            verdict(report),
        ]
    });
    let header = ["block", "cycles", "mismatches", "stimulus goals", "verdict"];
    let table_of_all = table(header, rows, ..0);
    let words: Vec<_> = reports.iter().map(verdict).collect();
    let good = reports.iter().map(|report| !report.failed());
    let verdicts: Vec<_> = words.iter().map(String::as_str).zip(good).collect();
    let mut text = coloured_ends(&table_of_all, &verdicts, &stdout()) + "\n";
    for report in reports.iter().filter(|report| report.failed()) {
        text += &format!("\n{}: {}\n", report.name, report.fault());
        if !report.around.is_empty() {
            text += &format!("{}\n", around(report));
        }
        if let Some(wave) = &report.wave {
            text += &format!("both sides: {}\n", wave.display());
        }
    }
    text += &not_run(reports);
    let missed: Vec<_> = reports.iter().filter_map(missed).collect();
    match missed.as_slice() {
        [] => text,
        missed => format!(
            "{text}\n{}\nWhat was missed may be wrong unseen: more --cycles reach more.\n",
            missed.join("\n"),
        ),
    }
}

/// What was not run, a line for each reason.
fn not_run(reports: &[BlockReport]) -> String {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for report in reports {
        let Verdict::NotRun { reason } = &report.verdict else { continue };
        match reasons.iter_mut().find(|(other, _)| other == reason) {
            Some((_, names)) => names.push(&report.name),
            None => reasons.push((reason, vec![&report.name])),
        }
    }
    let line = |(reason, names): &(&str, Vec<&str>)| {
        format!("\nnot run: {}: {reason}\n", names.join(", "))
    };
    reasons.iter().map(line).collect()
}

/// How it came out, and whether the stimulus was too short to tell.
fn verdict(report: &BlockReport) -> String {
    let short = report.verdict == Verdict::Pass && !report.missed.is_empty();
    if short { "pass, goals missed".to_owned() } else { report.word().to_owned() }
}

/// What the stimulus has not reached, a line for each block.
fn missed(report: &BlockReport) -> Option<String> {
    let goal =
        |(what, missing, cases): &(&str, usize, usize)| format!("{what} ({missing} of {cases})");
    let goals: Vec<_> = report.missed.iter().map(goal).collect();
    let all = goals.join("; ");
    (!goals.is_empty()).then(|| format!("{}: goals of the stimulus missed: {all}", report.name))
}

/// The cycles around the first mismatch.
fn around(report: &BlockReport) -> String {
    let [head, rows @ ..] = report.around.as_slice() else { return String::new() };
    table(head, rows, ..0)
}

/// One object, `tofsim.verify/1`.
pub fn json(rtl: &str, simulator: &str, reports: &[BlockReport]) -> Value {
    let block = |report: &BlockReport| {
        let first = match &report.verdict {
            Verdict::Differs { first, .. } => json!(first),
            _ => Value::Null,
        };
        json!({
            "block": report.name,
            "verdict": report.word(),
            "cycles": report.cycles,
            "mismatches": report.mismatches(),
            "first": first,
            "fault": (report.verdict != Verdict::Pass).then(|| report.fault()),
            "waves": report.wave.as_ref().map(|path| path.display().to_string()),
            "goals": {"met": report.coverage.0, "of": report.coverage.1, "missed": missed(report)},
        })
    };
    json!({
        "schema": "tofsim.verify/1",
        "rtl": rtl,
        "simulator": simulator,
        "passed": !reports.iter().any(BlockReport::failed),
        "blocks": reports.iter().map(block).collect::<Vec<_>>(),
    })
}

/// Writes a test suite with a case for each block.
///
/// # Errors
/// When it cannot be put into XML, or the file cannot be written.
pub fn write_junit(path: &Path, simulator: &str, reports: &[BlockReport]) -> Result<()> {
    let case = |report: &BlockReport| JunitCase {
        name: report.name.clone(),
        failure: report.failed().then(|| (report.fault(), around(report))),
        skipped: matches!(report.verdict, Verdict::NotRun { .. }).then(|| report.fault()),
    };
    let suite = format!("tofsim verify {simulator}");
    junit::write(path, "tofsim verify", suite, reports.iter().map(case))
}

/// What, expected, counted twice, proven.
pub fn counts_text(counts: &[Count]) -> String {
    let number = |count: Option<u64>| count.map_or("never".to_owned(), |n| n.to_string());
    let rows = counts.iter().map(|count| {
        [
            count.what.clone(),
            count.expected.to_string(),
            count.unit.to_owned(),
            number(count.model),
            number(count.rtl),
            count.reason.as_ref().map_or("yes".to_owned(), |reason| format!("no: {reason}")),
        ]
    });
    let header = ["what", "expected", "unit", "Rust model", "RTL simulation", "proven"];
    let proofs: Vec<_> = counts.iter().map(|count| ("yes", count.proven)).collect();
    coloured_ends(&table(header, rows, ..0), &proofs, &stdout()) + "\n"
}

/// One object, `tofsim.cycle_counts/1`.
pub fn counts_json(rtl: &str, counts: &[Count]) -> Value {
    json!({
        "schema": "tofsim.cycle_counts/1",
        "rtl": rtl,
        "passed": counts.iter().all(Count::holds),
        "counts": counts,
    })
}
