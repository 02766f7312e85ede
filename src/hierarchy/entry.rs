//! Names in the scopes of a waveform, and value ids.

use crate::firmware::histogram_builder::MOST_BINS;
use crate::firmware::tof_top::TofTop;
use crate::kernel::module::Module;
use crate::kernel::signals::Signal;

/// Name of the top scope.
pub const TOP: &str = "tof_top";

/// Role of a name in its module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Input port.
    Input,
    /// Output port.
    Output,
    /// Internal register or wire.
    Internal,
}

/// A name in a scope.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Dotted path of the module, beginning with `tof_top`.
    pub scope: String,
    /// Name, width, format and meaning.
    pub signal: Signal,
    /// Role in the module.
    pub kind: Kind,
    /// Id of the value; aliases share it.
    pub id: usize,
}

impl Entry {
    /// Returns the dotted path of the signal.
    pub fn path(&self) -> String {
        format!("{}.{}", self.scope, self.signal.name)
    }

    /// Returns the signal's path below the top.
    pub fn below_top(&self) -> String {
        below_top(&self.path()).to_owned()
    }

    /// Returns whether the signal is a word of the histogram RAM.
    pub fn in_ram(&self) -> bool {
        (RAM..ROW).contains(&self.id)
    }
}

/// First id of the RAM's words, which follow all registers and wires.
pub(super) const RAM: usize = TofTop::COUNT;

/// First id of the SPAD row's outputs.
pub const ROW: usize = RAM + MOST_BINS;

/// Largest number of outputs of a row.
pub const MOST_OUTPUTS: usize = 64;

/// Total number of ids.
pub const IDS: usize = ROW + MOST_OUTPUTS;

/// Strips the top from a path.
pub fn below_top(path: &str) -> &str {
    path.strip_prefix(TOP).and_then(|rest| rest.strip_prefix('.')).unwrap_or(path)
}
