//! Counts in the heads of a GHW file's sections, for which the library would make room unseen.

use std::io::{self, Read, Seek};

use tofsim::error::Input;

/// Sections, and how many words behind their zeros is the count of what they hold.
const SECTIONS: [(&[u8; 4], usize); 4] =
    [(b"STR\0", 0), (b"TYP\0", 0), (b"HIE\0", 1), (b"HIE\0", 2)];
/// Where the file says in which order its bytes stand: 2 for the highest first.
const ORDER: usize = 12;

/// That no section says that it holds more things than the file has bytes.
pub(super) fn check(source: &str, file: &mut (impl Read + Seek)) -> io::Result<Result<(), Input>> {
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    file.rewind()?;
    let big = bytes.get(ORDER) == Some(&2);
    for (name, word) in SECTIONS {
        for place in positions(&bytes, name) {
            let first = place + 8 + 4 * word;
            let Some(count) = bytes.get(first..first + 4) else { continue };
            let Ok(count) = <[u8; 4]>::try_from(count) else { continue };
            let count = if big { u32::from_be_bytes(count) } else { u32::from_le_bytes(count) };
            if count as usize > bytes.len() {
                let name = String::from_utf8_lossy(&name[..3]).into_owned();
                let expected = format!("expected {} at most, the bytes of the file", bytes.len());
                return Ok(Err(Input::new(source, expected).field(name).value(count)));
            }
        }
    }
    Ok(Ok(()))
}

/// Where a section begins: its name and four zeros.
fn positions<'a>(bytes: &'a [u8], name: &'a [u8; 4]) -> impl Iterator<Item = usize> + 'a {
    let windows = bytes.windows(8).enumerate();
    windows
        .filter(move |(_, window)| window[..4] == name[..] && window[4..] == [0; 4])
        .map(|(k, _)| k)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    const GHW: &[u8] = include_bytes!("../../tests/ghdl/counter.ghw");

    #[test]
    fn a_count_beyond_the_file_is_refused() {
        let checked = |bytes: &[u8]| check("a.ghw", &mut Cursor::new(bytes)).unwrap();
        assert_eq!(checked(GHW), Ok(()));
        for (name, word) in SECTIONS {
            let mut bytes = GHW.to_vec();
            let place = positions(GHW, name).next().unwrap();
            bytes[place + 8 + 4 * word + 3] = 1;
            let error = checked(&bytes).unwrap_err().to_string();
            assert!(error.contains("expected 804 at most"), "{error}");
        }
    }
}
