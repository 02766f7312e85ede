//! Header rows of a CSV: names, ranges and radices.

use std::collections::HashSet;

use tofsim::error::Result;

use super::super::capture::Radix;
use super::opened::{Column, WIDEST_PROBE, WIDEST_SAMPLE};
use super::table::Row;

/// First columns of every CSV.
pub(super) const FIXED: [&str; 3] = ["Sample in Buffer", "Sample in Window", "TRIGGER"];
/// Largest number of probes.
const MOST_PROBES: usize = 1 << 14;
/// Prefix of the row of radices, directly followed by the first radix.
const MARK: &[u8] = b"Radix - ";

/// Note on empty fields that spreadsheets add.
pub(super) const TRAIL: &str = "empty fields at the end of lines are left out";

/// Contents of the header rows.
pub(super) struct Header {
    pub(super) columns: Vec<Column>,
    /// Whether there is a row of radices.
    pub(super) radix_row: bool,
    /// Whether the fourth column marks gaps.
    pub(super) gap: bool,
    /// Field separator.
    pub(super) delimiter: u8,
    /// Notes on deviations from Vivado's format.
    pub(super) notes: Vec<String>,
}

impl Header {
    /// Parses the first lines of a file.
    pub(super) fn read(source: &str, [head, second]: &[Vec<u8>; 2]) -> Result<Self> {
        let mark = "\u{feff}".as_bytes();
        let bare = head.strip_prefix(mark);
        let head = bare.unwrap_or(head);
        let (delimiter, mut notes) = delimiter(head);
        if bare.is_some() {
            notes.push("a byte order mark at the begin is passed over".to_owned());
        }
        let mut header = Row::new(source, 1, head, delimiter);
        if header.take_trail() {
            notes.push(TRAIL.to_owned());
        }
        if let Some(wrong) = FIXED.iter().enumerate().position(|(k, name)| !header.is(k, name)) {
            let expected = format!("expected a head that begins with `{}`", FIXED.join(","));
            return Err(header.fault(wrong, expected).into());
        }
        let mut radices = Row::new(source, 2, second, delimiter);
        let radix_row = radices.field(0).starts_with(MARK);
        radices.take_trail();
        // chipscopy leaves GAP out of the radices; Vivado gives a net of that name one like HEX.
        let short = radices.len() + 1 == header.len();
        let gap = radix_row && header.is(3, "GAP") && (short || radices.is(3, "UNSIGNED"));
        let first = FIXED.len() + gap as usize;
        if radix_row {
            check_radices(&radices, header.len() - (gap && short) as usize)?;
        }
        if !(first + 1..=first + MOST_PROBES).contains(&header.len()) {
            let text = format!("{} probes, expected 1 to {MOST_PROBES}", header.len() - first);
            return Err(header.row_fault(text).into());
        }
        let mut columns = Vec::new();
        let (mut names, mut width) = (HashSet::new(), 0);
        for index in first..header.len() {
            let fault = |text: String| header.fault(index, text);
            let head = header.text(index)?;
            let mut column = parse(&head).map_err(fault)?;
            if !names.insert(head) {
                return Err(fault("a second column of this name".into()).into());
            }
            width += column.width;
            if width > WIDEST_SAMPLE {
                return Err(fault(format!("more than {WIDEST_SAMPLE} bits in a sample")).into());
            }
            if radix_row {
                let index = index - (gap && short) as usize;
                let Some(radix) = radix(&radices.field(index)) else {
                    let expected = "expected HEX, SIGNED, UNSIGNED, BINARY, OCTAL or ASCII";
                    return Err(radices.fault(index, expected).field(column.head()).into());
                };
                (column.radix, column.text) = (radix, radix.is_none());
            }
            columns.push(column);
        }
        Ok(Header { columns, radix_row, gap, delimiter, notes })
    }
}

/// Detects the field separator by the first line, with notes.
fn delimiter(head: &[u8]) -> (u8, Vec<String>) {
    let first = FIXED[0].as_bytes();
    let bare = head.strip_prefix(b"\"").unwrap_or(head);
    let after = bare.get(first.len()..).unwrap_or_default();
    let after = after.strip_prefix(b"\"").unwrap_or(after);
    match after.first() {
        Some(b';') => (b';', vec!["fields are separated by ; instead of commas".to_owned()]),
        Some(b'\t') => (b'\t', vec!["fields are separated by tabs instead of commas".to_owned()]),
        _ => (b',', Vec::new()),
    }
}

/// Checks the number of radices, and those of the fixed columns.
fn check_radices(radices: &Row, expected: usize) -> Result<()> {
    if radices.len() != expected {
        let text = format!("{} radices, expected {expected}", radices.len());
        return Err(radices.row_fault(text).into());
    }
    for (index, word) in ["Radix - UNSIGNED", "UNSIGNED", "UNSIGNED"].iter().enumerate() {
        if !radices.is(index, word) {
            return Err(radices.fault(index, format!("expected `{word}`")).into());
        }
    }
    Ok(())
}

