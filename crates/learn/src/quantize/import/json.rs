//! Arrays from JSON: `{"IW": [[...]], "LW": [...], "b": [[...], [...]], "x": {"xoffset": ...}}`.

use std::path::Path;

use serde_json::Value;

use tofsim::error::{Input, Result, read_text};

use super::arrays::Arrays;

/// Reads a file.
pub(super) fn read(path: &Path) -> Result<Arrays> {
    parse(&read_text(path)?, &path.display().to_string())
}

fn parse(text: &str, name: &str) -> Result<Arrays> {
    let fault = |error: serde_json::Error| {
        let input = Input::new(name, format!("not JSON: {error}"));
        input.at(error.line(), error.column())
    };
    let tree: Value = serde_json::from_str(text).map_err(fault)?;
    let Value::Object(object) = tree else {
        return Err(Input::new(name, "expected an object of arrays").into());
    };
    let mut arrays = Arrays::new(name);
    for (key, value) in &object {
        match (key.as_str(), value) {
            ("b", Value::Array(biases)) => {
                for (layer, bias) in biases.iter().enumerate() {
                    put(&mut arrays, &format!("b{}", layer + 1), bias)?;
                }
            }
            ("x" | "y", Value::Object(settings)) => {
                for (setting, value) in settings {
                    put(&mut arrays, &format!("{key}_{setting}"), value)?;
                }
            }
            // Where `train` says what it did.
            ("training", Value::Object(_)) => {}
            _ => put(&mut arrays, key, value)?,
        }
    }
    Ok(arrays)
}

/// Adds a number, or nested lists of numbers of one length each.
fn put(arrays: &mut Arrays, name: &str, value: &Value) -> Result<()> {
    let expected = "expected numbers, in lists of one length";
    let (shape, values) = numbers(value).ok_or_else(|| arrays.fault(name, expected))?;
    arrays.put(name, shape, values);
    Ok(())
}

/// Lengths of nested lists, outermost first, and their numbers.
fn numbers(value: &Value) -> Option<(Vec<usize>, Vec<f64>)> {
    let Value::Array(items) = value else { return Some((Vec::new(), vec![value.as_f64()?])) };
    let (shapes, values): (Vec<_>, Vec<_>) =
        items.iter().map(numbers).collect::<Option<Vec<_>>>()?.into_iter().unzip();
    let inner = shapes.first().cloned().unwrap_or_default();
    let shape = [&[items.len()], &inner[..]].concat();
    shapes.iter().all(|other| *other == inner).then(|| (shape, values.concat()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nested_lists_and_settings_become_arrays() {
        let text = r#"{"IW": [[1, 2], [3, 4], [5, 6]], "b": [[0.5, 1], 2], "x": {"ymin": -1}}"#;
        let arrays = parse(text, "a.json").unwrap();
        let mut expected = Arrays::new("a.json");
        expected.put("IW", vec![3, 2], vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        expected.put("b1", vec![2], vec![0.5, 1.0]);
        expected.put("b2", vec![], vec![2.0]);
        expected.put("x_ymin", vec![], vec![-1.0]);
        assert_eq!(arrays, expected);
    }

    #[test]
    fn ragged_lists_words_and_syntax_are_faults() {
        let fault = |text: &str| parse(text, "a.json").unwrap_err().to_string();
        assert!(fault(r#"{"IW": [[1, 2], [3]]}"#).contains("IW: expected numbers, in lists"));
        assert!(fault(r#"{"LW": "tanh"}"#).contains("LW: expected numbers"));
        assert!(fault(r#"{"LW": [1, [2]]}"#).contains("LW: expected numbers"));
        assert!(fault("[1]").contains("expected an object of arrays"));
        assert!(fault("{\n  \"IW\": [1,,]}").starts_with("a.json:2:"));
    }
}
