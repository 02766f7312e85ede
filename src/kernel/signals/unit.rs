//! Units and binary points of signals.

use std::fmt;

use crate::kernel::Time;

/// Unit of a value, and the place of its binary point.
///
/// Both are read from a signal's documentation when it is compiled: that of `Distance, 29 fraction bits [m].` has the
/// unit `m` and 29 fraction bits, and so has that of `Distance [2^-29 m].`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unit {
    /// Name in the documentation; empty if there is none.
    pub name: &'static str,
    /// Bits after the binary point that the documentation states.
    pub fraction: u32,
    /// Length of the unit, if it is one of a design's units of time.
    pub length: Option<Time>,
}

impl Unit {
    /// Reads the unit from a documentation.
    pub const fn of(doc: &'static str) -> Unit {
        let (before, mut name) = split(doc);
        let mut fraction = stated_fraction(before.trim_ascii_end());
        if let Some(power) = strip(name, "2^-") {
            let (bits, rest) = leading_number(power);
            (fraction, name) = (bits, rest.trim_ascii_start());
        }
        Unit { name, fraction, length: None }
    }

    /// Returns a documentation without the unit at its end and without a full stop.
    pub fn meaning(doc: &'static str) -> &'static str {
        split(doc).0.trim_end().trim_end_matches('.')
    }

    /// Replaces a unit of time of a design, whose bins have the length `bin` and `digits` binary digits, by the length
    /// of a bin.
    pub fn in_design(self, bin: Time, digits: u32) -> Unit {
        let below = match self.name {
            "bins" => 0,
            "units" => digits,
            "half units" => digits + 1,
            "units / 16" => digits + 4,
            _ => return self,
        };
        Unit { fraction: self.fraction + below, length: Some(bin), ..self }
    }

    /// Formats the unit of a number that is shown without its last fraction bits: with all of them, that of the integer.
    pub fn without(&self, bits: u32) -> String {
        match self.length {
            _ if bits == 0 => self.to_string(),
            Some(length) => {
                format!("{} ps", length.fs() as f64 * f64::powi(0.5, bits as i32) / 1e3)
            }
            None => format!("2^-{bits} {}", self.name).trim_end().to_owned(),
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.length {
            None => f.write_str(self.name),
            Some(length) => write!(f, "{} ps", length.fs() as f64 / 1e3),
        }
    }
}

/// Splits a documentation into the text before its unit, and the unit without brackets.
const fn split(doc: &'static str) -> (&'static str, &'static str) {
    let (text, bytes) = (doc.trim_ascii(), doc.trim_ascii().as_bytes());
    let mut end = bytes.len();
    if end > 0 && bytes[end - 1] == b'.' {
        end -= 1;
    }
    if end == 0 || bytes[end - 1] != b']' {
        return (text, "");
    }
    let mut begin = end - 1;
    while begin > 0 && bytes[begin] != b'[' {
        begin -= 1;
    }
    // A link to another item is no unit.
    if bytes[begin + 1] == b'`' {
        return (text, "");
    }
    (text.split_at(begin).0, text.split_at(end - 1).0.split_at(begin + 1).1)
}

/// Returns the number before the words `fraction bits` at the end of a text, and 0 without them.
const fn stated_fraction(text: &str) -> u32 {
    let (words, bytes) = (b" fraction bits", text.as_bytes());
    let mut end = bytes.len();
    if end > 0 && bytes[end - 1] == b'.' {
        end -= 1;
    }
    let mut left = words.len();
    while left > 0 && end > 0 {
        if bytes[end - 1] != words[left - 1] {
            return 0;
        }
        (left, end) = (left - 1, end - 1);
    }
    let mut begin = end;
    while begin > 0 && bytes[begin - 1].is_ascii_digit() {
        begin -= 1;
    }
    leading_number(text.split_at(begin).1).0
}

/// Strips `start` from a text.
const fn strip(text: &'static str, start: &str) -> Option<&'static str> {
    let mut place = 0;
    while place < start.len() {
        if place >= text.len() || text.as_bytes()[place] != start.as_bytes()[place] {
            return None;
        }
        place += 1;
    }
    Some(text.split_at(start.len()).1)
}

/// Parses the digits at the start of a text, and returns their number and the rest.
const fn leading_number(text: &str) -> (u32, &str) {
    let (mut number, mut place) = (0, 0);
    while place < text.len() && text.as_bytes()[place].is_ascii_digit() {
        number = 10 * number + (text.as_bytes()[place] - b'0') as u32;
        place += 1;
    }
    (number, text.split_at(place).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(doc: &'static str) -> (&'static str, u32) {
        let unit = Unit::of(doc);
        (unit.name, unit.fraction)
    }

    #[test]
    fn a_documentation_states_unit_and_fraction() {
        assert_eq!(read("Time from the begin of bin 0 [units]."), ("units", 0));
        assert_eq!(read("S, 14 fraction bits [photons a shot]."), ("photons a shot", 14));
        assert_eq!(read("Its deviation [2^-29 m]."), ("m", 29));
        assert_eq!(read("Sum of v g, 4 fraction bits."), ("", 4));
        assert_eq!(read("Period [cycles of clk_sys]"), ("cycles of clk_sys", 0));
    }

    #[test]
    fn other_words_state_none() {
        for doc in [
            "",
            ".",
            "Synchronous reset.",
            "Reasons to reject the depth; see [`Status`].",
            "Sum of w s s z z, 3 fraction bits less than weights.",
            "Its standard deviation, with as many fraction bits.",
            "fraction bits",
        ] {
            assert_eq!(read(doc), ("", 0), "{doc}");
        }
    }

    #[test]
    fn a_meaning_has_no_unit() {
        assert_eq!(Unit::meaning("Time of the hit [bins]."), "Time of the hit");
        assert_eq!(Unit::meaning(" `n` is new; one cycle. "), "`n` is new; one cycle");
        assert_eq!(Unit::meaning("See [`Status`]."), "See [`Status`]");
    }

    #[test]
    fn times_of_a_design_are_in_bins_of_known_length() {
        let shown = |name, bin| {
            let unit = Unit { name, fraction: 1, length: None }.in_design(Time::from_fs(bin), 4);
            (unit.to_string(), unit.fraction)
        };
        assert_eq!(shown("bins", 25_000), ("25 ps".to_owned(), 1));
        assert_eq!(shown("units", 25_000), ("25 ps".to_owned(), 5));
        assert_eq!(shown("half units", 12_500), ("12.5 ps".to_owned(), 6));
        assert_eq!(shown("units / 16", 25_000), ("25 ps".to_owned(), 9));
        assert_eq!(shown("hits", 25_000), ("hits".to_owned(), 1));
    }

    #[test]
    fn the_last_bit_has_a_unit_too() {
        let unit = |name| Unit { name, fraction: 0, length: None };
        assert_eq!(unit("units").in_design(Time::from_fs(25_000), 4).without(4), "1.5625 ps");
        assert_eq!([0, 29].map(|bits| unit("m").without(bits)), ["m", "2^-29 m"]);
        assert_eq!([0, 23].map(|bits| unit("").without(bits)), ["", "2^-23"]);
    }
}
