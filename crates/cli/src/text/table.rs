//! Plain tables, and numbers for people.

use comfy_table::Table;
use comfy_table::presets::NOTHING;

/// An empty table without borders.
pub fn plain() -> Table {
    let mut table = Table::new();
    table.load_style(NOTHING);
    table
}

/// A number with its thousands apart.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A number of things, of which one is called so without its last letter.
pub fn counted(count: u64, things: &str) -> String {
    let things = if count == 1 { things.trim_end_matches('s') } else { things };
    format!("{} {things}", grouped(count))
}
