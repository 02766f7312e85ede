//! Where to look in a waveform.

use crate::kernel::Time;

/// Instants to mark and to show first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    /// First laser edge in a written window.
    pub laser_edge: Option<Time>,
    /// First edge of the SPAD's output after it.
    pub spad_edge: Option<Time>,
    /// End of an estimation in a written window.
    pub algo_done: Option<Time>,
    /// Begin of what is shown at first.
    pub from: Time,
    /// End of what is shown at first.
    pub to: Time,
}

impl Marks {
    /// The marks that are known, with their names.
    pub(super) fn named(&self) -> Vec<(&'static str, Time)> {
        let marks =
            [("laser", self.laser_edge), ("SPAD", self.spad_edge), ("done", self.algo_done)];
        marks.into_iter().filter_map(|(name, at)| Some((name, at?))).collect()
    }
}
