//! The depth network: its file, its passes in fixed and floating point, and its ROMs.

pub mod estimate;
pub mod file;
pub mod float;
pub mod formats;
pub mod histogram_file;
pub mod mem;
pub mod pass;
pub mod roms;
pub mod round;
mod schema;
mod write;

pub use estimate::{Estimate, estimate};
pub use file::Network;

use crate::firmware::histogram_builder::BINS;

/// Hits per bin of 25 ps, bin 0 first [hits].
pub type Histogram = [u16; BINS];

/// Most hits a histogram may hold; the widths of the estimator's words bear any such sum [hits].
pub const MAX_HITS: u32 = 65_535;

/// The weights of a network, `w1[neuron][bin]`, biases beside them; as many neurons in each list, and
/// no more than the firmware has ports for.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights<W1, B1, W2, B2> {
    /// Hidden layer, applied to raw counts.
    pub w1: Vec<[W1; BINS]>,
    /// Biases of the hidden layer.
    pub b1: Vec<B1>,
    /// Output layer [m].
    pub w2: Vec<W2>,
    /// Bias of the output layer [m].
    pub b2: B2,
}

impl<W1, B1, W2, B2> Weights<W1, B1, W2, B2> {
    /// Hidden neurons.
    pub fn neurons(&self) -> usize {
        self.w2.len()
    }
}
