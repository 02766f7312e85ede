//! GHW files, the waveforms of GHDL.
//!
//! The format is described by GHDL's `grt-waves.adb` and `libghw.c`. The crate `wellen` 0.25.7 counts the bits of a
//! slice from the wrong end, and panics where names share parts of their signals.

mod changes;
mod names;
mod range;
mod types;

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use tofsim::error::{Error, Result};

use crate::ila::read::NamedValue;

use super::names::Name;
use super::signals::{self, Axis, Signal, SignalKind, Source, SourceFormat, Words};
use super::span::{Checked, Fault, Span};
use super::stream::{Cursor, Feed};
use super::tick::Tick;
use changes::Values;
use names::{Names, Variable};
use types::{Scalar, Types};

/// Size of the file header, and the offsets of its byte order (2 for big-endian) and of its version [bytes].
const HEADER: u64 = 16;
const ORDER: usize = 12;
const VERSION: usize = 11;

/// Header of a file.
#[derive(Debug)]
struct Header {
    strings: Vec<String>,
    variables: Vec<Variable>,
    /// Encoding of each of the file's signals.
    scalars: Vec<Scalar>,
}

/// Path of a file, and the signals of each id.
#[derive(Clone, Debug)]
struct GhwOrigin {
    path: PathBuf,
    by_id: Vec<Vec<u32>>,
}

/// Opens the file at `path`.
pub(super) fn source(path: &Path) -> Result<Source> {
    let bytes = std::fs::read(path).map_err(Error::io(path, "read"))?;
    let read = check(&bytes).map_err(|fault| fault.of_file(path))?;
    let (Header { strings, variables, .. }, end) = read;
    let (mut ids, mut by_id, mut signals) = (HashMap::new(), Vec::new(), Vec::new());
    let mut tables: HashMap<Vec<usize>, Arc<[NamedValue]>> = HashMap::new();
    for variable in variables {
        let id = *ids.entry(variable.signals.clone()).or_insert_with(|| {
            by_id.push(variable.signals.clone());
            by_id.len() - 1
        });
        let states = match tables.get(&variable.literals) {
            Some(states) => Arc::clone(states),
            None => {
                let states = states(&variable.literals, &strings);
                tables.insert(variable.literals.clone(), Arc::clone(&states));
                states
            }
        };
        signals.push(signal(&variable, states, id));
    }
    let origin = GhwOrigin { path: path.to_owned(), by_id };
    let (name, axis) = (path.display().to_string(), Axis::Time(Tick::FEMTOSECOND));
    Ok(Source { end, ..Source::new(name, SourceFormat::Ghw, axis, signals, origin) })
}

/// Parses a whole file, and returns its header and the time of its last step [fs].
fn check(bytes: &[u8]) -> Checked<(Header, Option<u64>)> {
    let mut file = Span::new(bytes, "file");
    let header = header(&mut file)?;
    let end = changes::read(&mut file, &header.scalars, &mut ())?;
    Ok((header, end))
}

/// Returns the names of an enumeration's values.
fn states(literals: &[usize], strings: &[String]) -> Arc<[NamedValue]> {
    let literals = literals.iter().zip(0..);
    let named = |(&literal, bits): (&usize, u64)| NamedValue {
        name: strings[literal].clone(),
        bits: Some(bits),
    };
    literals.map(named).collect()
}

fn signal(variable: &Variable, states: Arc<[NamedValue]>, id: usize) -> Signal {
    let (kind, width) = match variable.scalar {
        Scalar::Real => (SignalKind::Real, 64),
        Scalar::Number(width) | Scalar::Literal(width) if variable.signals.len() == 1 => {
            (SignalKind::Bits, width)
        }
        _ => (SignalKind::Bits, variable.signals.len() as u32),
    };
    let words = Words { width, mixed: false, states };
    let (scopes, own, range) = (Arc::clone(&variable.scopes), variable.own.clone(), variable.range);
    let path: Vec<&str> = scopes.iter().chain([&own]).map(String::as_str).collect();
    let (name, lsb) = (Name::new(path.join(".")), range.map_or(0, |[_, lsb]| lsb));
    let (shape, description) = (None, None);
    Signal {
        name,
        scopes,
        own,
        width,
        lsb,
        range,
        kind,
        radix: None,
        shape,
        words,
        description,
        id,
    }
}

impl signals::Origin for GhwOrigin {
    fn read(&self, ids: &[usize], widths: &[u32]) -> Result<Cursor> {
        let (origin, ids) = (self.clone(), ids.to_vec());
        Ok(Cursor::spawn(widths, move |feed| origin.feed(&ids, feed)))
    }
}

impl GhwOrigin {
    /// Sends the changes of the signals with the given ids.
    fn feed(&self, ids: &[usize], feed: &mut Feed) -> Result<()> {
        let bytes = std::fs::read(&self.path).map_err(Error::io(&self.path, "read"))?;
        let mut file = Span::new(&bytes, "file");
        let read = header(&mut file).and_then(|header| {
            let wanted: Vec<&[u32]> = ids.iter().map(|&id| &self.by_id[id][..]).collect();
            let mut values = Values::new(feed, &wanted, header.scalars.len());
            changes::read(&mut file, &header.scalars, &mut values)
        });
        read.map(drop).map_err(|fault| fault.of_file(&self.path))
    }
}

/// Parses a file up to the end of its header.
fn header(file: &mut Span) -> Checked<Header> {
    let head = file.take(HEADER)?;
    file.is_big = head[ORDER] == 2;
    let mut types = Types::new(head[VERSION]);
    let mut header =
        Header { strings: vec![String::new()], variables: Vec::new(), scalars: Vec::new() };
    loop {
        let place = file.place();
        let name = file.take(4)?;
        let parsed = match name {
            b"STR\0" => names::strings(file).map(|strings| header.strings = strings),
            b"TYP\0" => types.section(file, &header.strings),
            b"WKT\0" => known(file),
            b"HIE\0" => {
                let mut names = Names::new(&types, &header.strings);
                let parsed = names.section(file);
                (header.variables, header.scalars) = (names.variables, names.scalars);
                parsed
            }
            b"EOH\0" => return Ok(header),
            _ => Err(Fault::of("name", "expected STR, TYP, WKT, HIE or EOH")),
        };
        parsed.map_err(|fault| fault.within_section(name, place))?;
    }
}

fn known(file: &mut Span) -> Checked<()> {
    file.take(4)?;
    while file.byte()? != 0 {
        file.number()?;
    }
    Ok(())
}

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
