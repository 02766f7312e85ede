//! Surfer command files, as version 0.7.0-dev runs them without an error (`docs/files.md`).
//!
//! Surfer reads state names from a VCD itself; for an FST file, a mapping next to it holds them.

use crate::kernel::signals::SignalFormat;

use super::layout::{Group, ShownSignal};
use super::marks::Marks;
use super::writer::WaveFormat;

/// Folder of mappings, relative to the folder in which Surfer is started.
pub(super) const MAPPINGS: &str = ".surfer/mappings";

/// Formats the command file: the heading and the signals of each group, then the marks.
pub(super) fn commands(format: WaveFormat, groups: &[Group<'_>], marks: &Marks) -> String {
    let mut text = String::new();
    let mut place = 0;
    for group in groups.iter().filter(|group| !group.closed) {
        let heading: Vec<_> = group.name.split(|c: char| !c.is_alphanumeric()).collect();
        text += &format!("divider_add {}\n", heading.join("_"));
        place += 1;
        for row in &group.rows {
            text += &format!("variable_add {}\n", row.entry.path());
            if let Some(shown) = shown_as(format, row) {
                text += &format!("item_focus {}\n", letters(place));
                text += &format!("item_set_format {shown}\nitem_unfocus\n");
            }
            place += 1;
        }
    }
    for (name, at) in marks.named() {
        text += &format!("marker_set {name} {}\n", at.ps());
    }
    text + &format!("cursor_set {}\n", marks.laser_edge.unwrap_or(marks.from).ps())
}

/// Returns the name of the mapping for the states of `row`, which is also the name of its file.
pub(super) fn mapping_name(row: &ShownSignal<'_>) -> String {
    row.name.replace('.', "_")
}

pub(super) fn mapping(states: &[&str], row: &ShownSignal<'_>) -> String {
    let codes = states.iter().enumerate().map(|(code, state)| format!("{code} {state}\n"));
    let (name, bits) = (mapping_name(row), row.entry.signal.width);
    format!("Name = {name}\nBits = {bits}\n{}", codes.collect::<String>())
}

fn shown_as(format: WaveFormat, row: &ShownSignal<'_>) -> Option<String> {
    match row.entry.signal.format {
        SignalFormat::Unsigned if row.entry.signal.width <= 32 => Some("Unsigned".into()),
        SignalFormat::Signed { .. } => Some("Signed".into()),
        SignalFormat::Taps => Some("Number of ones".into()),
        SignalFormat::State(_) if format == WaveFormat::Fst => Some(mapping_name(row)),
        SignalFormat::State(_) | SignalFormat::Bits | SignalFormat::Unsigned => None,
    }
}

/// Formats the index of an item as Surfer does: hexadecimal digits, written with the letters a to p.
fn letters(place: usize) -> String {
    let digit = |c: char| c.to_digit(16).map_or('a', |value| (b'a' + value as u8) as char);
    format!("{place:x}").chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::letters;

    #[test]
    fn places_are_spelled_in_letters() {
        assert_eq!([0, 9, 15, 16, 42].map(letters), ["a", "j", "p", "ba", "ck"]);
    }
}
