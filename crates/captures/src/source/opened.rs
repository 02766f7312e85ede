//! Waveforms that the library has opened.

use std::fmt;
use std::path::Path;
use std::sync::{Arc, Mutex};

use wellen::LoadOptions;
use wellen::stream::StreamingWaveform;

use tofsim::error::{Error, Result};

use super::bytes::Bytes;
use super::fst;
use super::library::fault;
use super::spliced::{Piece, Spliced};

/// Opens a file for the library, which sees `pieces` of it.
pub(super) fn open(path: &Path, pieces: &Arc<[Piece]>) -> Result<StreamingWaveform<Bytes>> {
    let file = Spliced::open(fst::open(path)?, pieces).map_err(Error::io(path, "read"))?;
    let options = LoadOptions { multi_thread: false, remove_scopes_with_empty_name: true };
    let wave = wellen::stream::read(file, &options);
    wave.map_err(|error| fault(path, error))
}

/// A file that the library has opened, until it is taken.
#[derive(Clone)]
pub(super) struct Opened(Arc<Mutex<Option<StreamingWaveform<Bytes>>>>);

impl Opened {
    pub(super) fn new(wave: StreamingWaveform<Bytes>) -> Opened {
        Opened(Arc::new(Mutex::new(Some(wave))))
    }

    /// Returns the file, if nobody has taken it.
    pub(super) fn take(&self) -> Option<StreamingWaveform<Bytes>> {
        self.0.lock().ok()?.take()
    }
}

impl fmt::Debug for Opened {
    fn fmt(&self, into: &mut fmt::Formatter) -> fmt::Result {
        into.write_str("Opened")
    }
}
