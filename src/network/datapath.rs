//! The estimator's arithmetic with word lengths and a table of one's own choice: what the firmware
//! would compute if it were built so.

use std::fmt::Display;
use std::sync::atomic::{AtomicU64, Ordering};

use serde::{Deserialize, Serialize};

use crate::error::{Input, Result};
use crate::firmware::histogram_builder::BINS;
use crate::firmware::tansig;

use super::float::Float;
use super::formats::{B1, B2, Format, L1_OUT, Overflow, TANSIG_RANGE, W1, W2};
use super::{Histogram, MAX_HITS};

/// Word lengths, and the size of the table of activations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Datapath {
    /// Weights of the hidden layer.
    pub w1: Format,
    /// Biases of the hidden layer.
    pub b1: Format,
    /// Weights of the output layer [m].
    pub w2: Format,
    /// Bias of the output layer [m].
    pub b2: Format,
    /// Activations.
    pub l1_out: Format,
    /// Address bits of the table.
    pub address_bits: u32,
    /// The table goes from minus to plus two to this power.
    pub range_log2: u32,
}

/// The firmware's (thesis Table 6.4).
impl Default for Datapath {
    fn default() -> Self {
        Datapath {
            w1: W1,
            b1: B1,
            w2: W2,
            b2: B2,
            l1_out: L1_OUT,
            address_bits: tansig::ADDRESS_BITS,
            range_log2: TANSIG_RANGE.ilog2(),
        }
    }
}

/// What a datapath takes of the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Cost {
    /// Block RAMs of 36 Kb.
    pub ramb36: u32,
    /// DSP slices.
    pub dsp48: u32,
}

impl Datapath {
    /// Names of its words.
    pub const WORDS: [&str; 5] = ["w1", "b1", "w2", "b2", "l1_out"];

    /// The format of a word.
    pub fn word(&mut self, name: &str) -> Option<&mut Format> {
        let words = [&mut self.w1, &mut self.b1, &mut self.w2, &mut self.b2, &mut self.l1_out];
        Self::WORDS.into_iter().zip(words).find(|(word, _)| *word == name).map(|(_, format)| format)
    }

    /// Step of the table, in a neuron's sum [1].
    pub fn step(&self) -> f64 {
        (f64::from(self.range_log2) + 1.0 - f64::from(self.address_bits)).exp2()
    }

    /// Whether its words are of a size that is built, can be aligned, and its table has a step of 2^-k.
    ///
    /// # Errors
    /// When not.
    pub fn check(&self) -> Result<()> {
        let fault = |field, value: &dyn Display, expected| {
            Err(Input::new("datapath", expected).field(field).value(value).into())
        };
        let words = [self.w1, self.b1, self.w2, self.b2, self.l1_out];
        for (field, word) in Self::WORDS.into_iter().zip(words) {
            let Format { width, fraction } = word;
            if !(2..=24).contains(&width) {
                return fault(field, &width, "expected a width of 2 to 24 bits");
            }
            if fraction > 32 {
                return fault(field, &fraction, "expected 32 fraction bits or less");
            }
        }
        if !(4..=16).contains(&self.address_bits) {
            return fault("address_bits", &self.address_bits, "expected 4 to 16");
        }
        if self.range_log2 > 6 {
            return fault("range_log2", &self.range_log2, "expected 6 or less");
        }
        if self.b1.fraction > self.w1.fraction {
            return fault("b1", &self.b1.fraction, "expected no more fraction bits than w1");
        }
        if self.b2.fraction > self.w2.fraction + self.l1_out.fraction {
            return fault(
                "b2",
                &self.b2.fraction,
                "expected no more fraction bits than w2 and the activation",
            );
        }
        if self.shift() < 1 {
            return fault(
                "address_bits",
                &self.address_bits,
                "expected steps coarser than the sum's last bit",
            );
        }
        Ok(())
    }

    /// Fraction bits of the sum that the address drops.
    fn shift(&self) -> i64 {
        i64::from(self.w1.fraction + 1 + self.range_log2) - i64::from(self.address_bits)
    }

