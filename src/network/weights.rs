//! Weights of a network, generic over the number type.

use serde::Deserialize;

/// Weights `w1[neuron][bin]` and `w2[neuron]` of a network, and its biases. The number of neurons is at most that of
/// the firmware's ports.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weights<W1, B1, W2, B2> {
    /// Weights of the hidden layer, applied to raw counts.
    pub w1: Vec<Vec<W1>>,
    /// Biases of the hidden layer.
    pub b1: Vec<B1>,
    /// Weights of the output layer [m].
    pub w2: Vec<W2>,
    /// Bias of the output layer [m].
    pub b2: B2,
}

/// Weights as integer ROM words, whose formats the datapath defines.
pub type Fixed = Weights<i32, i32, i32, i32>;

impl<W1: Copy, B1: Copy, W2: Copy, B2: Copy> Weights<W1, B1, W2, B2> {
    /// Returns the number of hidden neurons.
    pub fn neurons(&self) -> usize {
        self.w2.len()
    }

    /// Returns the number of histogram bins.
    pub fn bins(&self) -> usize {
        self.w1.first().map_or(0, Vec::len)
    }

    /// Converts all weights to other number types.
    pub fn map<V1, C1, V2, C2>(
        &self,
        w1: impl Fn(W1) -> V1,
        b1: impl Fn(B1) -> C1,
        w2: impl Fn(W2) -> V2,
        b2: impl Fn(B2) -> C2,
    ) -> Weights<V1, C1, V2, C2> {
        Weights {
            w1: self.w1.iter().map(|row| row.iter().copied().map(&w1).collect()).collect(),
            b1: self.b1.iter().copied().map(b1).collect(),
            w2: self.w2.iter().copied().map(w2).collect(),
            b2: b2(self.b2),
        }
    }
}
