//! Faults in the command line, with what the user wrote in them shortened.

use std::error::Error as _;
use std::num::{IntErrorKind, ParseFloatError, ParseIntError};

use clap::Command;
use clap::error::{ContextKind, ContextValue, Error, ErrorKind};

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

/// Makes the options of a command and of its subcommands take a negative number as their value, and not as an option.
pub fn with_negative_numbers(command: Command) -> Command {
    let command = command.mut_args(|arg| {
        let takes = !arg.is_positional() && arg.get_action().takes_values();
        arg.allow_negative_numbers(takes)
    });
    command.mut_subcommands(with_negative_numbers)
}

/// Shortens what the command line has in a fault to a line, and says in words what was expected of a number.
pub fn readable(fault: Error, command: &Command) -> Error {
    let fault = shortened(fault);
    let text = |kind| match fault.get(kind) {
        Some(ContextValue::String(text)) => text.as_str(),
        _ => "",
    };
    let (value, argument) = (text(ContextKind::InvalidValue), text(ContextKind::InvalidArg));
    let expected = expected_number(&fault, value).map(str::to_owned);
    let Some(expected) = expected.or_else(|| expected_range(&fault, value)) else { return fault };
    let message = format!("invalid value '{value}' for '{argument}': {expected}");
    Error::raw(ErrorKind::ValueValidation, message + "\n").with_cmd(command)
}

/// Returns what was expected in the place of a number that cannot be read.
fn expected_number(fault: &Error, value: &str) -> Option<&'static str> {
    let source = fault.source()?;
    if source.is::<ParseFloatError>() {
        return Some("expected a number");
    }
    let number = value.parse::<f64>().ok();
    Some(match source.downcast_ref::<ParseIntError>()?.kind() {
        IntErrorKind::PosOverflow => "expected a smaller number",
        IntErrorKind::NegOverflow => "expected a larger number",
        _ if number.is_some_and(|number| number < 0.0) => "expected a whole number from 0",
        _ if number.is_some() => "expected a whole number in digits alone, such as 1000000",
        _ => "expected a whole number",
    })
}

/// Returns what was expected in the place of a number outside its range, which clap prints as in `0 is not in 1..=8`.
fn expected_range(fault: &Error, value: &str) -> Option<String> {
    let range = fault.source()?.to_string();
    let (from, to) = range.strip_prefix(value)?.strip_prefix(" is not in ")?.split_once("..")?;
    // A range without an end of its own ends at the largest number of its type.
    let end = to.strip_prefix('=').map_or(String::new(), |to| format!(" to {to}"));
    Some(format!("expected a whole number from {from}{end}"))
}

/// Shortens the command line in a fault to a line.
fn shortened(mut fault: Error) -> Error {
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
