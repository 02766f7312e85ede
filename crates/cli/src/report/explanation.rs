//! The values of an estimation as tables: fixed point beside double precision.

use comfy_table::Table;

use tofsim_learn::quantize::Explanation;
use tofsim_learn::quantize::explain::{ErrorBudget, ExplainedNeuron, WordAndTwin};

use crate::text::table::{align_right, plain};

/// The tables, with a line about what saturates and where the two first part.
pub fn text(explained: &Explanation) -> String {
    let mut table = plain();
    table.set_header(["value", "neuron", "word", "fixed", "float", "LSB", "mm", ""]);
    layer(&mut table, "l1_in", explained, |neuron| (neuron.l1_in, String::new()));
    layer(&mut table, "l1_out", explained, |neuron| {
        let note = if neuron.saturated { ", saturated" } else { "" };
        (neuron.l1_out, format!("address {}{note}", neuron.address))
    });
    layer(&mut table, "product", explained, |neuron| (neuron.product, String::new()));
    row(&mut table, "bias", "", &explained.bias, String::new());
    row(&mut table, "depth", "", &explained.depth, String::new());
    align_right(&mut table, 1..7);
    format!(
        "{}\n\n{}\n\n{}\nsaturated: {} of {} neurons\n",
        table.trim_fmt(),
        budget(&explained.budget).trim_fmt(),
        parting(explained),
        explained.saturated,
        explained.neurons.len()
    )
}

/// A row for each neuron: a value, and a note.
fn layer(
    table: &mut Table,
    name: &str,
    explained: &Explanation,
    of: impl Fn(&ExplainedNeuron) -> (WordAndTwin, String),
) {
    for (k, neuron) in explained.neurons.iter().enumerate() {
        let (pair, note) = of(neuron);
        row(table, name, &k.to_string(), &pair, note);
    }
}

fn row(table: &mut Table, layer: &str, neuron: &str, pair: &WordAndTwin, note: String) {
    table.add_row([
        layer.to_owned(),
        neuron.to_owned(),
        pair.word.to_string(),
        format!("{:.8}", pair.fixed),
        format!("{:.8}", pair.float),
        format!("{:+.2}", pair.difference_lsb),
        format!("{:+.4}", pair.difference_mm),
        note,
    ]);
}

fn budget(budget: &ErrorBudget) -> Table {
    let mut table = plain();
    table.set_header(["what rounding adds to the depth", "mm"]);
    for (part, mm) in [
        ("W1 and B1 to their words", budget.hidden_weights_mm),
        ("the sum to an address of the table", budget.address_mm),
        ("the table's entries", budget.table_mm),
        ("W2 and B2 to their words", budget.output_weights_mm),
        ("all", budget.total_mm),
    ] {
        table.add_row([part.to_owned(), format!("{mm:+.4}")]);
    }
    align_right(&mut table, 1..);
    table
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
