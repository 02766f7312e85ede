//! One form for the values of a text dump and of a waveform.

use tofsim_captures::source::{Signal, SignalKind, SourceState};

use super::table::Kind;

/// VHDL's names of the characters without a graphic that the designs use.
const CONTROLS: [(&str, u32); 2] = [("nul", 0), ("del", 127)];

/// Text of a signal that has no value yet.
pub(super) const VALUELESS: &str = "none";

/// Returns a cell of a text dump; the number of a signal of `width` bits becomes its bits, and a real number is rounded
/// to `digits`.
pub(super) fn printed(kind: Kind, cell: &str, width: u32, digits: usize) -> String {
    match kind {
        Kind::Bits => cell.chars().map(level).collect(),
        Kind::Number => {
            let number = cell.split(' ').next().unwrap();
            let number: i128 = number.parse().unwrap_or_else(|_| panic!("{cell}: no number"));
            (0..width).rev().map(|bit| if number >> bit & 1 == 1 { '1' } else { '0' }).collect()
        }
        Kind::Real => real(cell.parse().unwrap_or_else(|_| panic!("{cell}: not real")), digits),
        Kind::Character | Kind::Word | Kind::Event => cell.to_owned(),
    }
}

/// Returns the value of a signal in the form of [`printed`].
pub(super) fn read(
    kind: Kind,
    signal: &Signal,
    state: &SourceState,
    k: usize,
    digits: usize,
) -> String {
    let (value, unknown) = (state.value(k), state.unknown(k));
    let of = |words: &[u64], bit: u32| words[bit as usize / 64] >> (bit % 64) & 1;
    let levels = (0..signal.width).rev().map(|bit| match (of(unknown, bit), of(value, bit)) {
        (0, 0) => '0',
        (0, _) => '1',
        (_, 0) => 'x',
        _ => 'z',
    });
    match (signal.kind, kind) {
        (SignalKind::Bits, Kind::Bits | Kind::Number) => levels.collect(),
        _ if unknown.iter().any(|&word| word != 0) => VALUELESS.to_owned(),
        (SignalKind::Bits, Kind::Character) => value[0].to_string(),
        (SignalKind::Bits, Kind::Word) if signal.words.states.is_empty() => {
            ["false", "true"][value[0] as usize].to_owned()
        }
        (SignalKind::Bits, Kind::Word) => {
            let state = signal.words.states.iter().find(|state| state.bits == Some(value[0]));
            state.map_or("without name".to_owned(), |state| state.name.clone())
        }
        (SignalKind::Text, Kind::Word) => text(value),
        (SignalKind::Text, Kind::Character) => position(&text(value)).to_string(),
        (SignalKind::Real, Kind::Real) => real(f64::from_bits(value[0]), digits),
        (found, expected) => panic!("{}: {found:?} is not {expected:?}", signal.name.text),
    }
}

/// Reduces the nine values to the four that every comparison uses.
fn level(digit: char) -> char {
    match digit {
        '0' | 'L' => '0',
        '1' | 'H' => '1',
        'Z' | 'z' => 'z',
        'U' | 'X' | 'W' | '-' | 'x' => 'x',
        _ => panic!("{digit}: no level"),
    }
}

fn real(number: f64, digits: usize) -> String {
    format!("{number:.*e}", digits - 1)
}

/// Returns the text in the words of a value.
fn text(words: &[u64]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes());
    String::from_utf8(bytes.take_while(|&byte| byte != 0).collect()).unwrap()
}

/// Returns the position of a VHDL character, given its literal or name.
fn position(literal: &str) -> u32 {
    let control = CONTROLS.iter().find(|(name, _)| *name == literal);
    control.map_or_else(|| literal.chars().nth(1).unwrap().into(), |&(_, position)| position)
}
