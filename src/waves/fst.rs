//! FST files: the header by the crate `fst-writer`, the body by hand, for speed.
//!
//! It has no place for comments, so the provenance is in the version string, as far as it fits;
//! nor for state names, which a file beside the waveform gives (see [`super::write_views`]).

use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};

use fst_writer::{
    FstFileType, FstHeaderWriter, FstInfo, FstScopeType, FstSignalType, FstVarDirection,
    FstVarType, FstWriteError,
};

use crate::error::{Error, Result};
use crate::files::date;
use crate::hierarchy::{Entry, IDS, Kind};
use crate::kernel::Thermometer;
use crate::kernel::signals::Sink;

use super::digits::TapDigits;
use super::scopes::{Element, elements};
use super::spool::Spool;
use super::{Body, Step};

mod body;

use body::Changes;

/// Longest version string that the format holds [bytes].
const VERSION: usize = 127;

/// An FST file being written.
pub(super) struct Fst {
    path: PathBuf,
    changes: Changes<Spool>,
    /// Place in the file's order by id; what is not selected is `None`.
    signals: Vec<Option<usize>>,
    taps: TapDigits,
    /// The taps as the file has them.
    bytes: Vec<u8>,
    /// Time of this step, as long as nothing has changed at it [ps].
    pending: Option<u64>,
    /// The first error of this step.
    fault: Option<io::Error>,
}

impl Fst {
    /// Begins a file.
    pub(super) fn create(
        path: &Path,
        entries: &[Entry],
        order: &[u16],
        provenance: &[String],
    ) -> Result<Self> {
        let info = FstInfo {
            start_time: 0,
            timescale_exponent: -12,
            version: version(provenance),
            date: date::fixed()?.unwrap_or_default(),
            file_type: FstFileType::Verilog,
        };
        let (mut signals, mut widths) = (vec![None; IDS], Vec::new());
        let fault = Error::io(path, "write");
        let header = header(&info, entries, &mut signals, &mut widths);
        let mut file = Spool::create(path)?;
        header.map_err(plain).and_then(|header| file.write_all(&header)).map_err(fault)?;
        Ok(Fst {
            path: path.to_owned(),
            changes: Changes::new(file, &widths),
            signals,
            taps: TapDigits::new(order),
            bytes: Vec::new(),
            pending: None,
            fault: None,
        })
    }

    /// Something changes.
    #[inline]
    fn begin(&mut self) {
        if let Some(at) = self.pending.take()
            && let Err(error) = self.changes.begin(at)
        {
            self.fault.get_or_insert(error);
        }
    }
}

impl Sink for Fst {
    #[inline]
    fn word(&mut self, id: usize, value: u64) {
        let Some(signal) = self.signals[id] else { return };
        self.begin();
        self.changes.word(signal, value);
    }

    fn taps<const N: usize>(&mut self, id: usize, value: &Thermometer<N>) {
        let Some(signal) = self.signals[id] else { return };
        self.begin();
        self.bytes.clear();
        let (words, shift) = (self.taps.words(value), N.next_multiple_of(8) - N);
        for (place, &word) in words.iter().enumerate().rev() {
            let below = if place > 0 { words[place - 1] } else { 0 };
            let both = u128::from(word) << 64 | u128::from(below);
            self.bytes.extend_from_slice(&((both << shift >> 64) as u64).to_be_bytes());
        }
        let begin = self.bytes.len() - N.div_ceil(8);
        self.changes.change(signal, &self.bytes[begin..]);
    }
}

impl Body for Fst {
    #[inline]
    fn step(&mut self, at: u64, _: Step, fill: impl FnOnce(&mut Self)) -> io::Result<()> {
        self.pending = Some(at);
        fill(self);
        self.fault.take().map_or(Ok(()), Err)
    }

    fn unknown(&mut self) {
        self.begin();
        self.changes.unknown();
    }

    fn finish(self, at: u64) -> Result<()> {
        // Readers take the values of the first time step only if there is a second one.
        let done = self.changes.finish(at.max(1));
        done.map_err(|error| Error::io(&self.path, "write")(error))?.commit()
    }

    fn fault(&self, source: io::Error) -> Error {
        Error::io(&self.path, "write")(source)
    }
}

/// All that comes before the first section of changes; the place of each signal that is selected,
/// and the width of each place.
fn header(
    info: &FstInfo,
    entries: &[Entry],
    signals: &mut [Option<usize>],
    widths: &mut Vec<usize>,
) -> fst_writer::Result<Vec<u8>> {
    let mut fst = FstHeaderWriter::new(Cursor::new(Vec::new()), info)?;
    let mut handles = vec![None; signals.len()];
    for element in elements(entries) {
        match element {
            Element::Enter(name) => fst.scope(name, "", FstScopeType::Module)?,
            Element::Leave => fst.up_scope()?,
            Element::Signal(Entry { signal, kind, id, .. }) => {
                let (variable, direction) = match kind {
                    Kind::Input => (FstVarType::Wire, FstVarDirection::Input),
                    Kind::Output => (FstVarType::Wire, FstVarDirection::Output),
                    Kind::Internal => (FstVarType::Reg, FstVarDirection::Implicit),
                };
                let name = match signal.width {
                    1 => signal.name.clone(),
                    width => format!("{} [{}:0]", signal.name, width - 1),
                };
                let shape = FstSignalType::bit_vec(signal.width);
                handles[*id] = Some(fst.var(name, shape, variable, direction, handles[*id])?);
                if signals[*id].is_none() {
                    signals[*id] = Some(widths.len());
                    widths.push(signal.width as usize);
                }
            }
        }
    }
    let mut bytes = fst.finish()?.finish()?.into_inner();
    bytes.truncate(sections_begin(&bytes));
    Ok(bytes)
}

/// Where the first section of changes begins, of which the crate has made one without any: after
/// the blocks, each a type and a length without that type, for header, hierarchy and geometry.
fn sections_begin(bytes: &[u8]) -> usize {
    let mut place = 0;
    while let Some((&kind, rest)) = bytes[place..].split_first()
        && kind != body::SECTION
        && let Some(length) = rest.first_chunk()
    {
        place += 1 + u64::from_be_bytes(*length) as usize;
    }
    place
}

/// Program, version and provenance in one line of limited length.
fn version(provenance: &[String]) -> String {
    let mut version = concat!("tofsim ", env!("CARGO_PKG_VERSION")).to_owned();
    for line in provenance {
        version.push_str("; ");
        version.push_str(line);
    }
    let mut end = version.len().min(VERSION);
    while !version.is_char_boundary(end) {
        end -= 1;
    }
    version[..end].replace('\0', " ")
}

/// The error of the system inside the crate's.
fn plain(error: FstWriteError) -> io::Error {
    match error {
        FstWriteError::Io(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn provenance_goes_into_the_version_as_far_as_it_fits() {
        let short = version(&["scenario kc705".into(), "seed 1".into()]);
        assert!(short.starts_with("tofsim ") && short.ends_with("; scenario kc705; seed 1"));
        assert_eq!(version(&["é".repeat(100)]).len() / 2, VERSION / 2);
    }
}
