//! Messages in lines that fit the terminal.

use std::fmt::Display;
use std::io::stderr;

use terminal_size::{Width, terminal_size_of};

use tofsim::error::tell;

/// Prints a message on standard error, in lines that are no longer than the terminal is wide.
pub fn message(text: impl Display) {
    let text = text.to_string();
    match terminal_size_of(stderr()) {
        Some((Width(columns), _)) => tell(wrapped(&text, columns.into(), ["", "  "])),
        None => tell(text),
    }
}

/// Breaks each line of a text that is longer than `width` at blanks. `first` precedes each line of the text, and `rest`
/// the lines that follow from a break. A longer word stays whole.
pub fn wrapped(text: &str, width: usize, [first, rest]: [&str; 2]) -> String {
    let mut lines = Vec::new();
    for whole in text.split('\n') {
        let mut line = first.to_owned();
        let mut is_begun = false;
        for word in whole.split(' ') {
            if is_begun && line.chars().count() + 1 + word.chars().count() > width {
                lines.push(std::mem::replace(&mut line, rest.to_owned()));
            } else if is_begun {
                line.push(' ');
            }
            line += word;
            is_begun = true;
        }
        lines.push(line);
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_broken_at_blanks_and_indented() {
        let text = "note: one two three\nfour";
        assert_eq!(wrapped(text, 80, ["", "  "]), text);
        assert_eq!(wrapped(text, 13, ["", "  "]), "note: one two\n  three\nfour");
        assert_eq!(wrapped(text, 1, ["", "  "]).lines().count(), 5);
        assert_eq!(wrapped("a b  c", 80, ["  ", "    "]), "  a b  c");
    }

    #[test]
    fn a_line_is_no_longer_than_the_terminal() {
        let text = wrapped(&"word ".repeat(40), 80, ["  ", "    "]);
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
        assert!(text.lines().count() > 2, "{text}");
    }
}
