//! Inputs of a comparison: waveforms, captures of logic analysers and simulations, all read as streams of changes in
//! bounded memory.

mod bytes;
mod called;
mod capture;
mod detect;
mod end;
mod fst;
mod ghw;
mod guard;
mod head;
mod library;
mod locate;
mod marks;
mod names;
mod opened;
mod shapes;
mod signals;
mod simulation;
mod span;
mod spliced;
mod state;
mod stream;
mod tables;
mod tick;
mod translated;
mod variables;
mod wave;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use tofsim::error::Result;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;

use crate::ila::Radix;

pub(crate) use library::is_shortened;
pub use names::Name;
pub(crate) use shapes::{flow, known_shape};
pub use signals::{Axis, Signal, SignalKind, Source, SourceFormat, Words};
pub use simulation::LONGEST_SIMULATION;
pub use state::SourceState;
pub use stream::{Cursor, Disconnected, Feed, Marks};
pub use tick::Tick;
pub(crate) use translated::{Translation, WordValues, untranslated};

/// Returns the comments on an FST file, given its contents: its origin is among them. A file of another format, or that is
/// damaged, has none.
pub fn fst_comments(contents: &[u8]) -> Vec<String> {
    fst::comments_of(contents).unwrap_or_default()
}

impl Source {
    /// Opens a file, whose contents determine its format. `radix` applies to files that do not state the radix of
    /// their values.
    ///
    /// # Errors
    /// If it cannot be read or has none of the formats.
    pub fn file(path: &Path, radix: Option<Radix>) -> Result<Source> {
        Source::file_stopped_by(path, radix, Arc::default())
    }

    /// Opens a file as [`Source::file`] does; once `stop` is set, opening and reading it fail as interrupted.
    ///
    /// # Errors
    /// As [`Source::file`], and if it is stopped.
    pub fn file_stopped_by(
        path: &Path,
        radix: Option<Radix>,
        stop: Arc<AtomicBool>,
    ) -> Result<Source> {
        Ok(detect::open(path, radix, &stop)?.distinguish().stopped_by(stop))
    }

    /// Creates a source that simulates `frames` frames or, without a number, as many as are read, up to
    /// [`LONGEST_SIMULATION`].
    pub fn simulation(setup: Setup, frames: Option<u64>) -> Source {
        simulation::source(setup, None, frames)
    }

    /// Creates a source that simulates the firmware of an array cycle by cycle, for `images` images or as
    /// [`Source::simulation`] does.
    ///
    /// # Errors
    /// If the firmware has no such array.
    pub fn array_simulation(array: ArraySetup, images: Option<u64>) -> Result<Source> {
        Ok(simulation::source(array.with_firmware()?, Some(array), images))
    }
}
