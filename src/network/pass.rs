//! A network's pass over a histogram, in whatever numbers it is computed.

use std::iter::Sum;
use std::ops::{Add, Mul};

use super::weights::Weights;

/// What a hidden neuron comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HiddenNeuron<T> {
    /// Sum of the products of weights and counts, and of the bias.
    pub sum: T,
    /// What the activation makes of the sum.
    pub activation: T,
    /// Activation times its weight in the output layer.
    pub product: T,
}

impl<T> Weights<T, T, T, T>
where
    T: Copy + From<u32> + Add<Output = T> + Mul<Output = T> + Sum,
{
    /// The depth of a histogram. `activate` is the activation function; `record` is shown every
    /// neuron, in order.
    pub fn pass(
        &self,
        histogram: &[u32],
        mut activate: impl FnMut(T) -> T,
        mut record: impl FnMut(HiddenNeuron<T>),
    ) -> T {
        let hidden = self.w1.iter().zip(&self.b1).zip(&self.w2);
        let products = hidden.map(|((row, &bias), &weight)| {
            let products = row.iter().zip(histogram);
            let products = products.map(|(&weight, &count)| weight * T::from(count));
            let sum = products.sum::<T>() + bias;
            let activation = activate(sum);
            let product = activation * weight;
            record(HiddenNeuron { sum, activation, product });
            product
        });
        products.sum::<T>() + self.b2
    }
}
