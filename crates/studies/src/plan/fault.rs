//! Errors that name a place of the plan.

use tofsim::error::Error;
use tofsim::files::toml::Checked;

/// An error about something that stands at a key of a file.
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
