//! FST files, by the crate `fst-writer`.
//!
//! It has no place for comments, so the provenance is in the version string, as far as it fits;
//! nor for state names, which a file beside the waveform gives (see [`super::write_views`]).

use std::io;
use std::path::{Path, PathBuf};

use fst_writer::{
    FstBodyWriter, FstFileType, FstHeaderWriter, FstInfo, FstScopeType, FstSignalId, FstSignalType,
    FstVarDirection, FstVarType, FstWriteError,
};

use crate::error::{Error, Result};
use crate::hierarchy::{Entry, IDS, Kind};
use crate::kernel::Thermometer;
use crate::kernel::signals::Sink;

use super::digits::{TapDigits, of_word};
use super::scopes::{Element, elements};
use super::spool::Spool;
use super::{Body, Step, date};

/// Changes gathered before they are compressed; the crate cannot address 4 GB [bytes].
const BLOCK: usize = 4 << 20;
/// Longest version string that the format holds [bytes].
const VERSION: usize = 127;

/// An FST file being written.
pub(super) struct Fst {
    path: PathBuf,
    out: Changes,
    /// By id; what is not selected is `None`.
    signals: Vec<Option<Signal>>,
    taps: TapDigits,
    /// As many `x` as the widest signal has bits.
    unknown: Vec<u8>,
}

#[derive(Clone, Copy)]
struct Signal {
    id: FstSignalId,
    width: usize,
}

/// The stream of changes.
struct Changes {
    body: FstBodyWriter<Spool>,
    /// Time of the last change [ps].
    last: u64,
    /// Time of this step, as long as nothing has changed at it [ps].
    pending: Option<u64>,
    /// The first error of this step.
    fault: Option<FstWriteError>,
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
        let mut signals = vec![None; IDS];
        let body = header(Spool::create(path)?, &info, entries, &mut signals)
            .map_err(|error| Error::io(path, "write")(plain(error)))?;
        let out = Changes { body, last: 0, pending: None, fault: None };
        let widest = signals.iter().flatten().map(|signal| signal.width).max();
        let unknown = vec![b'x'; widest.unwrap_or(0)];
        Ok(Fst { path: path.to_owned(), out, signals, taps: TapDigits::new(order), unknown })
    }
}

impl Sink for Fst {
    #[inline]
    fn word(&mut self, id: usize, value: u64) {
        let Some(signal) = self.signals[id] else { return };
        self.out.change(signal.id, &of_word(value)[64 - signal.width..]);
    }

    fn taps<const N: usize>(&mut self, id: usize, value: &Thermometer<N>) {
        let Some(signal) = self.signals[id] else { return };
        self.out.change(signal.id, self.taps.of(value));
    }
}

impl Body for Fst {
    #[inline]
    fn step(&mut self, at: u64, _: Step, fill: impl FnOnce(&mut Self)) -> io::Result<()> {
        self.out.pending = Some(at);
        fill(self);
        self.out.fault.take().map_or(Ok(()), |error| Err(plain(error)))
    }

    fn unknown(&mut self) {
        for signal in self.signals.iter().flatten() {
            self.out.change(signal.id, &self.unknown[..signal.width]);
        }
    }

    fn finish(mut self, at: u64) -> Result<()> {
        // Without a second time step the crate forgets the values of the first.
        let end = at.max(1);
        let done = self.out.begin(end).and_then(|()| self.out.body.finish());
        done.map_err(|error| Error::io(&self.path, "write")(plain(error)))?.commit()
    }

    fn fault(&self, source: io::Error) -> Error {
        Error::io(&self.path, "write")(source)
    }
}

impl Changes {
    #[inline]
    fn change(&mut self, signal: FstSignalId, digits: &[u8]) {
        let begun = self.pending.take().map_or(Ok(()), |at| self.begin(at));
        let changed = begun.and_then(|()| self.body.signal_change(signal, digits));
        if let (Err(error), None) = (changed, &self.fault) {
            self.fault = Some(error);
        }
    }

    /// A time step begins: the only moment at which the crate can flush.
    fn begin(&mut self, at: u64) -> fst_writer::Result<()> {
        if at > self.last && self.body.size() > BLOCK {
            self.body.flush()?;
        }
        self.last = at;
        self.body.time_change(at)
    }
}

fn header(
    file: Spool,
    info: &FstInfo,
    entries: &[Entry],
    signals: &mut [Option<Signal>],
) -> fst_writer::Result<FstBodyWriter<Spool>> {
    let mut fst = FstHeaderWriter::new(file, info)?;
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
                let alias = signals[*id].map(|first| first.id);
                let handle = fst.var(name, shape, variable, direction, alias)?;
                signals[*id] = Some(Signal { id: handle, width: signal.width as usize });
            }
        }
    }
    fst.finish()
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
