//! Faults in the command line, with what the user wrote in them shortened.

use clap::error::{ContextKind, ContextValue, Error};

use tofsim::error::shortened as short;

/// Longest piece of the command line that a message repeats [characters].
const LONG: usize = 60;
/// Kinds of what a message may have from the command line.
const TOLD: [ContextKind; 5] = [
    ContextKind::InvalidSubcommand,
    ContextKind::InvalidArg,
    ContextKind::InvalidValue,
    ContextKind::PriorArg,
    ContextKind::TrailingArg,
];

/// Shortens the command line in a fault to a line.
pub fn shortened(mut fault: Error) -> Error {
    for kind in TOLD {
        let value = match fault.get(kind) {
            Some(ContextValue::String(text)) => {
                ContextValue::String(short(text, LONG).into_owned())
            }
            Some(ContextValue::Strings(texts)) => ContextValue::Strings(
                texts.iter().map(|text| short(text, LONG).into_owned()).collect(),
            ),
            _ => continue,
        };
        fault.insert(kind, value);
    }
    // An advice that repeats more than that is of no use.
    let is_long = |fault: &Error| match fault.get(ContextKind::Suggested) {
        Some(ContextValue::StyledStrs(advice)) => {
            advice.iter().any(|one| one.to_string().len() > 4 * LONG)
        }
        _ => false,
    };
    if is_long(&fault) {
        fault.remove(ContextKind::Suggested);
    }
    fault
}
