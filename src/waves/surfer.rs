//! Surfer command files, as version 0.7.0-dev runs them without an error (`docs/files.md`).
//!
//! Surfer reads state names from the waveform.

use crate::kernel::signals::SignalFormat;

use super::layout::{Group, ShownSignal};
use super::marks::Marks;

/// Formats the command file: the heading and the signals of each group, then the marks.
pub(super) fn commands(groups: &[Group<'_>], marks: &Marks) -> String {
    let mut text = String::new();
    let mut place = 0;
    for group in groups.iter().filter(|group| !group.closed) {
        let heading: Vec<_> = group.name.split(|c: char| !c.is_alphanumeric()).collect();
        text += &format!("divider_add {}\n", heading.join("_"));
        place += 1;
        for row in &group.rows {
            text += &format!("variable_add {}\n", row.entry.path());
            let signal = &row.entry.signal;
            let shown = shown_as(row).map(|shown| format!("item_set_format {shown}\n"));
            // Surfer has a binary point only where the range has one: it shows the integer.
            let unit = Some(signal.unit.without(signal.fraction())).filter(|unit| !unit.is_empty());
            let named = unit.map(|unit| format!("item_rename {} [{unit}]\n", signal.name));
            if shown.is_some() || named.is_some() {
                text += &format!("item_focus {}\n", letters(place));
                text += &(shown.unwrap_or_default() + &named.unwrap_or_default());
                text += "item_unfocus\n";
            }
            place += 1;
        }
    }
    for (name, at) in marks.named() {
        text += &format!("marker_set {name} {}\n", at.ps());
    }
    text + &format!("cursor_set {}\n", marks.laser_edge.unwrap_or(marks.from).ps())
}

fn shown_as(row: &ShownSignal<'_>) -> Option<&'static str> {
    match row.entry.signal.format {
        SignalFormat::Unsigned if row.entry.signal.width <= 32 => Some("Unsigned"),
        SignalFormat::Signed { .. } => Some("Signed"),
        SignalFormat::Taps => Some("Number of ones"),
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
