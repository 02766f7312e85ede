//! The help of every command.

use crate::common::{empty, stdout};

/// Returns the help of a command and of all commands below it, each with the command's words.
fn helps(words: &[&str]) -> Vec<(String, String)> {
    let text = stdout(empty().path(), &[words, &["--help"]].concat());
    let listed = text.lines().skip_while(|line| *line != "Commands:").skip(1);
    let listed: Vec<_> = listed
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.strip_prefix("  ")?.split(' ').next())
        .filter(|name| !name.is_empty() && *name != "help")
        .collect();
    let below = listed.iter().flat_map(|name| helps(&[words, &[name]].concat()));
    [(words.join(" "), text.clone())].into_iter().chain(below).collect()
}

#[test]
fn examples_fit_80_columns() {
    let helps = helps(&[]);
    assert!(helps.len() > 30, "{}", helps.len());
    for (command, text) in helps {
        let examples = text.lines().skip_while(|line| *line != "Examples:").skip(1);
        for line in examples.take_while(|line| !line.is_empty()) {
            let begins = ["  tofsim ", "  cargo ", "  make ", "  litex_", "  vivado "];
            assert!(begins.iter().any(|begin| line.starts_with(begin)), "{command}: {line}");
            assert!(line.chars().count() <= 80, "{command}: {line}");
        }
    }
}
