//! What a format of waveform files has to write.

use std::io;

use crate::error::Result;
use crate::kernel::signals::Sink;

/// What a time step is.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Step {
    /// The first one, at time 0: every signal.
    Start,
    /// A window begins: every signal.
    Open,
    /// Some signals change.
    Change,
    /// Levels of clocks change, and nothing else.
    Clocks,
    /// A window ends: every signal is unknown.
    Close,
}

/// A file format, given the values of one time step after the other.
pub(super) trait Body: Sink {
    /// What the end of a step has to know of its begin.
    type Begun;
    /// Begins a step; `at` is never earlier than the step before [ps]. Its values come next.
    fn begin(&mut self, at: u64, step: Step) -> Self::Begun;
    /// Ends a step, which is left out if nothing came.
    fn end(&mut self, begun: Self::Begun) -> io::Result<()>;
    /// All signals unknown; for use in a step.
    fn unknown(&mut self);
    /// Puts the finished file, which ends at `at`, in place [ps].
    fn finish(self, at: u64) -> Result<()>;
}