/// Parses a radix; columns of words have none.
fn radix(word: &[u8]) -> Option<Option<Radix>> {
    if word == b"ASCII" { Some(None) } else { str::from_utf8(word).ok()?.parse().ok().map(Some) }
}

/// Parses name and range of a column head.
///
/// # Errors
/// Description of what was expected.
pub(super) fn parse(head: &str) -> std::result::Result<Column, String> {
    let (name, lsb, width, vector) = match range(head) {
        None => (head, 0, 1, false),
        Some((name, msb, lsb)) => {
            let width = match (msb.parse::<u32>(), lsb.parse::<u32>()) {
                (Ok(msb), Ok(lsb)) if msb >= lsb && msb - lsb < WIDEST_PROBE => msb - lsb + 1,
                _ => {
                    let most = WIDEST_PROBE;
                    return Err(format!("expected a range [msb:lsb] of 1 to {most} bits"));
                }
            };
            (name, lsb.parse().unwrap_or_default(), width, true)
        }
    };
    if name.is_empty() {
        return Err("expected the name of a probe".into());
    }
    let name = name.to_owned();
    Ok(Column { name, width, lsb, vector, ..Column::default() })
}

/// Splits `name[msb:lsb]`. Any other text in brackets belongs to the name.
fn range(head: &str) -> Option<(&str, &str, &str)> {
    let (name, range) = head.strip_suffix(']')?.rsplit_once('[')?;
    let (msb, lsb) = range.split_once(':')?;
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    (digits(msb) && digits(lsb)).then_some((name, msb, lsb))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(lines: [&str; 2]) -> std::result::Result<Header, String> {
        Header::read("a.csv", &lines.map(|line| line.as_bytes().to_vec()))
            .map_err(|error| error.to_string())
    }

    fn fault(probes: &str) -> String {
        let head = format!("Sample in Buffer,Sample in Window,TRIGGER,{probes}");
        header([&head, ""]).err().unwrap()
    }

    #[test]
    fn ranges_are_told_from_names() {
        let split = |head| {
            let column = parse(head).unwrap();
            (column.name, column.width, column.lsb, column.vector)
        };
        assert_eq!(split("a/b[15:4]"), ("a/b".into(), 12, 4, true));
        assert_eq!(split("one[0:0]"), ("one".into(), 1, 0, true));
        assert_eq!(split("r[3][7:0]"), ("r[3]".into(), 8, 0, true));
        for name in ["r[4]", "<const0>_17", "\\x ", "Interface_(i1:s0)_(axi)", "a[i:j]", "b]"] {
            assert_eq!(split(name), (name.into(), 1, 0, false));
        }
        assert_eq!(split("top[4294967295:4294967290]").1, 6);
        for head in ["a[0:15]", "a[99999999999:0]", "a[4096:0]", "[3:0]", ""] {
            assert!(parse(head).is_err(), "{head}");
        }
    }

    #[test]
    fn what_is_wrong_in_the_head_is_told_with_its_column() {
        assert!(fault("a,b[0:15]").starts_with("a.csv:1:45: b[0:15]: expected a range"));
        assert!(
            fault("\"a,\"\"b\",,c").starts_with("a.csv:1:51: \"\": expected the name of a probe")
        );
        assert!(fault("a,a").starts_with("a.csv:1:45: a: a second column of this name"));
        let wide: Vec<_> = (0..257).map(|place| format!("a{place}[4095:0]")).collect();
        assert!(fault(&wide.join(",")).ends_with("more than 1048576 bits in a sample"));
        let head = ["Sample in Buffer,Sample in Window,TRIGGER", ""];
        assert!(header(head).err().unwrap().ends_with("0 probes, expected 1 to 16384"));
        let head = ["Sample in Buffer,Window,TRIGGER,a", ""];
        let expected = "a.csv:1:18: Window: expected a head that begins with `Sample in Buffer,";
        assert!(header(head).err().unwrap().starts_with(expected));
        assert!(header(["", ""]).err().unwrap().contains("expected a head that begins with"));
    }

    #[test]
    fn a_fourth_column_named_gap_is_a_probe_if_its_radix_is_one() {
        let head = "Sample in Buffer,Sample in Window,TRIGGER,GAP,a";
        let told = |radices: &str| {
            let radices = format!("Radix - UNSIGNED,UNSIGNED,UNSIGNED,{radices}");
            let header = header([head, &radices]).unwrap();
            (header.gap, header.columns.len())
        };
        assert_eq!(told("HEX"), (true, 1));
        assert_eq!(told("UNSIGNED,HEX"), (true, 1));
        assert_eq!(told("HEX,HEX"), (false, 2));
        assert!(!header([head, ""]).unwrap().gap);
    }
}