    /// Block RAMs and DSP slices as `rtl_ref` is built for so many neurons: MEM1 a row a bin, MEM2 a copy for each two
    /// neurons, since a block RAM has two ports; a multiplier of 25 x 18 bits a neuron, and one.
    pub fn cost(&self, neurons: usize) -> Cost {
        let neurons = neurons as u32;
        let mem1 = (neurons * self.w1.width).div_ceil(72);
        let wide = match self.address_bits {
            0..=10 => 36,
            11 => 18,
            12 => 9,
            13 => 4,
            14 => 2,
            _ => 1,
        };
        let deep = 1 << self.address_bits.saturating_sub(15);
        let mem2 = neurons.div_ceil(2) * self.l1_out.width.div_ceil(wide) * deep;
        // A count of 16 bits is 17 with its sign; activation and W2 take either side.
        let slices = |a: u32, b: u32| if a.min(b) <= 18 && a.max(b) <= 25 { 1 } else { 2 };
        let hidden = neurons * slices(17, self.w1.width.max(self.b1.width));
        Cost { ramb36: mem1 + mem2, dsp48: hidden + slices(self.l1_out.width, self.w2.width) }
    }
}

/// A network in a datapath.
#[derive(Debug)]
pub struct Circuit {
    datapath: Datapath,
    w1: Vec<[i64; BINS]>,
    b1: Vec<i64>,
    w2: Vec<i64>,
    b2: i64,
    table: Vec<i64>,
    /// Weights that no word holds, and were saturated.
    pub saturated_weights: usize,
    /// Sums that lay past the table, of all histograms seen.
    saturated_sums: AtomicU64,
}

impl Circuit {
    /// Rounds the weights, halves away from zero; what no word holds is saturated.
    ///
    /// # Errors
    /// When [`Datapath::check`] fails.
    pub fn new(float: &Float, datapath: Datapath) -> Result<Self> {
        datapath.check()?;
        let mut saturated_weights = 0;
        let mut word = |format: Format, value: f64| {
            let fits = format.round(value, Overflow::Refuse);
            saturated_weights += usize::from(fits.is_none());
            fits.or_else(|| format.round(value, Overflow::Saturate)).unwrap_or_default()
        };
        let w1 = float.w1.iter().map(|row| row.map(|weight| word(datapath.w1, weight))).collect();
        let b1: Vec<i64> = float.b1.iter().map(|&bias| word(datapath.b1, bias)).collect();
        let w2 = float.w2.iter().map(|&weight| word(datapath.w2, weight)).collect();
        let b2 = word(datapath.b2, float.b2);
        let (entries, half) = (1i64 << datapath.address_bits, 1i64 << (datapath.address_bits - 1));
        let step = f64::from(1u32 << datapath.range_log2) / half as f64;
        let entry = |place: i64| {
            let value = libm::tanh((place - half) as f64 * step);
            datapath.l1_out.round(value, Overflow::Saturate).unwrap_or_default()
        };
        Ok(Circuit {
            datapath,
            w1,
            b1: b1
                .iter()
                .map(|bias| bias << (datapath.w1.fraction - datapath.b1.fraction))
                .collect(),
            w2,
            b2: b2 << (datapath.w2.fraction + datapath.l1_out.fraction - datapath.b2.fraction),
            table: (0..entries).map(entry).collect(),
            saturated_weights,
            saturated_sums: AtomicU64::new(0),
        })
    }

    /// Depth of a histogram [m].
    pub fn depth_m(&self, histogram: &Histogram) -> f64 {
        let (shift, half) = (self.datapath.shift(), self.table.len() as i64 / 2);
        let (mut depth, mut saturated) = (self.b2, 0);
        for neuron in 0..self.w2.len() {
            let products = self.w1[neuron].iter().zip(histogram);
            let products = products.map(|(weight, &count)| weight * i64::from(count));
            let sum = products.sum::<i64>() + self.b1[neuron];
            let rounded = (sum + (1 << (shift - 1))) >> shift;
            let address = rounded.clamp(-half, half - 1);
            saturated += u64::from(address != rounded);
            depth += self.table[(address + half) as usize] * self.w2[neuron];
        }
        self.saturated_sums.fetch_add(saturated, Ordering::Relaxed);
        let fraction = self.datapath.w2.fraction + self.datapath.l1_out.fraction;
        depth as f64 * (-f64::from(fraction)).exp2()
    }

    /// Sums that lay past the table, of all histograms seen.
    pub fn saturated_sums(&self) -> u64 {
        self.saturated_sums.load(Ordering::Relaxed)
    }

