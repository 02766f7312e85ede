//! Values as text.

use crate::ila::read::word;
use crate::source::{Signal, SignalKind};
use crate::words::{bit, lowest};

/// Digit of a level.
pub(super) fn level(value: &[u64], unknown: &[u64], place: u32) -> char {
    match (bit(unknown, place), bit(value, place)) {
        (0, 0) => '0',
        (0, _) => '1',
        (_, 0) => 'x',
        _ => 'z',
    }
}

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
    let digits = || (0..signal.width).rev().map(|place| level(value, unknown, place));
    if unknown.iter().any(|&word| word != 0) {
        let prefix = if signal.width == 1 { "" } else { "0b" };
        return digits()
            .fold(prefix.to_owned(), |text, digit| text + digit.encode_utf8(&mut [0; 4]));
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
