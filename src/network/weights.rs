//! The weights of a network, in any number format.

/// The weights of a network, `w1[neuron][bin]`, biases beside them; as many neurons in each list, and
/// no more than the firmware has ports for.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights<W1, B1, W2, B2> {
    /// Hidden layer, applied to raw counts.
    pub w1: Vec<Vec<W1>>,
    /// Biases of the hidden layer.
    pub b1: Vec<B1>,
    /// Output layer [m].
    pub w2: Vec<W2>,
    /// Bias of the output layer [m].
    pub b2: B2,
}

/// A network's weights as the ROMs hold them: integers, whose formats stand beside them.
pub type Fixed = Weights<i32, i32, i32, i32>;

impl<W1: Copy, B1: Copy, W2: Copy, B2: Copy> Weights<W1, B1, W2, B2> {
    /// Hidden neurons.
    pub fn neurons(&self) -> usize {
        self.w2.len()
    }

    /// Bins of a histogram.
    pub fn bins(&self) -> usize {
        self.w1.first().map_or(0, Vec::len)
    }

    /// The same in other formats.
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
