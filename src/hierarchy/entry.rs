//! One name in one scope of a waveform, and the ids of values.

use crate::firmware::TofTop;
use crate::firmware::histogram_builder::MOST_BINS;
use crate::kernel::module::Module;
use crate::kernel::signals::Signal;

/// Name of the top scope.
pub const TOP: &str = "tof_top";

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Input port of its module.
    Input,
    /// Output port of its module.
    Output,
    /// Register or wire inside its module.
    Internal,
}

/// One name in one scope.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Dotted path of the module, `tof_top` first.
    pub scope: String,
    /// Name, width, format and meaning.
    pub signal: Signal,
    /// Port or not.
    pub kind: Kind,
    /// The value it shows; aliases share it.
    pub id: usize,
}

impl Entry {
    /// Dotted path of the signal.
    pub fn path(&self) -> String {
        format!("{}.{}", self.scope, self.signal.name)
    }

    /// Its path below the top.
    pub fn below_top(&self) -> String {
        below_top(&self.path()).to_owned()
    }

    /// Whether it is a word of the histogram's RAM.
    pub fn in_ram(&self) -> bool {
        (RAM..ROW).contains(&self.id)
    }
}

/// First id of the RAM's words, after those of all registers and wires.
pub(super) const RAM: usize = TofTop::COUNT;

/// First id of the outputs of the row of SPADs.
pub const ROW: usize = RAM + MOST_BINS;

/// Longest row.
pub const MOST_OUTPUTS: usize = 64;

/// Number of ids.
pub const IDS: usize = ROW + MOST_OUTPUTS;

/// A path without the top.
pub fn below_top(path: &str) -> &str {
    path.strip_prefix(TOP).and_then(|rest| rest.strip_prefix('.')).unwrap_or(path)
}
