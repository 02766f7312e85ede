//! Python's dictionaries and lists from JSON, and `key=value` overrides from Python's dictionaries.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyList, PyString};
use serde_json::Value;

/// Deepest nesting of a dictionary of tables, more than any key has.
const DEEPEST: usize = 16;

/// A JSON value as Python has it.
pub fn object<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Null => py.None().into_bound(py),
        Value::Bool(truth) => PyBool::new(py, *truth).to_owned().into_any(),
        Value::Number(number) => match (number.as_u64(), number.as_i64()) {
            (Some(whole), _) => whole.into_pyobject(py)?.into_any(),
            (_, Some(whole)) => whole.into_pyobject(py)?.into_any(),
            _ => PyFloat::new(py, number.as_f64().unwrap_or(f64::NAN)).into_any(),
        },
        Value::String(text) => PyString::new(py, text).into_any(),
        Value::Array(elements) => {
            let list = PyList::empty(py);
            elements.iter().try_for_each(|element| list.append(object(py, element)?))?;
            list.into_any()
        }
        Value::Object(pairs) => {
            let dict = PyDict::new(py);
            pairs.iter().try_for_each(|(key, value)| dict.set_item(key, object(py, value)?))?;
            dict.into_any()
        }
    })
}

/// An override for each value of a dictionary of tables, as `-s` of the command line has it.
pub fn assignments(tables: &Bound<'_, PyDict>) -> PyResult<Vec<String>> {
    let mut found = Vec::new();
    collect(tables, "", DEEPEST, &mut found)?;
    Ok(found)
}

/// Appends the overrides of a table, whose values are nested to `depth` levels at most.
fn collect(
    table: &Bound<'_, PyDict>,
    above: &str,
    depth: usize,
    found: &mut Vec<String>,
) -> PyResult<()> {
    let depth = less_deep(depth)?;
    for (key, value) in table.iter() {
        let key: String = key.extract()?;
        let key = format!("{above}{key}");
        match value.cast::<PyDict>() {
            Ok(below) => collect(below, &format!("{key}."), depth, found)?,
            Err(_) => found.push(format!("{key}={}", toml(&value, depth)?)),
        }
    }
    Ok(())
}

/// Returns the depth that is left below a table or a list.
///
/// # Errors
/// If none is left, as within one that contains itself.
fn less_deep(depth: usize) -> PyResult<usize> {
    let fault = || {
        let text = format!(
            "expected dicts and lists nested to {DEEPEST} levels at most, none within itself"
        );
        PyValueError::new_err(text)
    };
    depth.checked_sub(1).ok_or_else(fault)
}

/// A value as TOML has it, nested to `depth` levels at most.
fn toml(value: &Bound<'_, PyAny>, depth: usize) -> PyResult<String> {
    if let Ok(truth) = value.cast::<PyBool>() {
        return Ok(truth.is_true().to_string());
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Value::from(text.to_str()?).to_string());
    }
    if let Ok(table) = value.cast::<PyDict>() {
        let depth = less_deep(depth)?;
        let pair = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            Ok(format!("{} = {}", key.extract::<String>()?, toml(&value, depth)?))
        };
        let pairs: PyResult<Vec<_>> = table.iter().map(pair).collect();
        return Ok(format!("{{ {} }}", pairs?.join(", ")));
    }
    // Numbers of NumPy are none of Python's, but can be made ones.
    for convert in ["__index__", "__float__"] {
        if value.hasattr(convert)? {
            return Ok(value.call_method0(convert)?.repr()?.to_string());
        }
    }
    if value.hasattr("__iter__")? {
        let depth = less_deep(depth)?;
        let elements: PyResult<Vec<_>> =
            value.try_iter()?.map(|each| toml(&each?, depth)).collect();
        return Ok(format!("[{}]", elements?.join(", ")));
    }
    let name = value.get_type().name()?;
    Err(PyTypeError::new_err(format!("expected a number, a text, a list or a dict, got {name}")))
}
