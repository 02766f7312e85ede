//! The values of an estimation as tables, of the network layer by layer and of the likelihood estimator stage by stage: fixed
//! point beside double precision.

use tofsim::firmware::tof_top::status::StatusSet;
use tofsim_learn::quantize::explain::{ErrorBudget, ExplainedNeuron, WordAndTwin};
use tofsim_learn::quantize::likelihood::StageValue;
use tofsim_learn::quantize::{ExplainedLikelihood, Explanation};

use crate::text::table::{signed, table};

/// The tables, with a line about what saturates and where the two first part.
pub fn network(explained: &Explanation) -> String {
    let layer = |name: &'static str, of: fn(&ExplainedNeuron) -> (WordAndTwin, String)| {
        explained.neurons.iter().enumerate().map(move |(k, neuron)| {
            let (pair, note) = of(neuron);
            row(name, k.to_string(), &pair, note)
        })
    };
    let rows = layer("l1_in", |neuron| (neuron.l1_in, String::new()))
        .chain(layer("l1_out", |neuron| {
            let note = if neuron.saturated { ", saturated" } else { "" };
            (neuron.l1_out, format!("address {}{note}", neuron.address))
        }))
        .chain(layer("product", |neuron| (neuron.product, String::new())))
        .chain([row("bias", String::new(), &explained.bias, String::new())])
        .chain([row("depth", String::new(), &explained.depth, String::new())]);
    format!(
        "{}\n\n{}\n\n{}\nsaturated: {} of {} neurons\n",
        table(["value", "neuron", "word", "fixed", "float", "LSB", "mm", ""], rows, 1..7),
        budget(&explained.budget),
        parting(explained),
        explained.saturated,
        explained.neurons.len()
    )
}

fn row(layer: &str, neuron: String, pair: &WordAndTwin, note: String) -> [String; 8] {
    [
        layer.to_owned(),
        neuron,
        pair.word.to_string(),
        format!("{:.8}", pair.fixed),
        format!("{:.8}", pair.float),
        signed(pair.difference_lsb, 2),
        signed(pair.difference_mm, 4),
        note,
    ]
}

fn budget(budget: &ErrorBudget) -> String {
    let parts = [
        ("W1 and B1 to their words", budget.hidden_weights_mm),
        ("the sum to an address of the table", budget.address_mm),
        ("the table's entries", budget.table_mm),
        ("W2 and B2 to their words", budget.output_weights_mm),
        ("all", budget.total_mm),
    ];
    let rows = parts.map(|(part, mm)| [part.to_owned(), signed(mm, 4)]);
    table(["what rounding adds to the depth", "mm"], rows, 1..)
}

fn parting(explained: &Explanation) -> String {
    match explained.first_parting {
        None => "every word is the one nearest to its twin".to_owned(),
        Some((layer, None)) => format!("first off by more than half an LSB: {layer}"),
        Some((layer, Some(neuron))) => {
            format!("first off by more than half an LSB: {layer} of neuron {neuron}")
        }
    }
}

/// Numbers from here on are shown as a mantissa and a power of ten.
const MOST: f64 = 1e6;

/// The table, with what the status says.
pub fn likelihood(explained: &ExplainedLikelihood) -> String {
    let stages = || explained.values.iter().map(|value| &value.stage);
    let before = [None].into_iter().chain(stages().map(Some));
    let rows = explained.values.iter().zip(before).map(|(value, before)| {
        let stage = if before == Some(&value.stage) { "" } else { &value.stage };
        stage_row(stage, value)
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

fn stage_row(stage: &str, value: &StageValue) -> [String; 7] {
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
