//! Interface that a waveform format implements.

use std::io;

use crate::error::Result;
use crate::kernel::signals::Sink;

/// Kind of a time step.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Step {
    /// The first step, at time 0: every signal.
    Start,
    /// The start of a window: every signal.
    Open,
    /// A change of some signals.
    Change,
    /// A change of clock levels only.
    Clocks,
    /// The end of a window: every signal becomes unknown.
    Close,
}

/// A waveform format, which receives the values of one time step after the other.
pub(super) trait Body: Sink {
    /// State that is kept from the start of a step to its end.
    type Begun;
    /// Begins a step at `at`, not earlier than the previous step [ps]. The values follow.
    fn begin(&mut self, at: u64, step: Step) -> Self::Begun;
    /// Ends a step. A step without values is not written.
    ///
    /// # Errors
    /// If the file cannot be written.
    fn end(&mut self, begun: Self::Begun) -> io::Result<()>;
    /// Sets all signals to unknown; called within a step.
    fn unknown(&mut self);
    /// Ends the file at `at` [ps], and moves it to its final path.
    ///
    /// # Errors
    /// If the file cannot be written or renamed.
    fn finish(self, at: u64) -> Result<()>;
}
