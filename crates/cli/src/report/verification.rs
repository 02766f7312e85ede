//! Verified blocks and cycle counts as tables, as JSON and as JUnit XML.

use std::io::stdout;
use std::path::Path;

use serde_json::{Value, json};

use tofsim::error::{Error, Input, Result};
use tofsim::{Note, NoteCode};
use tofsim_rtl::verify::cycle_counts::Count;
use tofsim_rtl::verify::{BlockReport, Verdict};

use crate::text::junit::{self, JunitCase, JunitOutcome};
use crate::text::table::{coloured_ends, grouped, table};

use super::sheet::Sheet;
use super::writer::Findings;

/// Blocks that were held to the golden vectors.
pub struct Verified<'a> {
    /// Source of the design.
    pub rtl: &'a str,
    /// Name of the simulator.
    pub simulator: &'static str,
    /// Report of each block.
    pub blocks: &'a [BlockReport],
}

/// Cycles that were counted in the model and in the design.
pub struct CycleCounts<'a> {
    /// Source of the design.
    pub rtl: &'a str,
    /// Each count.
    pub counts: &'a [Count],
}

/// Returns a line for each block, and the cycles around each first mismatch.
fn text(reports: &[BlockReport]) -> String {
    let table_of_all = Sheet::of(reports)
        .words("block", |report| report.name.as_str())
        .words("cycles", |report| grouped(report.cycles as u64))
        .words("mismatches", |report| grouped(report.mismatches() as u64))
        .words("stimulus goals", |report| match report.coverage {
            (_, 0) => "-".to_owned(),
            (met, goals) => format!("{met} of {goals}"),
        })
        .words("verdict", verdict)
        .table();
    let words: Vec<_> = reports.iter().map(verdict).collect();
    let good = reports.iter().map(BlockReport::is_good);
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
            "{text}\n{}\nFaults in the uncovered cases would go unnoticed; increase --cycles.\n",
            missed.join("\n"),
        ),
    }
}

/// Returns the blocks that were not run, a line for each reason.
fn not_run(reports: &[BlockReport]) -> String {
    let is_not_run = |report: &&BlockReport| matches!(report.verdict, Verdict::NotRun { .. });
    let reasons = by_reason(reports.iter().filter(is_not_run)).into_iter();
    reasons.map(|(reason, names)| format!("\nnot run: {names}: {reason}\n")).collect()
}

/// Returns an error for each reason for which blocks could not be checked, which names the blocks.
pub fn not_checked(reports: &[BlockReport]) -> Vec<Error> {
    let not = |report: &&BlockReport| matches!(report.verdict, Verdict::NotChecked { .. });
    let reasons = by_reason(reports.iter().filter(not)).into_iter();
    reasons
        .map(|(reason, names)| Input::new(names, format!("not checked: {reason}")).into())
        .collect()
}

/// Returns the note on an input that nothing drives, of the design's module for a block.
pub fn open_input(block: &str, input: &str) -> Note {
    let key = format!("block.{block}.tie.{input}");
    let text = "nothing drives this input, which tofsim's block does not have";
    Note::new(NoteCode::OpenInput, key, "open", "a constant in the map", text)
}

/// Returns the notes on some blocks, each once whatever configurations were checked.
pub fn notes(reports: &[BlockReport]) -> Vec<Note> {
    let mut notes = Vec::new();
    for report in reports {
        let block = report.name.split('.').next().unwrap_or_default();
        for note in report.open.iter().map(|input| open_input(block, input)) {
            if !notes.contains(&note) {
                notes.push(note);
            }
        }
    }
    notes
}

/// Returns the faults of some blocks, each with the names of the blocks that have it.
fn by_reason<'a>(reports: impl Iterator<Item = &'a BlockReport>) -> Vec<(String, String)> {
    let mut reasons: Vec<(String, String)> = Vec::new();
    for report in reports {
        let reason = report.fault();
        match reasons.iter_mut().find(|(other, _)| *other == reason) {
            Some((_, names)) => *names += &format!(", {}", report.name),
            None => reasons.push((reason, report.name.clone())),
        }
    }
    reasons
}

/// Returns the verdict, and whether the stimulus was too short.
fn verdict(report: &BlockReport) -> String {
    let short = report.verdict == Verdict::Pass && !report.missed.is_empty();
    if short { "pass, goals missed".to_owned() } else { report.word().to_owned() }
}

/// Returns the goals that the stimulus of a block has missed.
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

impl Findings for Verified<'_> {
    const SCHEMA: &'static str = "tofsim.verify/1";

    fn json(&self) -> Value {
        let block = |report: &BlockReport| {
            let first = match &report.verdict {
                Verdict::Differs { first, .. } => json!(first),
                _ => Value::Null,
            };
            let (met, of) = report.coverage;
            json!({
                "block": report.name,
                "verdict": report.word(),
                "cycles": report.cycles,
                "mismatches": report.mismatches(),
                "first": first,
                "fault": (report.verdict != Verdict::Pass).then(|| report.fault()),
                "waves": report.wave.as_ref().map(|path| path.display().to_string()),
                "goals": { "met": met, "of": of, "missed": missed(report) },
            })
        };
        let mut object = json!({
            "rtl": self.rtl,
            "simulator": self.simulator,
            "passed": self.blocks.iter().all(BlockReport::is_good),
            "blocks": self.blocks.iter().map(block).collect::<Vec<_>>(),
        });
        let notes = notes(self.blocks);
        if !notes.is_empty() {
            object["notes"] = json!(notes);
        }
        object
    }

    fn text(&self) -> String {
        text(self.blocks)
    }
}

/// Writes a test suite with a case for each block.
///
/// # Errors
/// When it cannot be put into XML, or the file cannot be written.
pub fn write_junit(path: &Path, simulator: &str, reports: &[BlockReport]) -> Result<()> {
    let case = |report: &BlockReport| JunitCase {
        name: report.name.clone(),
        outcome: match &report.verdict {
            Verdict::Pass => JunitOutcome::Success,
            Verdict::NotRun { reason } => JunitOutcome::Skipped(reason.clone()),
            Verdict::NotChecked { reason } => JunitOutcome::Error(reason.clone()),
            _ => JunitOutcome::Failure(report.fault(), around(report)),
        },
    };
    let suite = format!("tofsim verify {simulator}");
    junit::write(path, "tofsim verify", suite, reports.iter().map(case))
}

impl Findings for CycleCounts<'_> {
    const SCHEMA: &'static str = "tofsim.cycle_counts/1";

    fn json(&self) -> Value {
        let passed = self.counts.iter().all(Count::holds);
        json!({ "rtl": self.rtl, "passed": passed, "counts": self.counts })
    }

    fn text(&self) -> String {
        let number = |count: Option<u64>| count.map_or("never".to_owned(), |n| n.to_string());
        let table = Sheet::of(self.counts)
            .words("what", |count| count.what.as_str())
            .words("expected", |count| count.expected)
            .words("unit", |count| count.unit)
            .words("Rust model", |count| number(count.model))
            .words("RTL simulation", |count| number(count.rtl))
            .words("proven", |count| match &count.reason {
                None => "yes".to_owned(),
                Some(reason) => format!("no: {reason}"),
            })
            .table();
        let proofs: Vec<_> = self.counts.iter().map(|count| ("yes", count.proven)).collect();
        coloured_ends(&table, &proofs, &stdout()) + "\n"
    }
}
