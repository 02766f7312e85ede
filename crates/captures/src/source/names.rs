//! Comparison of signal names as written by different tools.

use std::sync::Arc;

/// A signal's name: scopes and name, without range.
///
/// Simulators separate scopes by dots, Vivado by slashes; escaped names begin with a backslash; `gen[0]` may be a
/// scope. Names are equal if their parts are equal, regardless of case and of characters that Vivado's VCD has
/// underscores for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    /// Text, as written in the source.
    pub text: String,
    /// Its parts in common form, separated by dots; comparisons keep several copies.
    parts: Arc<str>,
}

impl Name {
    /// Creates a name from its text, without range.
    pub fn new(text: impl Into<String>) -> Self {
        let text = text.into();
        let bare = plain(&text).to_lowercase();
        let parts: Vec<&str> = bare.split(['.', '/']).filter(|part| !part.is_empty()).collect();
        let parts = parts.join(".").into();
        Name { text, parts }
    }

    /// Returns the name relative to a scope within another scope of one part, if it lies within the first; the text
    /// remains.
    pub fn moved(&self, from: &str, to: &str) -> Option<Name> {
        Some(Name { text: self.text.clone(), parts: format!("{to}.{}", self.below(from)?).into() })
    }

    /// Returns all its parts, separated by dots.
    pub fn parts(&self) -> &str {
        &self.parts
    }

    /// Returns whether both names have the same parts.
    pub fn is(&self, other: &Name) -> bool {
        self.parts == other.parts
    }

    /// Returns the number of parts of the shorter name, if the longer one ends with them.
    pub fn common(&self, other: &Name) -> Option<usize> {
        let (long, short) =
            if self.parts.len() >= other.parts.len() { (self, other) } else { (other, self) };
        let before = long.parts.strip_suffix(&*short.parts)?;
        let is_end = before.is_empty() || before.ends_with('.');
        (!short.parts.is_empty() && is_end).then(|| short.depth())
    }

    /// Returns the number of equal parts at the end.
    pub fn tail(&self, other: &Name) -> usize {
        let (own, others) = (self.parts.rsplit('.'), other.parts.rsplit('.'));
        own.zip(others).take_while(|(own, other)| own == other && !own.is_empty()).count()
    }

    /// Returns whether the last parts are equal, including case.
    pub fn ends_exactly_as(&self, other: &Name) -> bool {
        let last = |name: &Name| name.text.rsplit(['.', '/', '\\']).next().map(str::to_owned);
        last(self) == last(other)
    }

    /// Returns the name without its last `count` parts; empty if it has no more parts.
    pub fn scope(&self, count: usize) -> &str {
        let mut scope = &*self.parts;
        for _ in 0..count {
            scope = scope.rsplit_once('.').map_or("", |(scope, _)| scope);
        }
        scope
    }

    /// Returns the name relative to a scope, if it lies within the scope.
    pub fn below(&self, scope: &str) -> Option<&str> {
        match scope {
            "" => Some(&self.parts),
            _ => self.parts.strip_prefix(scope)?.strip_prefix('.'),
        }
    }

    /// Returns the last part in lower case.
    pub fn last(&self) -> &str {
        self.parts.rsplit('.').next().unwrap_or_default()
    }

    /// Returns the number of parts.
    pub fn depth(&self) -> usize {
        self.parts.split('.').filter(|part| !part.is_empty()).count()
    }
}

/// Returns a name without backslashes and blanks, and with underscores for what is no part of a Verilog name.
fn plain(text: &str) -> String {
    let mut depth = 0u32;
    let mut plain = |character: char| match character {
        '\\' | ' ' => None,
        '[' => {
            depth += 1;
            Some('[')
        }
        ']' => {
            depth = depth.saturating_sub(1);
            Some(']')
        }
        '.' | '/' | '$' | '*' | '_' => Some(character),
        _ if depth > 0 || character.is_alphanumeric() => Some(character),
        _ => Some('_'),
    };
    text.chars().filter_map(&mut plain).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separators_case_and_escapes_make_no_difference() {
        let ours = Name::new("tof_top.tdc.tdc_latch.hit");
        assert!(ours.is(&Name::new("tof_top/tdc/TDC_latch/hit")));
        assert!(Name::new("\\a/b[3]").is(&Name::new("a.b[3]")));
        assert!(!ours.is(&Name::new("tdc.tdc_latch.hit")));
    }

    #[test]
    fn a_view_has_the_name_that_vivado_s_vcd_gives_it() {
        let view = Name::new("View_(i1:s0)_(port_a)");
        assert!(view.is(&Name::new("View__i1_s0___port_a_")));
        assert!(Name::new("gen(2)/a-b<1>").is(&Name::new("gen_2_/a_b_1_")));
        assert!(!Name::new("a[3:0]").is(&Name::new("a[3_0]")));
    }

    #[test]
    fn a_suffix_ends_at_a_separator() {
        let ours = Name::new("tof_top.tdc.tdc_latch.hit");
        assert_eq!(ours.common(&Name::new("tdc_latch/hit")), Some(2));
        assert_eq!(Name::new("hit").common(&ours), Some(1));
        assert_eq!(ours.common(&Name::new("latch.hit")), None);
        assert_eq!(ours.common(&Name::new("")), None);
        assert_eq!(Name::new("").common(&Name::new("")), None);
    }

    #[test]
    fn a_name_is_cut_at_its_separators() {
        let ours = Name::new("tof_top.tdc.Hit");
        assert_eq!(
            (ours.scope(0), ours.scope(1), ours.scope(3)),
            ("tof_top.tdc.hit", "tof_top.tdc", "")
        );
        assert_eq!(
            (ours.below("tof_top"), ours.below(""), ours.below("tof")),
            (Some("tdc.hit"), Some("tof_top.tdc.hit"), None)
        );
        assert_eq!((ours.last(), ours.depth(), Name::new("").depth()), ("hit", 3, 0));
        assert_eq!(
            (ours.tail(&Name::new("x.tdc.hit")), Name::new("").tail(&Name::new(""))),
            (2, 0)
        );
        let moved = ours.moved("tof_top", "*").unwrap();
        assert_eq!((moved.parts(), moved.text.as_str()), ("*.tdc.hit", "tof_top.tdc.Hit"));
    }
}