    /// Bits, with sign, that no sum of a legal histogram exceeds: of the hidden layer and the depth.
    pub fn sum_bits(&self) -> [u32; 2] {
        let largest = |row: &[i64; BINS]| row.iter().map(|weight| weight.abs()).max().unwrap_or(0);
        let hidden = self.w1.iter().zip(&self.b1);
        let hidden = hidden.map(|(row, bias)| i64::from(MAX_HITS) * largest(row) + bias.abs());
        let one = self.datapath.l1_out.min().abs();
        let depth = self.w2.iter().map(|weight| weight.abs() * one).sum::<i64>() + self.b2.abs();
        [hidden.max().unwrap_or(0), depth].map(|most| i64::BITS - most.leading_zeros() + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::{Network, estimate};

    fn peak(bin: usize, height: u16) -> Histogram {
        std::array::from_fn(|k| height / (1 + k.abs_diff(bin) as u16))
    }

    #[test]
    fn the_firmware_s_formats_give_what_the_firmware_gives() {
        for name in Network::builtin_names() {
            let network = Network::builtin(name).unwrap().unwrap();
            let circuit = Circuit::new(&network.twin(), Datapath::default()).unwrap();
            for bin in (5..250).step_by(7) {
                let histogram = peak(bin, 200 + 20 * bin as u16);
                let expected = estimate(&network.params(), &histogram).depth.to_f64();
                assert_eq!(circuit.depth_m(&histogram), expected);
            }
            assert_eq!(circuit.saturated_weights, 0);
            let [hidden, depth] = circuit.sum_bits();
            assert!(hidden <= 36 && depth <= 36, "{hidden} {depth}");
        }
    }

    #[test]
    fn the_firmware_s_cost_is_that_of_its_synthesis() {
        assert_eq!(Datapath::default().cost(8), Cost { ramb36: 2 + 8, dsp48: 8 + 1 });
        assert_eq!(Datapath::default().cost(16), Cost { ramb36: 4 + 16, dsp48: 16 + 1 });
        let small = Datapath { address_bits: 10, ..Datapath::default() };
        assert_eq!(small.cost(8).ramb36, 2 + 4);
        let wide = Datapath { w1: Format { width: 30, fraction: 37 }, ..Datapath::default() };
        assert_eq!(wide.cost(8), Cost { ramb36: 4 + 8, dsp48: 16 + 1 });
    }

    #[test]
    fn longer_words_come_nearer_to_float() {
        let float = Network::builtin("uniform").unwrap().unwrap().twin();
        let error = |address_bits| {
            let datapath = Datapath { address_bits, range_log2: 3, ..Datapath::default() };
            let circuit = Circuit::new(&float, datapath).unwrap();
            let errors = (5..250).map(|bin| {
                let histogram = peak(bin, 3000);
                (circuit.depth_m(&histogram) - float.forward(&histogram)).powi(2)
            });
            errors.sum::<f64>().sqrt()
        };
        assert!(error(8) > 2.0 * error(10) && error(10) > 2.0 * error(12));
    }

    #[test]
    fn what_cannot_be_aligned_is_refused() {
        let float = Network::builtin("uniform").unwrap().unwrap().twin();
        let fault = |datapath| Circuit::new(&float, datapath).unwrap_err().to_string();
        let b1 = Format { width: 16, fraction: 24 };
        assert!(fault(Datapath { b1, ..Datapath::default() }).contains("b1 = 24: expected"));
        let fine = Datapath { address_bits: 30, ..Datapath::default() };
        assert!(fault(fine).contains("address_bits = 30: expected 4 to 16"));
        let w1 = Format { width: 12, fraction: 8 };
        let coarse = Datapath { w1, b1: w1, ..Datapath::default() };
        assert!(fault(coarse).contains("address_bits = 12: expected steps"));
        let b2 = Format { width: 40, fraction: 14 };
        assert!(
            fault(Datapath { b2, ..Datapath::default() }).contains("b2 = 40: expected a width")
        );
        let mut wild = float.clone();
        wild.w1[0][0] = 1.0;
        let circuit = Circuit::new(&wild, Datapath::default()).unwrap();
        assert_eq!(circuit.saturated_weights, 1);
    }
}
