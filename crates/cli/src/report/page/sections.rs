//! Sections of both pages: a frame, resources, verification and notes.

use serde_json::Value;

use crate::page::html::{escaped, table, wide_figure};

/// Resources of the parts: LUT, FF, block RAM, multipliers (docs/resources.md; Lattice FPGA-DS-02012).
const PARTS: [(&str, &str, [u64; 4]); 2] = [
    ("kintex7", "XC7K325T", [203_800, 407_600, 445, 840]),
    ("ecp5", "LFE5UM5G-85F", [83_640, 83_640, 208, 156]),
];
const KINDS: [(&str, &str); 4] =
    [("lut", "LUT"), ("ff", "flip-flops"), ("bram", "block RAM"), ("dsp", "multipliers")];

/// A table for both parts.
pub fn cost(cost: &Value) -> String {
    if cost.is_null() {
        return "<p class=\"bad\">This was not counted: Yosys was not there.</p>\n".to_owned();
    }
    let rows = PARTS.into_iter().flat_map(|(part, name, has)| {
        KINDS.into_iter().zip(has).filter_map(move |((key, what), has)| {
            let used = cost["parts"][part][key].as_f64()?;
            let share = format!("{:.1} %", 100.0 * used / has as f64);
            Some([name.to_owned(), what.to_owned(), used.to_string(), has.to_string(), share])
        })
    });
    let maker = cost["maker"].as_str().unwrap_or("Yosys");
    format!(
        "{}<p>{maker}, without place and route; a vendor's tool comes to other numbers. LUTs include those that are \
         RAM or carry. Block RAM is of 36 Kb on the Kintex-7, and of 18 Kb on the ECP5.</p>\n",
        table(&["part", "primitive", "used", "of", "share"], rows)
    )
}

/// Returns the section of the first frame of a `tofsim.run/1`, with a caption below its picture.
pub fn frame(run: &Value, histogram: Option<&str>, words: &str) -> String {
    let found = &run["frames"][0];
    if found.is_null() {
        return "<p class=\"bad\">No frame was simulated.</p>\n".to_owned();
    }
    let m = |key: &str| found[key].as_f64().map_or("none".to_owned(), |m| format!("{m:.6} m"));
    let second = &found["second_opinion"];
    let second = match (second["depth_m"].as_f64(), second["status"].as_array()) {
        (Some(m), Some(status)) if status.is_empty() => format!("{m:.6} m"),
        (Some(_), Some(status)) => {
            status.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(", ")
        }
        _ => "none".to_owned(),
    };
    let count = |key: &str| found[key].as_u64().map_or("-".to_owned(), |n| n.to_string());
    let rows = [
        ("true distance", m("true_depth_m")),
        ("depth found", m("depth_m")),
        ("second opinion", second),
        ("shots", count("shots")),
        ("hits counted", count("hits")),
        ("estimator [cycles of clk_sys]", count("estimator_cycles")),
        ("frame [cycles of clk_sys]", count("frame_cycles")),
    ];
    let rows = rows.map(|(what, value)| [what.to_owned(), value]);
    table(&["", "one frame of the file's scene"], rows)
        + &wide_figure(histogram.unwrap_or_default(), words)
}

/// A line for each.
pub fn notes(notes: &[String]) -> String {
    if notes.is_empty() {
        return "<p>There are none: the scenario is one that this network was trained for.</p>\n"
            .to_owned();
    }
    let item = |note: &String| format!("<li>{}</li>\n", escaped(note));
    format!("<ul>\n{}</ul>\n", notes.iter().map(item).collect::<String>())
}

fn word(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        Value::String(text) => text.clone(),
        Value::Bool(truth) => if *truth { "yes" } else { "NO" }.to_owned(),
        other => other.to_string(),
    }
}

/// The benches, then the cycle counts.
pub fn verified(verify: &Value, cycles: &Value) -> String {
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
