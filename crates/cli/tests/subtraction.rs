//! `run` and `evaluate` with subtraction: pairs of a dark and a lit frame through the firmware, and
//! what comes of their difference.

mod evaluate;
mod physics;
mod refused;
mod results;
mod signals;

use std::path::Path;

use serde_json::Value;

use crate::common;

/// A run in pairs without waveform.
const PAIRS: [&str; 5] = ["run", "--estimator", "subtraction", "--waves", "none"];

/// Its result.
fn pairs(folder: &Path, more: &[&str]) -> Value {
    common::json(folder, &[&PAIRS, &["--json"][..], more].concat())
}

/// Numbers of a JSON array.
fn counts(value: &Value) -> Vec<i64> {
    value.as_array().unwrap().iter().map(|count| count.as_i64().unwrap()).collect()
}

/// Instant of an edge of `clk_sys` [us].
fn edge_us(edge: u64) -> f64 {
    1.008 + 0.008 * edge as f64
}
