//! Errors with a position in the plan.

use tofsim::error::Error;
use tofsim::files::toml::Checked;

/// Adds the position of a key to an error.
pub fn at_key(checked: &Checked, key: &str, error: Error) -> Error {
    match error {
        Error::Input(input) => {
            let value = input.value.map_or(String::new(), |value| format!(" = {value}"));
            let what = input.field.map_or(String::new(), |field| format!("{field}{value}: "));
            checked.fault(key, format!("{what}{}", input.expected)).into()
        }
        other => other,
    }
}
