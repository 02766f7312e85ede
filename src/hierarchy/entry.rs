//! Names in the scopes of a waveform, and value ids.

use crate::firmware::histogram_builder::{HistogramBuilder, MOST_BINS};
use crate::firmware::tdc::Tdc;
use crate::firmware::tof_top::TofTop;
use crate::kernel::module::Module;
use crate::kernel::scan::MOST_COLUMNS;
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
        (RAM..CHANNELS).contains(&self.id)
    }
}

/// First id of the RAM's words, which follow all registers and wires.
pub(super) const RAM: usize = TofTop::COUNT;

/// First id of the other columns of an array.
pub(super) const CHANNELS: usize = RAM + MOST_BINS;

/// Histograms of another column, at most.
const MOST_BANKS: usize = 2;

/// Ids of another column: the output of its SPAD, its converter, its histograms.
pub(super) const IN_CHANNEL: usize = 1 + Tdc::COUNT + MOST_BANKS * HistogramBuilder::COUNT;

/// First id of the SPAD row's outputs.
pub const ROW: usize = CHANNELS + (MOST_COLUMNS as usize - 1) * IN_CHANNEL;

/// Largest number of outputs of a row.
pub const MOST_OUTPUTS: usize = 64;

/// Total number of ids.
pub const IDS: usize = ROW + MOST_OUTPUTS;

/// Returns whether a dotted path equals `parent` or lies within it.
pub fn within(scope: &str, parent: &str) -> bool {
    scope.strip_prefix(parent).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Strips the top from a path.
pub fn below_top(path: &str) -> &str {
    path.strip_prefix(TOP).and_then(|rest| rest.strip_prefix('.')).unwrap_or(path)
}
