//! FST files, as described in GTKWave's `block_format.txt`.
//!
//! The provenance is in the version string as far as it fits, and in full in comments at the start of the hierarchy. Also
//! in the hierarchy are tables of state names and, in a waveform of a simulation ([`Fst`]), type, unit and meaning of each
//! signal, and the places of each module in the Verilog. A file of any design is an [`FstDump`](dump::FstDump).

use std::io;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::files::output::OutputFile;
use crate::firmware::tdc_decoder::Encoder;
use crate::hierarchy::Entry;
use crate::kernel::Thermometer;
use crate::kernel::signals::Sink;

use super::body::{Body, Step};
use super::digits::TapDigits;

mod attributes;
mod blocks;
mod changes;
pub(super) mod dump;
mod header;
mod hierarchy;
mod record;
mod section;
mod sections;
mod signal_stream;
mod stream;
mod times;

use changes::Changes;
use header::Header;
use hierarchy::Hierarchy;
use stream::Stream;

/// An FST file being written.
pub(super) struct Fst {
    path: PathBuf,
    changes: Changes<OutputFile>,
    /// Index of each id's signal in the file; `None` if it is not selected.
    signals: Vec<Option<usize>>,
    taps: TapDigits,
    /// Buffer for the taps as written to the file.
    bytes: Vec<u8>,
    /// Time of the current step, until its first change is written [ps].
    pending: Option<u64>,
    /// First error of the current step.
    fault: Option<io::Error>,
}

impl Fst {
    pub(super) fn create(
        path: &Path,
        entries: &[Entry],
        encoder: &Encoder,
        provenance: &[String],
    ) -> Result<Self> {
        let hierarchy = Hierarchy::new(entries, provenance);
        let header = Header {
            scopes: hierarchy.scopes,
            names: hierarchy.names,
            signals: hierarchy.widths.len() as u64,
            ..Header::new(provenance)?
        };
        let mut file = OutputFile::create_seekable(path)?;
        let streams = hierarchy.widths.iter().map(|&width| Stream::new(width)).collect();
        let begun = header.write(&mut file).and_then(|()| hierarchy.write(&mut file));
        begun.map_err(Error::io(path, "write"))?;
        Ok(Fst {
            path: path.to_owned(),
            changes: Changes::new(file, header, streams),
            signals: hierarchy.signals,
            taps: TapDigits::new(encoder),
            bytes: Vec::new(),
            pending: None,
            fault: None,
        })
    }

    /// Writes the time of the step, if this is its first change.
    #[inline]
    fn time_step(&mut self) {
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
        self.time_step();
        self.changes.word(signal, value);
    }

    fn taps(&mut self, id: usize, value: &Thermometer, group: usize) {
        let Some(signal) = self.signals[id] else { return };
        self.time_step();
        self.bytes.clear();
        let bits = self.taps.bits(value, group);
        let (words, shift) = (bits.words, bits.width.next_multiple_of(8) - bits.width);
        for (place, &word) in words.iter().enumerate().rev() {
            let below = if place > 0 { words[place - 1] } else { 0 };
            let both = u128::from(word) << 64 | u128::from(below);
            self.bytes.extend_from_slice(&((both << shift >> 64) as u64).to_be_bytes());
        }
        let begin = self.bytes.len() - bits.width.div_ceil(8);
        self.changes.change(signal, &self.bytes[begin..]);
    }
}

impl Body for Fst {
    type Begun = ();

    #[inline]
    fn begin(&mut self, at: u64, _: Step) {
        self.pending = Some(at);
    }

    #[inline]
    fn end(&mut self, (): ()) -> io::Result<()> {
        self.fault.take().map_or(Ok(()), Err)
    }

    fn unknown(&mut self) {
        self.time_step();
        self.changes.unknown();
    }

    fn finish(self, at: u64) -> Result<()> {
        // Readers take the values of the first time step only if there is a second one.
        let done = self.changes.finish(at.max(1));
        done.map_err(Error::io(&self.path, "write"))?.commit()
    }
}
