//! Command files of Surfer, after the documentation of its version 0.7; not tried with the program.
//!
//! Surfer takes state names from a VCD itself; for an FST file they are in a mapping beside it.

use std::fmt::Write;

use crate::kernel::signals::SignalFormat;

use super::layout::{Group, ShownSignal};
use super::marks::Marks;
use super::writer::WaveFormat;

/// Folder of mappings, in the folder where Surfer is started.
pub(super) const MAPPINGS: &str = ".surfer/mappings";

/// The command file: a heading and its signals, group by group, then the marks.
pub(super) fn commands(format: WaveFormat, groups: &[Group<'_>], marks: &Marks) -> String {
    let mut text = String::new();
    let mut place = 0;
    for group in groups.iter().filter(|group| !group.closed) {
        let heading: Vec<_> = group.name.split(|c: char| !c.is_alphanumeric()).collect();
        line(&mut text, format_args!("divider_add {}", heading.join("_")));
        place += 1;
        for row in &group.rows {
            line(&mut text, format_args!("variable_add {}", row.entry.path()));
            if let Some(shown) = shown_as(format, row) {
                line(&mut text, format_args!("item_focus {}", letters(place)));
                line(&mut text, format_args!("item_set_format {shown}"));
                line(&mut text, "item_unfocus");
            }
            place += 1;
        }
    }
    for (name, at) in marks.named() {
        line(&mut text, format_args!("marker_set {name} {}", at.ps()));
    }
    line(&mut text, format_args!("cursor_set {}", marks.laser_edge.unwrap_or(marks.from).ps()));
    text
}

/// Name of the mapping for the states of `row`, and of its file.
pub(super) fn mapping_name(row: &ShownSignal<'_>) -> String {
    row.name.replace('.', "_")
}

pub(super) fn mapping(states: &[&str], row: &ShownSignal<'_>) -> String {
    let mut text = String::new();
    line(&mut text, format_args!("Name = {}", mapping_name(row)));
    line(&mut text, format_args!("Bits = {}", row.entry.signal.width));
    for (code, state) in states.iter().enumerate() {
        line(&mut text, format_args!("{code} {state}"));
    }
    text
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

/// An item's place as Surfer spells it: hexadecimal digits, with the letters a to p.
fn letters(place: usize) -> String {
    let digit = |c: char| c.to_digit(16).map_or('a', |value| (b'a' + value as u8) as char);
    format!("{place:x}").chars().map(digit).collect()
}

fn line(text: &mut String, line: impl std::fmt::Display) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{line}");
}

#[cfg(test)]
mod tests {
    use super::letters;

    #[test]
    fn places_are_spelled_in_letters() {
        assert_eq!([0, 9, 15, 16, 42].map(letters), ["a", "j", "p", "ba", "ck"]);
    }
}
