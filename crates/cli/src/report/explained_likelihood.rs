//! The stages of the likelihood estimator as a table: integers beside double precision.

use tofsim::firmware::tof_top::status::StatusSet;
use tofsim_learn::quantize::ExplainedLikelihood;
use tofsim_learn::quantize::likelihood::StageValue;

use crate::text::table::table;

/// Numbers from here on are shown as a mantissa and a power of ten.
const MOST: f64 = 1e6;

/// The table, with what the status says.
pub fn text(explained: &ExplainedLikelihood) -> String {
    let stages = || explained.values.iter().map(|value| &value.stage);
    let before = [None].into_iter().chain(stages().map(Some));
    let rows = explained.values.iter().zip(before).map(|(value, before)| {
        let stage = if before == Some(&value.stage) { "" } else { &value.stage };
        row(stage, value)
    });
    let header = ["stage", "value", "unit", "word", "integers", "double", "difference"];
    format!(
        "{}\n\nstatus, integers: {}\nstatus, double: {}\n",
        table(header, rows, 3..),
        in_words(explained.status),
        in_words(explained.status_float),
    )
}

/// A status as a sentence.
pub fn in_words(status: StatusSet) -> String {
    if status.is_empty() { "accepted".to_owned() } else { format!("rejected: {status}") }
}

fn row(stage: &str, value: &StageValue) -> [String; 7] {
    let StageValue { value, unit, word, fixed, float, difference, .. } = value;
    let decimals = decimals(unit);
    let number = |number: f64| {
        if number.abs() < MOST { format!("{number:.decimals$}") } else { format!("{number:.3e}") }
    };
    [
        stage.to_owned(),
        value.clone(),
        (*unit).to_owned(),
        word.to_string(),
        number(*fixed),
        number(*float),
        if *difference < 0.0 { number(*difference) } else { format!("+{}", number(*difference)) },
    ]
}

/// Decimals that show the last bit of a word.
fn decimals(unit: &str) -> usize {
    match unit {
        "1/bin" => 8,
        "m" => 7,
        "photons" => 5,
        "mm" => 4,
        "ps" | "1" => 3,
        "bin" => 1,
        "sd^2" => 2,
        _ => 0,
    }
}
