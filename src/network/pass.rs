//! Forward pass of a network over a histogram, generic over the number type.

use std::iter::Sum;
use std::ops::{Add, Mul};

use super::weights::Weights;

/// Intermediate values of a hidden neuron.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HiddenNeuron<T> {
    /// Sum of the weighted counts and the bias.
    pub sum: T,
    /// Activation of the sum.
    pub activation: T,
    /// Activation times its output weight.
    pub product: T,
}

impl<T> Weights<T, T, T, T>
where
    T: Copy + From<u32> + Add<Output = T> + Mul<Output = T> + Sum,
{
    /// Computes the depth of a histogram with the activation function `activate`. Each neuron's intermediate values
    /// are passed to `record`, in order.
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
