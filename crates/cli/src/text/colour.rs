//! Colour for what matters most: green for what is well, red for what is not.

use std::io::IsTerminal;

/// A word in its colour, if `out` is a terminal that shows colours and the user does not mind.
pub fn coloured(word: &str, is_well: bool, out: &impl IsTerminal) -> String {
    paint(word, is_well, out.is_terminal() && is_wanted(|name| std::env::var(name).ok()))
}

/// A table with the last word of each row after its header in its colour.
pub fn coloured_ends(table: &str, rows: &[(&str, bool)], out: &impl IsTerminal) -> String {
    let mut rows = [None].into_iter().chain(rows.iter().map(Some));
    let lines = table.lines().map(|line| match rows.next().flatten() {
        Some((word, is_well)) if line.ends_with(word) => {
            format!("{}{}", &line[..line.len() - word.len()], coloured(word, *is_well, out))
        }
        _ => line.to_owned(),
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Whether the environment lets us (<https://no-color.org>).
fn is_wanted(variable: impl Fn(&str) -> Option<String>) -> bool {
    let is_dumb = variable("TERM").is_some_and(|terminal| terminal == "dumb");
    variable("NO_COLOR").is_none_or(|value| value.is_empty()) && !is_dumb
}

fn paint(word: &str, is_well: bool, with_colour: bool) -> String {
    let colour = if is_well { "32" } else { "31" };
    if with_colour { format!("\x1b[{colour}m{word}\x1b[0m") } else { word.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_for_terminals_whose_user_wants_them() {
        assert_eq!(paint("pass", true, true), "\x1b[32mpass\x1b[0m");
        assert_eq!(paint("differs", false, true), "\x1b[31mdiffers\x1b[0m");
        assert_eq!(paint("pass", true, false), "pass");
        let with = |set: &'static str, to: &'static str| {
            is_wanted(move |name| (name == set).then(|| to.to_owned()))
        };
        assert!(with("TERM", "xterm") && with("NO_COLOR", ""));
        assert!(!with("NO_COLOR", "1") && !with("TERM", "dumb"));
    }
}
