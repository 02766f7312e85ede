//! The depth network: its file, its fixed-point and floating-point passes, and its ROMs.

pub mod datapath;
pub mod estimate;
pub mod explain;
pub mod file;
pub mod float;
pub mod formats;
pub mod import;
pub mod mem;
mod read;
pub mod roms;
pub mod round;
mod schema;
mod write;

pub use estimate::{Estimate, estimate};
pub use explain::{Explanation, explain};
pub use file::Network;

use crate::firmware::forward2::NEURONS;
use crate::firmware::histogram_builder::BINS;

/// Hits per bin of 25 ps, bin 0 first [hits].
pub type Histogram = [u16; BINS];

/// Most hits a histogram may hold; the widths of the estimator's words bear any such sum [hits].
pub const MAX_HITS: u32 = 65_535;

/// The weights of a network, `w1[neuron][bin]`, biases beside them.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights<W1, B1, W2, B2> {
    /// Hidden layer, applied to raw counts.
    pub w1: Box<[[W1; BINS]; NEURONS]>,
    /// Biases of the hidden layer.
    pub b1: [B1; NEURONS],
    /// Output layer [m].
    pub w2: [W2; NEURONS],
    /// Bias of the output layer [m].
    pub b2: B2,
}
