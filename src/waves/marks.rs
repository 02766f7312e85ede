//! Markers and initial view of a waveform.

use crate::kernel::Time;

/// Times to mark, and the time range to show at first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    /// First laser edge within a window.
    pub laser_edge: Option<Time>,
    /// First edge of the SPAD's output after the laser edge.
    pub spad_edge: Option<Time>,
    /// End of an estimation within a window.
    pub algo_done: Option<Time>,
    /// Start of the time range to show.
    pub from: Time,
    /// End of the time range to show.
    pub to: Time,
}

impl Marks {
    /// Returns the known marks with their names.
    pub(super) fn named(&self) -> Vec<(&'static str, Time)> {
        let marks =
            [("laser", self.laser_edge), ("SPAD", self.spad_edge), ("done", self.algo_done)];
        marks.into_iter().filter_map(|(name, at)| Some((name, at?))).collect()
    }
}
