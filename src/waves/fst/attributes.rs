//! Attributes in the hierarchy of an FST file, each of which applies to the scope or the variable after it.

use super::super::sources::{ScopeSource, Stem};
use super::blocks::number;

/// Start of an attribute, and the type of all that are written here: miscellaneous.
const ATTRIBUTE: [u8; 2] = [252, 0];
/// Longest comment; readers take 69,632 bytes [bytes].
const COMMENT: usize = 1 << 16;

/// Subtype of an attribute.
#[derive(Clone, Copy)]
enum Kind {
    Comment = 0,
    /// Type of the next variable; VHDL's tools write the name of a type into it.
    Type = 2,
    Path = 3,
    /// Line that declares the next scope's module.
    Declared = 4,
    /// Line that instantiates it.
    Instantiated = 5,
    States = 7,
}

/// Appends a comment, in several parts if it is longer than readers take.
pub(super) fn comment(bytes: &mut Vec<u8>, text: &str) {
    // A zero ends a comment, and tools print it on one line.
    let text = text.replace(['\0', '\n', '\r'], " ");
    let mut rest = &*text;
    while !rest.is_empty() {
        let part = &rest[..rest.floor_char_boundary(COMMENT)];
        rest = &rest[part.len()..];
        attribute(bytes, Kind::Comment, part.as_bytes(), 0);
    }
}

/// Appends the type of the next variable, if it is known.
pub(super) fn value_type(bytes: &mut Vec<u8>, name: &str) {
    let no_type_of_vhdl = 0;
    if !name.is_empty() {
        attribute(bytes, Kind::Type, name.as_bytes(), no_type_of_vhdl);
    }
}

/// Appends a table of states, or with an empty text the table of the next variable.
pub(super) fn states(bytes: &mut Vec<u8>, text: &str, table: u64) {
    attribute(bytes, Kind::States, text.as_bytes(), table);
}

/// Appends the places of the next scope in the source.
pub(super) fn source(bytes: &mut Vec<u8>, source: &ScopeSource) {
    for (path, text) in &source.paths {
        attribute(bytes, Kind::Path, text.as_bytes(), *path);
    }
    let stems = [(Kind::Declared, source.declared), (Kind::Instantiated, source.instantiated)];
    for (kind, stem) in stems {
        let Some((path, line)): Option<Stem> = stem else { continue };
        let mut text = Vec::new();
        number(&mut text, path);
        attribute(bytes, kind, &text, line.into());
    }
}

fn attribute(bytes: &mut Vec<u8>, kind: Kind, text: &[u8], value: u64) {
    bytes.extend(ATTRIBUTE);
    bytes.push(kind as u8);
    bytes.extend_from_slice(text);
    bytes.push(0);
    number(bytes, value);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_comment_is_cut_between_characters() {
        let mut bytes = Vec::new();
        comment(&mut bytes, &format!("a{}\n", "é".repeat(COMMENT / 2)));
        let first =
            [&[252, 0, 0, b'a'][..], "é".repeat(COMMENT / 2 - 1).as_bytes(), &[0, 0]].concat();
        assert!(bytes.starts_with(&first));
        assert_eq!(bytes[first.len()..], [252, 0, 0, 0xc3, 0xa9, b' ', 0, 0]);
    }

    #[test]
    fn a_stem_has_the_number_of_its_path_in_place_of_a_text() {
        let mut bytes = Vec::new();
        let paths = vec![(200, "a.v".to_owned())];
        let (declared, instantiated) = (Some((200, 300)), Some((10, 7)));
        source(&mut bytes, &ScopeSource { component: "a", paths, declared, instantiated });
        let path = [252, 0, 3, b'a', b'.', b'v', 0, 200, 1];
        let stems = [252, 0, 4, 200, 1, 0, 172, 2, 252, 0, 5, 10, 0, 7];
        assert_eq!(bytes, [&path[..], &stems].concat());
    }
}
