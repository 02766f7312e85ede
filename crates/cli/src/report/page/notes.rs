//! Notes on the validity of the results.

use crate::page::html::escaped;

/// A line for each.
pub fn section(notes: &[String]) -> String {
    if notes.is_empty() {
        return "<p>There are none: the scenario is one that this network was trained for.</p>\n"
            .to_owned();
    }
    let item = |note: &String| format!("<li>{}</li>\n", escaped(note));
    format!("<ul>\n{}</ul>\n", notes.iter().map(item).collect::<String>())
}
