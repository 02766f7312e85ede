//! Nesting of scopes in a waveform's header.

use crate::hierarchy::Entry;

/// An element of a header's hierarchy, with signals of a type `T`.
pub(super) enum Element<'a, T> {
    /// Start of a scope within the current one.
    Enter(&'a str),
    /// End of the current scope.
    Leave,
    /// Signal in the current scope.
    Signal(&'a T),
}

/// Lists the elements of the hierarchy of `entries`, in which the signals of a scope are adjacent.
pub(super) fn elements(entries: &[Entry]) -> Vec<Element<'_, Entry>> {
    nested(entries, |entry| entry.scope.split('.').collect())
}

/// Lists the elements of the hierarchy of any signals, given each one's scopes, outermost first.
pub(super) fn nested<'a, T>(
    signals: &'a [T],
    scopes: impl Fn(&'a T) -> Vec<&'a str>,
) -> Vec<Element<'a, T>> {
    let mut elements = Vec::new();
    let mut open: Vec<&str> = Vec::new();
    for entry in signals {
        let scope = scopes(entry);
        let common = open.iter().zip(&scope).take_while(|(a, b)| a == b).count();
        elements.extend(open[common..].iter().map(|_| Element::Leave));
        elements.extend(scope[common..].iter().map(|name| Element::Enter(name)));
        elements.push(Element::Signal(entry));
        open = scope;
    }
    elements.extend(open.iter().map(|_| Element::Leave));
    elements
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hierarchy::ram_entries;

    #[test]
    fn scopes_open_and_close_as_they_nest() {
        let at = |scope: &str| Entry {
            scope: scope.into(),
            ..ram_entries(&Default::default())[0].clone()
        };
        let entries = ["a", "a.b.c", "a.b.c", "a.d"].map(at);
        let elements = elements(&entries);
        let text = elements.iter().map(|element| match element {
            Element::Enter(name) => name,
            Element::Leave => "<",
            Element::Signal(_) => "*",
        });
        assert_eq!(text.collect::<String>(), "a*bc**<<d*<<");
    }
}
