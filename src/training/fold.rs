//! From the optimiser's parameters to the firmware's words: raw counts in, metres out.

use crate::error::{Error, Input, Result};
use crate::firmware::forward2::NEURONS;
use crate::firmware::histogram_builder::BINS;
use crate::network::Histogram;
use crate::network::file::{Accuracy, Network, Training};
use crate::network::float::Float;
use crate::network::formats::{
    B1, B2, Fixed, Format, HiddenBias, HiddenWeight, OutputBias, OutputWeight, Overflow, W1, W2,
};
use crate::network::roms::tansig_table;

use super::basis::{KNOTS, expand};
use super::features::{COLUMNS, Scaling};

/// A network with any number of neurons, as numbers or as the integers of its words.
#[derive(Clone, Debug, PartialEq)]
pub struct Folded<T> {
    /// Hidden weights, a row of bins for each neuron.
    pub w1: Vec<[T; BINS]>,
    /// Hidden biases.
    pub b1: Vec<T>,
    /// Output weights.
    pub w2: Vec<T>,
    /// Output bias.
    pub b2: T,
}

impl Folded<f64> {
    /// Takes the scaling of the inputs into the weights.
    pub fn new(x: &[f64], neurons: usize, scaling: &Scaling) -> Self {
        let rows = || x.chunks_exact(COLUMNS).take(neurons);
        let raw = |row: &[f64]| -> Vec<f64> {
            row.iter().zip(&scaling.inverse_sd).map(|(weight, scale)| weight * scale).collect()
        };
        let bias = |row: &[f64]| {
            let centre = raw(row).iter().zip(&scaling.mean).map(|(w, mean)| w * mean).sum::<f64>();
            row[KNOTS] - centre
        };
        let output = &x[neurons * COLUMNS..];
        Folded {
            w1: rows().map(|row| expand(&raw(row))).collect(),
            b1: rows().map(bias).collect(),
            w2: output[..neurons].to_vec(),
            b2: output[neurons],
        }
    }

    /// The words, rounded half away from zero.
    ///
    /// # Errors
    /// Naming the first weight that its word cannot hold.
    pub fn round(&self) -> Result<Folded<i64>> {
        let row = |(k, row): (usize, &[f64; BINS])| {
            let mut words = [0; BINS];
            for (bin, (word, &weight)) in words.iter_mut().zip(row).enumerate() {
                *word = round(W1, weight, || format!("w1[{k}][{bin}]"))?;
            }
            Ok(words)
        };
        let all = |values: &[f64], format: Format, name: &str| {
            let word = |(k, &value)| round(format, value, || format!("{name}[{k}]"));
            values.iter().enumerate().map(word).collect::<Result<Vec<i64>>>()
        };
        Ok(Folded {
            w1: self.w1.iter().enumerate().map(row).collect::<Result<_>>()?,
            b1: all(&self.b1, B1, "b1")?,
            w2: all(&self.w2, W2, "w2")?,
            b2: round(B2, self.b2, || "b2".to_owned())?,
        })
    }

    /// Depth of a histogram [m].
    pub fn depth_m(&self, histogram: &Histogram) -> f64 {
        let mut depth = self.b2;
        for ((row, bias), weight) in self.w1.iter().zip(&self.b1).zip(&self.w2) {
            let products = row.iter().zip(histogram).map(|(w, &count)| w * f64::from(count));
            depth += weight * libm::tanh(products.sum::<f64>() + bias);
        }
        depth
    }
}

/// The word of a weight.
fn round(format: Format, value: f64, field: impl Fn() -> String) -> Result<i64> {
    format.round(value, Overflow::Refuse).ok_or_else(|| {
        let Format { width, fraction } = format;
        let expected = format!("expected what {width} bits with {fraction} of fraction can hold");
        Input::new("trained network", expected).field(field()).value(value).into()
    })
}

impl Folded<i64> {
    /// Depth of a histogram, bit for bit that of the firmware as long as no word of 36 bits
    /// overflows [m].
    pub fn depth_m(&self, histogram: &Histogram) -> f64 {
        let tansig = tansig_table();
        let mut depth = self.b2 << 12;
        for ((row, bias), weight) in self.w1.iter().zip(&self.b1).zip(&self.w2) {
            let products = row.iter().zip(histogram).map(|(&w, &count)| w * i64::from(count));
            let l1_in = products.sum::<i64>() + (bias << 10);
            let address = crate::firmware::tansig::address(crate::kernel::S::new(l1_in));
            depth += weight * tansig[address].get();
        }
        depth as f64 / (1i64 << 29) as f64
    }

