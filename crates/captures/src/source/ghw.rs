//! Check of a GHW file's header before the library reads it, because wellen 0.25.7 allocates memory by the counts and
//! ranges that the file states.
//!
//! The format is described by GHDL's `grt-waves.adb`. Constructs that the library does not support are left to it.

mod types;

use super::span::{Checked, Fault, Span, at_most};

use types::Types;

/// Size of the file header, and the offsets of its byte order (2 for big-endian) and of its version [bytes].
const HEADER: u64 = 16;
const ORDER: usize = 12;
const VERSION: usize = 11;
/// Limit of the total length of all strings, which share prefixes [characters].
const CHARACTERS: u64 = 1 << 27;

/// Checks a file.
pub(super) fn check(bytes: &[u8]) -> Checked<()> {
    let mut file = Span::new(bytes, "file");
    let head = file.take(HEADER)?;
    file.is_big = head[ORDER] == 2;
    let mut types = Types::new(head[VERSION]);
    loop {
        let place = file.place();
        let name = file.take(4)?;
        let section = match name {
            b"STR\0" => strings(&mut file),
            b"TYP\0" => types.section(&mut file),
            b"WKT\0" => known(&mut file),
            b"HIE\0" => hierarchy(&mut file, &types),
            b"EOH\0" => return Ok(()),
            _ => Err(Fault::of("name", "expected STR, TYP, WKT, HIE or EOH")),
        };
        let name = String::from_utf8_lossy(name).trim_end_matches('\0').to_owned();
        section.map_err(|fault| fault.within(&format!("section {name} at byte {place}")))?;
    }
}

fn strings(file: &mut Span) -> Checked<()> {
    file.take(4)?;
    let count = file.items("strings")?;
    file.take(4)?;
    let (mut length, mut total) = (0u64, 0);
    // The section's end has the form of another string.
    for _ in 0..=count {
        let mut last = file.byte()?;
        while last > 31 && !(128..=159).contains(&last) {
            length += 1;
            last = file.byte()?;
        }
        total = at_most("characters of all strings", total + length, CHARACTERS)?;
        let (mut shared, mut shift) = (u64::from(last & 0x1f), 5);
        while last >= 128 {
            last = file.byte()?;
            shared |= u64::from(last & 0x1f) << shift;
            shift = 59.min(shift + 5);
        }
        length = length.min(shared);
    }
    Ok(())
}

fn known(file: &mut Span) -> Checked<()> {
    file.take(4)?;
    while file.byte()? != 0 {
        file.number()?;
    }
    Ok(())
}

fn hierarchy(file: &mut Span, types: &Types) -> Checked<()> {
    file.take(12)?;
    file.items("signals")?;
    loop {
        match file.byte()? {
            0 => return Ok(()),
            END_OF_SCOPE => {}
            GENERATE_FOR => {
                file.number()?;
                let index = types.of(file)?;
                types.value(file, index)?;
            }
            kind if SCOPES.contains(&kind) => drop(file.number()?),
            kind if SIGNALS.contains(&kind) => {
                file.number()?;
                let found = types.of(file)?;
                let signals = types.signals(found);
                at_most("signals of a name", signals, file.left())?;
                for _ in 0..signals {
                    file.number()?;
                }
            }
            kind => return Err(Fault::value("kind", kind.into(), "is none of GHDL's")),
        }
    }
}

/// Kinds of entries in the hierarchy.
const END_OF_SCOPE: u8 = 15;
const GENERATE_FOR: u8 = 5;
/// Kinds of scopes: block, generate, instance, package, process and generic.
const SCOPES: [u8; 6] = [3, 4, 6, 7, 13, 14];
const SIGNALS: std::ops::RangeInclusive<u8> = 16..=21;

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    const GHW: &[u8] = include_bytes!("../../tests/ghdl/counter.ghw");

    fn fault(bytes: &[u8]) -> String {
        check(bytes).unwrap_err().of_file(Path::new("a.ghw")).to_string()
    }

    fn section(name: &[u8]) -> usize {
        GHW.windows(4).position(|window| window == name).unwrap()
    }

    #[test]
    fn a_count_beyond_the_file_is_refused_with_its_section() {
        assert!(check(GHW).is_ok());
        for (name, word, field) in
            [(b"STR\0", 0, "strings"), (b"TYP\0", 0, "types"), (b"HIE\0", 2, "signals")]
        {
            let mut bytes = GHW.to_vec();
            let place = section(name);
            bytes[place + 8 + 4 * word + 3] = 1;
            let name = String::from_utf8_lossy(&name[..3]);
            let told = format!("a.ghw: section {name} at byte {place}: {field} = ");
            assert!(fault(&bytes).starts_with(&told), "{}", fault(&bytes));
        }
    }

    #[test]
    fn a_count_within_a_type_is_refused() {
        let place = section(b"TYP\0") + 12;
        for kind in [22, 28, 31, 32] {
            let mut bytes = GHW[..place].to_vec();
            bytes.extend([kind, 1]);
            bytes.extend([0xff, 0xff, 0xff, 0xff, 0x7f, 0, 0, 0, 0]);
            let told = fault(&bytes);
            assert!(told.contains("expected ") && told.contains(" at most"), "{kind}: {told}");
        }
    }
}
