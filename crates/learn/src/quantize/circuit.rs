//! A network in a datapath: its depths, and what saturates.

use std::sync::atomic::{AtomicU64, Ordering};

use tofsim::error::Result;
use tofsim::network::Weights;
use tofsim::network::float::Float;
use tofsim::network::formats::{Fixed, Overflow, WordFormat};
use tofsim::network::pass::HiddenNeuron;

use super::datapath::Datapath;

/// A network in a datapath.
#[derive(Debug)]
pub struct Circuit {
    datapath: Datapath,
    /// The words as integers, biases aligned with the products.
    words: Weights<i64, i64, i64, i64>,
    /// Activations by address.
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
        Ok(Circuit::rounded(float, datapath))
    }

    /// A network in the firmware's own datapath, in whose words its integers already are.
    pub fn firmware(fixed: &Fixed) -> Self {
        Circuit::rounded(&Float::from_fixed(fixed), Datapath::default())
    }

    fn rounded(float: &Float, datapath: Datapath) -> Self {
        let mut saturated_weights = 0;
        let mut word = |format: WordFormat, value: f64| {
            let fits = format.round(value, Overflow::Refuse);
            saturated_weights += usize::from(fits.is_none());
            fits.or_else(|| format.round(value, Overflow::Saturate)).unwrap_or_default()
        };
        let Datapath { w1, b1, w2, b2, l1_out, .. } = datapath;
        let (align_hidden, align_output) =
            (w1.fraction - b1.fraction, w2.fraction + l1_out.fraction - b2.fraction);
        let words = Weights {
            w1: float
                .w1
                .iter()
                .map(|row| row.iter().map(|&weight| word(w1, weight)).collect())
                .collect(),
            b1: float.b1.iter().map(|&bias| word(b1, bias) << align_hidden).collect(),
            w2: float.w2.iter().map(|&weight| word(w2, weight)).collect(),
            b2: word(b2, float.b2) << align_output,
        };
        let half = 1i64 << (datapath.address_bits - 1);
        let step = f64::from(1u32 << datapath.range_log2) / half as f64;
        let entry = |address: i64| {
            let value = libm::tanh(address as f64 * step);
            l1_out.round(value, Overflow::Saturate).unwrap_or_default()
        };
        let (table, saturated_sums) = ((-half..half).map(entry).collect(), AtomicU64::new(0));
        Circuit { datapath, words, table, saturated_weights, saturated_sums }
    }

    /// Address of a sum in the table of activations, signed, and whether the sum lies past the table.
    pub fn address(&self, sum: i64) -> (i64, bool) {
        let (shift, half) = (self.datapath.shift(), self.table.len() as i64 / 2);
        let rounded = (sum + (1 << (shift - 1))) >> shift;
        let address = rounded.clamp(-half, half - 1);
        (address, address != rounded)
    }

    /// Depth of a histogram as the word that it is; `record` is shown every neuron.
    pub fn depth(&self, histogram: &[u32], record: impl FnMut(HiddenNeuron<i64>)) -> i64 {
        let (half, mut past_the_table) = (self.table.len() as i64 / 2, 0);
        let activate = |sum| {
            let (address, is_past) = self.address(sum);
            past_the_table += u64::from(is_past);
            self.table[(address + half) as usize]
        };
        let depth = self.words.pass(histogram, activate, record);
        self.saturated_sums.fetch_add(past_the_table, Ordering::Relaxed);
        depth
    }

    /// Depth of a histogram [m].
    pub fn depth_m(&self, histogram: &[u32]) -> f64 {
        let fraction = self.datapath.w2.fraction + self.datapath.l1_out.fraction;
        self.depth(histogram, |_| ()) as f64 * (-f64::from(fraction)).exp2()
    }

    /// Sums that lay past the table, of all histograms seen.
    pub fn saturated_sums(&self) -> u64 {
        self.saturated_sums.load(Ordering::Relaxed)
    }

    /// Bits, with sign, that no sum of a histogram of so many hits exceeds: of the hidden layer and the depth.
    pub fn sum_bits(&self, most_hits: u64) -> [u32; 2] {
        let Weights { w1, b1, w2, b2 } = &self.words;
        let largest = |row: &[i64]| row.iter().map(|weight| weight.abs()).max().unwrap_or(0);
        let hidden = w1.iter().zip(b1);
        let hidden = hidden.map(|(row, bias)| most_hits as i64 * largest(row) + bias.abs());
        let one = self.datapath.l1_out.min().abs();
        let depth = w2.iter().map(|weight| weight.abs() * one).sum::<i64>() + b2.abs();
        [hidden.max().unwrap_or(0), depth].map(|most| i64::BITS - most.leading_zeros() + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::network::{Network, estimate};

    fn peak(bin: usize, height: u32) -> Vec<u32> {
        (0..256).map(|k: usize| height / (1 + k.abs_diff(bin) as u32)).collect()
    }

    #[test]
    fn the_firmware_s_formats_give_what_the_firmware_gives() {
        for name in Network::builtin_names() {
            let network = Network::builtin(name).unwrap().unwrap();
            let circuit = Circuit::new(&network.twin(), Datapath::default()).unwrap();
            for bin in (5..250).step_by(7) {
                let histogram = peak(bin, 200 + 20 * bin as u32);
                let expected =
                    estimate(&network.params(&Default::default()), &histogram).depth.to_f64();
                assert_eq!(circuit.depth_m(&histogram), expected);
            }
            assert_eq!(circuit.saturated_weights, 0);
            let [hidden, depth] = circuit.sum_bits(65_535);
            assert!(hidden <= 36 && depth <= 36, "{hidden} {depth}");
        }
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
    fn a_weight_that_no_word_holds_is_saturated_and_counted() {
        let mut wild = Network::builtin("uniform").unwrap().unwrap().twin();
        wild.w1[0][0] = 1.0;
        let circuit = Circuit::new(&wild, Datapath::default()).unwrap();
        assert_eq!(circuit.saturated_weights, 1);
    }
}
