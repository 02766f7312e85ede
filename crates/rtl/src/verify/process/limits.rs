//! Ways in which a program ends, and limits at which it is ended.

use std::fmt;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Way in which a program ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Itself, and whether it says that all went well.
    Exit(bool),
    /// Killed because its time was up.
    OutOfTime(Overrun),
    /// Killed because it had written nothing for so long.
    Stalled(Duration),
    /// Killed because it had written too much.
    Wild,
}

/// A time that a program has used up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overrun {
    /// Processor time, of the program and its children.
    Processor(Duration),
    /// Time by the clock, of a program that waits for something or has hardly been given a processor.
    Clock(Duration),
}

/// When to give up.
#[derive(Clone, Copy, Debug)]
pub struct Limits<'a> {
    /// Processor time that a program may take with its children, so that a busy machine is no fault of its own, or
    /// [`SHARE`] times as long by the clock.
    pub time: Duration,
    /// Time for which it may write nothing, if it is one that reports progress; measured as `time` is.
    pub silence: Option<Duration>,
    /// Set from outside to stop.
    pub stop: Option<&'a AtomicBool>,
}

/// Output beyond this is taken as a program gone wild [bytes].
pub(super) const LONGEST: u64 = 64 << 20;
/// Time by the clock for a second of processor time, at most.
pub const SHARE: u32 = 8;

impl Limits<'_> {
    /// So long, whatever it writes.
    pub const fn new(time: Duration) -> Self {
        Limits { time, silence: None, stop: None }
    }
}

impl fmt::Display for Overrun {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Overrun::Processor(time) => write!(f, "{} s of processor time", time.as_secs_f64()),
            Overrun::Clock(time) => write!(f, "{} s", time.as_secs_f64()),
        }
    }
}

impl End {
    /// Returns why it was killed, as the end of a sentence about it, if it was.
    pub fn killed(&self) -> Option<String> {
        match self {
            End::Exit(_) => None,
            End::OutOfTime(overrun) => Some(format!("has not ended after {overrun}")),
            End::Stalled(time) => Some(format!("has written nothing for {} s", time.as_secs_f64())),
            End::Wild => Some(format!("has written more than {} MiB", LONGEST >> 20)),
        }
    }
}
