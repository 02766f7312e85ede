//! FST files of any design.

use std::io;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::files::output::OutputFile;

use super::super::dump::signal::{Dump, DumpSignal, DumpValue};
use super::changes::Changes;
use super::header::Header;
use super::hierarchy::Hierarchy;
use super::record::Record;

/// An FST file of any signals.
pub struct FstDump {
    path: PathBuf,
    changes: Changes<OutputFile, Record>,
    /// Index of each id's signal in the file.
    signals: Vec<Option<usize>>,
    is_open: bool,
}

impl FstDump {
    /// Creates a file with signals whose ids are below `ids`; its unit is 10 to the `exponent` seconds, and the first of
    /// `comments` is its origin.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub fn create(
        path: &Path,
        exponent: i8,
        signals: &[DumpSignal],
        ids: usize,
        comments: &[String],
    ) -> Result<FstDump> {
        let hierarchy = Hierarchy::of(signals, ids, comments);
        let header = Header {
            exponent,
            scopes: hierarchy.scopes,
            names: hierarchy.names,
            signals: hierarchy.widths.len() as u64,
            ..Header::new(comments)?
        };
        let mut file = OutputFile::create_seekable(path)?;
        let begun = header.write(&mut file).and_then(|()| hierarchy.write(&mut file));
        begun.map_err(Error::io(path, "write"))?;
        let mut streams: Vec<Option<Record>> = Vec::new();
        streams.resize_with(hierarchy.widths.len(), || None);
        for signal in signals {
            if let Some(place) = hierarchy.signals[signal.id] {
                streams[place].get_or_insert_with(|| Record::new(signal.kind));
            }
        }
        let changes = Changes::new(file, header, streams.into_iter().flatten().collect());
        Ok(FstDump { path: path.to_owned(), changes, signals: hierarchy.signals, is_open: false })
    }
}

impl Dump for FstDump {
    fn begin(&mut self, at: u64) -> io::Result<()> {
        if !std::mem::replace(&mut self.is_open, true) {
            self.changes.open(at);
            return Ok(());
        }
        self.changes.begin(at)
    }

    fn change(&mut self, id: usize, value: DumpValue<'_>) -> io::Result<()> {
        let Some(place) = self.signals[id] else { return Ok(()) };
        let step = self.changes.step();
        let bytes = self.changes.streams[place].note(step, value);
        self.changes.grown(bytes);
        Ok(())
    }

    fn finish(mut self: Box<Self>, at: u64) -> Result<()> {
        let begun = self.begin(at);
        let FstDump { path, changes, .. } = *self;
        let done = begun.and_then(|()| changes.finish(at));
        done.map_err(Error::io(&path, "write"))?.commit()
    }
}
