//! Pieces of Verilog that benches and adapters are made of.

use super::table::Column;

/// The range of a vector in a declaration, with a space after it; nothing for a single bit.
pub fn range(width: u32) -> String {
    if width == 1 { String::new() } else { format!("[{}:0] ", width - 1) }
}

/// Returns the place of a column in its line, as the index of a select.
pub fn place(column: &Column) -> String {
    match column.width {
        1 => column.low.to_string(),
        width => format!("{}:{}", column.low + width - 1, column.low),
    }
}

/// A list of parameters, declared or set, with a space after it; nothing if there is none.
pub fn parameter_list(lines: &[String], indent: &str) -> String {
    match lines {
        [] => String::new(),
        lines => format!("#(\n{}\n{indent}) ", lines.join(",\n")),
    }
}