    /// The network of the firmware.
    ///
    /// # Errors
    /// When it has another number of neurons than the firmware.
    pub fn network(
        &self,
        float: &Folded<f64>,
        training: Training,
        accuracy: Accuracy,
        description: String,
    ) -> Result<Network> {
        let neurons = self.w1.len();
        let refusal = || -> Error {
            let expected = format!("expected {NEURONS}, as the firmware has");
            Input::new("trained network", expected).field("neurons").value(neurons).into()
        };
        let bits = |row: &[i64; BINS]| row.map(|word| HiddenWeight::from_bits(word as i32));
        let fixed = Fixed {
            w1: boxed(&self.w1.iter().map(bits).collect::<Vec<_>>()).ok_or_else(refusal)?,
            b1: array(&self.b1, |word| HiddenBias::from_bits(word as i16)).ok_or_else(refusal)?,
            w2: array(&self.w2, |word| OutputWeight::from_bits(word as i16)).ok_or_else(refusal)?,
            b2: OutputBias::from_bits(self.b2 as i32),
        };
        let float = Float {
            w1: boxed(&float.w1).ok_or_else(refusal)?,
            b1: array(&float.b1, |value| value).ok_or_else(refusal)?,
            w2: array(&float.w2, |value| value).ok_or_else(refusal)?,
            b2: float.b2,
        };
        let (accuracy, float) = (Some(accuracy), Some(float));
        Ok(Network { name: String::new(), description, training, accuracy, fixed, float })
    }
}

fn boxed<T: Copy>(rows: &[[T; BINS]]) -> Option<Box<[[T; BINS]; NEURONS]>> {
    rows.try_into().ok().map(Box::new)
}

fn array<T: Copy, U: Copy>(values: &[T], convert: impl Fn(T) -> U) -> Option<[U; NEURONS]> {
    let converted: Vec<U> = values.iter().map(|&value| convert(value)).collect();
    converted.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::estimate;

    /// Parameters of a plausible network, and the scaling of its inputs.
    fn parameters() -> (Vec<f64>, Scaling) {
        let mut x: Vec<f64> = (0..8 * COLUMNS).map(|k| (k as f64 * 0.37).sin() * 0.05).collect();
        x.extend((0..8).map(|k| 0.1 * (k as f64 - 3.5)));
        x.push(0.2);
        let mean = (0..KNOTS).map(|k| 50.0 + k as f64).collect();
        (x, Scaling { mean, inverse_sd: vec![0.02; KNOTS] })
    }

    fn histogram(seed: usize) -> Histogram {
        std::array::from_fn(|bin| ((bin * 31 + seed * 77) % 150) as u16)
    }

    #[test]
    fn folding_changes_no_depth() {
        let (x, scaling) = parameters();
        let folded = Folded::new(&x, 8, &scaling);
        for seed in 0..20 {
            let inputs = scaling.apply(&histogram(seed));
            let hidden = |row: &[f64]| {
                let products = row.iter().zip(inputs).map(|(w, x)| w * f64::from(x));
                libm::tanh(products.sum())
            };
            let hidden = x.chunks_exact(COLUMNS).take(8).map(hidden);
            let output = &x[8 * COLUMNS..];
            let depth = hidden.zip(output).map(|(a, w)| a * w).sum::<f64>() + output[8];
            assert!((folded.depth_m(&histogram(seed)) - depth).abs() < 1e-6);
        }
    }

    #[test]
    fn the_words_give_the_firmware_s_depth() {
        let (x, scaling) = parameters();
        let folded = Folded::new(&x, 8, &scaling);
        let words = folded.round().unwrap();
        let (training, accuracy) = (Training::default(), Accuracy::default());
        let network = words.network(&folded, training, accuracy, String::new()).unwrap();
        let params = network.params();
        for seed in 0..20 {
            let depth = estimate(&params, &histogram(seed)).depth.to_f64();
            assert_eq!(words.depth_m(&histogram(seed)), depth);
            assert!((network.twin().forward(&histogram(seed)) - depth).abs() < 2e-3);
        }
    }

    #[test]
    fn a_weight_that_does_not_fit_is_named() {
        let (mut x, scaling) = parameters();
        x[8 * COLUMNS + 3] = 2.0;
        let error = Folded::new(&x, 8, &scaling).round().unwrap_err().to_string();
        assert!(error.contains("w2[3] = 2: expected what 16 bits with 14 of fraction"), "{error}");
        let (mut x, scaling) = parameters();
        x[2 * COLUMNS] = 1.0;
        let error = Folded::new(&x, 8, &scaling).round().unwrap_err().to_string();
        assert!(error.contains("w1[2][0] = 0.02"), "{error}");
    }

    #[test]
    fn another_number_of_neurons_is_refused_when_it_becomes_firmware() {
        let (x, scaling) = parameters();
        let mut folded = Folded::new(&x, 8, &scaling);
        folded.w1.truncate(7);
        let words = folded.round().unwrap();
        let (training, accuracy) = (Training::default(), Accuracy::default());
        let error = words.network(&folded, training, accuracy, String::new()).unwrap_err();
        assert!(error.to_string().contains("neurons = 7: expected 8"), "{error}");
    }
}
