//! The page to send to a colleague.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::files::output::write_bytes;
use tofsim::firmware::tof_top::FirmwareEstimator;

use crate::record::Record;
use crate::report::page::{Page, StepRow};

use super::journal::Journal;
use super::measured::{ACCURACY, FRAME};
use super::site::Site;
use super::step::{Outcome, Step};

/// Its file.
pub const FILE: &str = "report.html";

pub fn run(site: &Site, journal: &Journal) -> Result<Outcome> {
    let is_made = journal.is_whole(Step::Network);
    let setup = if is_made { site.with_network()? } else { site.setup.clone() };
    let mut notes: Vec<String> = site.notes.iter().map(|note| note.text.clone()).collect();
    if is_made && setup.scenario.estimator.kind == FirmwareEstimator::Network {
        notes = setup.notes()?.iter().map(ToString::to_string).collect();
    }
    let result = |step: Step| -> Value {
        let whole = journal.of(step).filter(|record| record.input.is_some());
        whole.map_or(Value::Null, |record| record.result.clone())
    };
    let evaluation = result(Step::Accuracy);
    let of_grid = evaluation["notes"].as_array().into_iter().flatten();
    let of_grid = of_grid.map(|note| {
        format!(
            "over the grid: {} = {}: {}",
            text(&note["key"]),
            text(&note["value"]),
            text(&note["text"])
        )
    });
    notes.extend(of_grid);
    let steps = Step::Report.needs().into_iter().map(|step| {
        let record = journal.of(step);
        StepRow {
            name: step.name(),
            about: step.about(),
            passed: record.is_some_and(|record| record.passed),
            summary: record.map_or("not done", |record| &record.summary).to_owned(),
        }
    });
    let picture = |path: PathBuf| std::fs::read_to_string(path).ok();
    let (words, ran) = (["build".to_owned(), site.scenario().to_owned()], result(Step::Frame));
    let page = Page {
        setup: &setup,
        record: Record::new(&setup, &words),
        quick: site.quick,
        notes,
        steps: steps.collect(),
        network: result(Step::Network),
        evaluation,
        errors: picture(
            Path::new(ACCURACY)
                .join(format!("{}_by_distance_m.svg", setup.params.estimator.estimator())),
        ),
        histogram: picture(Path::new(FRAME).join("histogram.svg")),
        frame: ran,
        cost: result(Step::Cost),
        verify: result(Step::Verify),
        cycles: result(Step::Cycles),
    };
    write_bytes(Path::new(FILE), page.html()?)?;
    let lacking = page.steps.iter().filter(|step| !step.passed).count();
    let summary = match lacking {
        0 => FILE.to_owned(),
        some => format!("{FILE}, without {some} of {} steps", page.steps.len()),
    };
    Ok(Outcome { outputs: vec![PathBuf::from(FILE)], result: json!({}), passed: true, summary })
}

fn text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
