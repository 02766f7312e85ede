//! Position of the first error in the body of a VCD, because the waveform library does not report it.

use std::collections::HashMap;
use std::path::Path;

use tofsim::error::{Error, Input};

use super::end::body;
use super::fst;
use super::head::{Head, HeadWords, Values, Variable};

/// Commands within the body, apart from `$comment`.
const COMMANDS: [&[u8]; 6] =
    [b"$dumpvars", b"$dumpall", b"$dumpon", b"$dumpoff", b"$end", b"$comment"];

/// Adds line and signal of the first error in the file to an error, if one is found.
pub(super) fn located(path: &Path, error: Error) -> Error {
    let Error::Input(input) = error else { return error };
    match (&input.place, fault(path)) {
        (None, Some(found)) => found.into(),
        _ => Error::Input(input),
    }
}

/// Returns the first error.
fn fault(path: &Path) -> Option<Input> {
    let texts = body(path, None).ok()?.texts;
    let mut words = HeadWords::new(fst::open(path).ok()?);
    let mut variables: HashMap<Vec<u8>, Variable> = HashMap::new();
    let head = Head::read(path, &mut words, &texts, |code, variable| {
        variables.entry(code.to_vec()).or_insert(variable);
    });
    match head {
        Ok(_) => {}
        Err(Error::Input(input)) => return Some(*input),
        Err(_) => return None,
    }
    while let Some(word) = words.next().ok()? {
        let line = words.line;
        let fault = |expected: &str| Input::new(path.display(), expected).at(line, 1);
        let shown = |word: &[u8]| String::from_utf8_lossy(word).into_owned();
        let (value, code) = match word[0] {
            b'#' => continue,
            b'$' if word == b"$comment" => {
                while words.next().ok()?? != b"$end" {}
                continue;
            }
            b'$' if COMMANDS.contains(&&word[..]) => continue,
            b'b' | b'B' | b'r' | b'R' | b's' | b'S' => {
                let Some(code) = words.next().ok()? else {
                    return Some(fault("expected a signal's code behind it").value(shown(&word)));
                };
                (&word[..], code)
            }
            first if is_level(&first) => (&word[..1], word[1..].to_vec()),
            _ => return Some(fault("expected a value, a time or $end").value(shown(&word))),
        };
        let Some(variable) = variables.get(&code) else {
            let expected = "expected the code of a declared signal";
            return Some(fault(expected).field("code").value(shown(&code)));
        };
        if let Some(expected) = wrong(variable, value) {
            return Some(fault(&expected).field(&variable.name).value(shown(value)));
        }
    }
    None
}

fn is_level(byte: &u8) -> bool {
    b"01xXzZhHuUwWlL-".contains(byte)
}

/// Returns what was expected, if a signal cannot have a value.
fn wrong(variable: &Variable, value: &[u8]) -> Option<String> {
    let digits = match value[0] {
        b'b' | b'B' => value.strip_prefix(b"b0b").unwrap_or(&value[1..]),
        _ => value,
    };
    match (variable.values, value[0]) {
        (Values::Event, _) | (Values::Text, b's' | b'S') => None,
        (Values::Text, _) => Some("expected a word, as at other times".into()),
        (Values::Real, b'r' | b'R') => {
            let number = std::str::from_utf8(&value[1..]).ok();
            let is_number = number.is_some_and(|number| number.parse::<f64>().is_ok());
            (!is_number).then(|| "expected a number behind r".into())
        }
        (Values::Real, _) => Some("expected a real number, such as r0.5".into()),
        (Values::Bits, b'r' | b'R' | b's' | b'S') => Some("expected bits".into()),
        (Values::Bits, _) if !digits.iter().all(is_level) => {
            Some("expected the digits 0, 1, x and z".into())
        }
        (Values::Bits, _) if digits.len() > variable.width as usize => {
            Some(format!("expected {} bits at most, not {}", variable.width, digits.len()))
        }
        (Values::Bits, _) => None,
    }
}
