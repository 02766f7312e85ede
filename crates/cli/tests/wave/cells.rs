//! A reader of VCD text that is of the tests alone: the values of each signal at each time.

use std::collections::BTreeMap;
use std::path::Path;

/// Changes of each name: times, and values from then on.
pub type Cells = BTreeMap<String, Vec<(u64, String)>>;

/// Reads the VCD file `name`.
pub fn read(folder: &Path, name: &str) -> Cells {
    cells(&String::from_utf8_lossy(&std::fs::read(folder.join(name)).unwrap()))
}

/// The cells of a VCD text. Levels are 0, 1, x and z, of the signal's width; numbers are the bits of floating point;
/// several values at one time are the last. Names have no range, and no scope if a writer leaves it out.
pub fn cells(text: &str) -> Cells {
    let (head, body) = text.split_once("$enddefinitions").unwrap();
    let mut names: BTreeMap<&str, Vec<(String, usize)>> = BTreeMap::new();
    let (mut scopes, mut words) = (Vec::new(), head.split_whitespace());
    while let Some(word) = words.next() {
        let mut rest: Vec<&str> = words.by_ref().take_while(|word| *word != "$end").collect();
        match word {
            "$scope" => scopes.push(rest[1]),
            "$upscope" => drop(scopes.pop()),
            "$var" => {
                let name = rest.split_off(3).remove(0);
                let name = name.split('[').next().unwrap();
                let path = scopes.iter().copied().chain([name]).collect::<Vec<_>>().join(".");
                names.entry(rest[2]).or_default().push((path, rest[1].parse().unwrap()));
            }
            _ => {}
        }
    }
    let (mut cells, mut at) = (Cells::new(), 0);
    let mut words = body.split_whitespace();
    while let Some(word) = words.next() {
        let (kind, rest) = word.split_at(1);
        let (value, code) = match kind {
            "$" => continue,
            "#" => {
                at = rest.parse().unwrap();
                continue;
            }
            "b" | "r" | "s" => (rest, words.next().unwrap()),
            _ => (kind, rest),
        };
        for (name, width) in &names[code] {
            let value = match kind {
                "r" => format!("{:x}", value.parse::<f64>().unwrap().to_bits()),
                "s" => escaped(value),
                _ => levels(value, *width),
            };
            let changes = cells.entry(name.clone()).or_default();
            if changes.last().is_some_and(|(last, _)| *last == at) {
                changes.pop();
            }
            if changes.last().is_none_or(|(_, last)| *last != value) {
                changes.push((at, value));
            }
        }
    }
    cells
}

/// A text with backslash sequences for the bytes of what is not ASCII.
fn escaped(text: &str) -> String {
    let escaped = |byte: u8| match byte {
        0..128 => char::from(byte).to_string(),
        _ => format!("\\{byte:03o}"),
    };
    text.bytes().map(escaped).collect()
}

/// Levels of nine values as four, extended to the width.
fn levels(value: &str, width: usize) -> String {
    let four = |level: char| match level.to_ascii_lowercase() {
        '0' | 'l' => '0',
        '1' | 'h' => '1',
        'z' => 'z',
        _ => 'x',
    };
    let four: String = value.chars().map(four).collect();
    let extension = if four.starts_with('1') { "0" } else { &four[..1] };
    extension.repeat(width.saturating_sub(four.len())) + &four
}
