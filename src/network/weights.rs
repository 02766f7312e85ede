//! The weights of a network, in any number format.

use crate::firmware::histogram_builder::BINS;

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
    pub fn neurons(&self) -> usize {
        self.w2.len()
    }
}
