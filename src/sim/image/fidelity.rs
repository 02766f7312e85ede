//! Simulation fidelities of images.

use crate::sim::stepping::Stepping;

/// Simulation fidelity of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageFidelity {
    /// Shots are simulated.
    Shots(Stepping),
    /// Histograms are drawn from their distribution.
    Histograms,
}
