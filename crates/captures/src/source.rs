//! What can be compared: waveforms, captures of logic analysers and simulations, each read as a
//! stream of changes in bounded memory.

mod bytes;
mod capture;
mod detect;
mod end;
mod fst;
mod ghw;
mod guard;
mod library;
mod loaded;
mod locate;
mod marks;
mod names;
mod shapes;
mod signals;
mod simulation;
mod span;
mod state;
mod stopped;
mod stream;
mod tick;
mod translated;
mod wave;

use std::path::Path;

use tofsim::error::Result;
use tofsim::sim::setup::Setup;

use crate::ila::Radix;

pub use names::Name;
pub(crate) use shapes::{flow, known_shape};
pub use signals::{Axis, Signal, SignalKind, Source, SourceFormat, Words};
pub use simulation::LONGEST_SIMULATION;
pub use state::SourceState;
pub use stream::{Cursor, Feed, Gone, Marks};
pub use tick::Tick;
pub(crate) use translated::Translation;

impl Source {
    /// Looks at a file; what it holds decides its format. `radix` is that of values in a file that
    /// does not say.
    ///
    /// # Errors
    /// When it cannot be read or is none of the formats.
    pub fn file(path: &Path, radix: Option<Radix>) -> Result<Source> {
        Ok(detect::open(path, radix)?.distinguish())
    }

    /// A simulation of so many frames or, without a number, of as much as is asked for, up to
    /// [`LONGEST_SIMULATION`].
    pub fn simulation(setup: Setup, frames: Option<u64>) -> Source {
        simulation::source(setup, frames)
    }
}
