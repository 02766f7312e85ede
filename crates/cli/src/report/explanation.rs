//! The values of an estimation as tables: fixed point beside double precision.

use tofsim_learn::quantize::Explanation;
use tofsim_learn::quantize::explain::{ErrorBudget, ExplainedNeuron, WordAndTwin};

use crate::text::table::table;

/// The tables, with a line about what saturates and where the two first part.
pub fn text(explained: &Explanation) -> String {
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
        format!("{:+.2}", pair.difference_lsb),
        format!("{:+.4}", pair.difference_mm),
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
    let rows = parts.map(|(part, mm)| [part.to_owned(), format!("{mm:+.4}")]);
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
