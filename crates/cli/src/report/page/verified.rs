//! Blocks that were verified, and cycle counts that were proven.

use serde_json::Value;

use crate::page::html::table;

fn word(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        Value::String(text) => text.clone(),
        Value::Bool(truth) => if *truth { "yes" } else { "NO" }.to_owned(),
        other => other.to_string(),
    }
}

/// The benches, then the cycle counts.
pub fn section(verify: &Value, cycles: &Value) -> String {
    let missing = |what: &str| format!("<p class=\"bad\">{what} not done.</p>\n");
    let blocks = match verify["blocks"].as_array() {
        None => missing("The comparison of Verilog and model was"),
        Some(blocks) => {
            let row = |block: &Value| {
                ["block", "cycles", "mismatches", "verdict", "fault"].map(|key| word(&block[key]))
            };
            "<p>Each bench compares every output and register of the Verilog in rtl/ with the model, clock by clock \
             (Icarus Verilog); the last one takes the module with this instrument's parameters through a frame of \
             this scene.</p>\n"
                .to_owned()
                + &table(&["block", "cycles", "mismatches", "verdict", "fault or reason"], blocks.iter().map(row))
        }
    };
    let counts = match cycles["counts"].as_array() {
        None => missing("The proof of the cycle counts was"),
        Some(counts) => {
            let row = |count: &Value| {
                ["what", "expected", "unit", "model", "rtl", "proven"].map(|key| word(&count[key]))
            };
            table(
                &["what", "expected", "unit", "model", "Verilog", "proven"],
                counts.iter().map(row),
            )
        }
    };
    format!(
        "{blocks}<h3>Cycle counts, counted in the model and in a simulation, and proven (Yosys, k-induction)</h3>\n{counts}"
    )
}
