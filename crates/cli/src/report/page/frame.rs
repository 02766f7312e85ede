//! A frame of the scene: its depths and counts, and its histogram.

use serde_json::Value;

use crate::page::html::{table, wide_figure};

/// Returns the section of the first frame of a `tofsim.run/1`, with a caption below its picture.
pub fn section(run: &Value, histogram: Option<&str>, words: &str) -> String {
    let frame = &run["frames"][0];
    if frame.is_null() {
        return "<p class=\"bad\">No frame was simulated.</p>\n".to_owned();
    }
    let m = |key: &str| frame[key].as_f64().map_or("none".to_owned(), |m| format!("{m:.6} m"));
    let second = &frame["second_opinion"];
    let second = match (second["depth_m"].as_f64(), second["status"].as_array()) {
        (Some(m), Some(status)) if status.is_empty() => format!("{m:.6} m"),
        (Some(_), Some(status)) => {
            status.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(", ")
        }
        _ => "none".to_owned(),
    };
    let count = |key: &str| frame[key].as_u64().map_or("-".to_owned(), |n| n.to_string());
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
