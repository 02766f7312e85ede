//! Values as text.

use tofsim::waves::dump::DumpValue;

use crate::ila::read::word;
use crate::source::{Signal, SignalKind};
use crate::words::lowest;

/// Returns whether a signal has a value; numbers and texts have none at first.
pub(super) fn has_value(signal: &Signal, unknown: &[u64]) -> bool {
    match signal.kind {
        SignalKind::Bits => true,
        SignalKind::Real | SignalKind::Text => unknown.first() == Some(&0),
        SignalKind::Event | SignalKind::Other => false,
    }
}

/// Formats a value: the name of a state, a decimal number up to 64 bits, a hexadecimal one beyond, binary digits if a
/// bit is unknown, or a word. It is empty if there is none.
pub(super) fn text(signal: &Signal, value: &[u64], unknown: &[u64]) -> String {
    if !has_value(signal, unknown) {
        return String::new();
    }
    match signal.kind {
        SignalKind::Real => return format!("{:?}", f64::from_bits(value[0])),
        SignalKind::Text => return word(value),
        SignalKind::Bits | SignalKind::Event | SignalKind::Other => {}
    }
    if unknown.iter().any(|&word| word != 0) {
        let prefix = if signal.width == 1 { "" } else { "0b" };
        let digits = (0..signal.width).rev().map(|place| DumpValue::digit(value, unknown, place));
        return prefix.chars().chain(digits.map(char::from)).collect();
    }
    let state = || signal.words.states.iter().find(|state| state.bits == Some(value[0]));
    match value {
        [_] if state().is_some() => state().map_or(String::new(), |state| state.name.clone()),
        [number] => number.to_string(),
        [_, _] => format!("{:#x}", lowest(value)),
        [..] => {
            let begin = value.iter().rposition(|&word| word != 0).unwrap_or(0);
            let rest = value[..begin].iter().rev().map(|word| format!("{word:016x}"));
            format!("{:#x}", value[begin]) + &rest.collect::<String>()
        }
    }
}
