//! Comments in the names of an FST file.

use std::collections::HashMap;

/// Comments on a file and on its variables.
#[derive(Debug, Default)]
pub(crate) struct Comments {
    /// Those that do not stand directly before a variable.
    pub(crate) on_file: Vec<String>,
    /// Those that do, by the path of the variable without its range.
    pub(crate) on_signals: HashMap<String, String>,
    /// Those since the last name.
    pending: Vec<String>,
    /// Path of the scope with a final dot, and the lengths of those around it.
    path: String,
    around: Vec<usize>,
}

impl Comments {
    /// Adds a comment.
    pub(super) fn add(&mut self, text: &[u8]) {
        self.pending.push(String::from_utf8_lossy(text).into_owned());
    }

    /// Enters a scope.
    pub(super) fn enter(&mut self, name: &[u8]) {
        self.on_file.append(&mut self.pending);
        self.around.push(self.path.len());
        self.path += &format!("{}.", String::from_utf8_lossy(name));
    }

    /// Leaves a scope.
    pub(super) fn leave(&mut self) {
        self.on_file.append(&mut self.pending);
        self.path.truncate(self.around.pop().unwrap_or_default());
    }

    /// Assigns the last comments to a variable.
    pub(super) fn variable(&mut self, name: &[u8]) {
        if self.pending.is_empty() {
            return;
        }
        let name = String::from_utf8_lossy(name);
        let own = name.split([' ', '[']).next().unwrap_or_default();
        let text = std::mem::take(&mut self.pending).join(" ");
        self.on_signals.insert(format!("{}{own}", self.path), text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comment_belongs_to_the_variable_after_it_or_to_the_file() {
        let mut comments = Comments::default();
        comments.add(b"seed 1");
        comments.enter(b"top");
        comments.variable(b"clk");
        comments.enter(b"a");
        comments.add(b"Count");
        comments.variable(b"n [7:0]");
        comments.leave();
        comments.leave();
        comments.leave();
        comments.enter(b"b");
        comments.add(b"Word");
        comments.variable(b"w[7:0]");
        assert_eq!(comments.on_file, ["seed 1"]);
        let mut signals: Vec<_> = comments.on_signals.into_iter().collect();
        signals.sort();
        let expected = [("b.w", "Word"), ("top.a.n", "Count")];
        assert_eq!(signals, expected.map(|(name, text)| (name.to_owned(), text.to_owned())));
    }
}
