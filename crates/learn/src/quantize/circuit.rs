//! A network in a datapath: its depths, and what saturates.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use tofsim::error::Result;
use tofsim::firmware::depth_estimator::datapath::{DEPTH_FRACTION, Datapath};
use tofsim::firmware::forward1::L1In;
use tofsim::firmware::tansig;
use tofsim::kernel::{Overflow, wrapped};
use tofsim::network::Fixed;
use tofsim::network::Weights;
use tofsim::network::float::Float;
use tofsim::network::pass::HiddenNeuron;

/// A network in a datapath.
#[derive(Debug)]
pub struct Circuit {
    datapath: Datapath,
    /// The words as integers, biases aligned with the products.
    words: Weights<i64, i64, i64, i64>,
    /// Activations by address.
    table: Arc<tansig::Rom>,
    /// Weights that no word holds, and were saturated.
    pub saturated_weights: usize,
    /// Sums that lay past the table, of all histograms seen.
    saturated_sums: AtomicU64,
}

impl Circuit {
    /// Rounds the weights, halves away from zero; what no word holds is saturated.
    ///
    /// # Errors
    /// When the datapath cannot be built, or a weight is no number.
    pub fn new(float: &Float, datapath: &Datapath) -> Result<Self> {
        datapath.check("datapath")?;
        let rounded = float.round("network", datapath, Overflow::Saturate)?;
        let circuit = Circuit::of_words(&rounded.fixed, datapath);
        Ok(Circuit { saturated_weights: rounded.saturated, ..circuit })
    }

    /// A network in the words of a datapath.
    pub fn of_words(fixed: &Fixed, datapath: &Datapath) -> Self {
        let shifts = (datapath.hidden_bias_shift(), datapath.output_bias_shift());
        let word = i64::from;
        let words =
            fixed.map(word, |b1| i64::from(b1) << shifts.0, word, |b2| i64::from(b2) << shifts.1);
        Circuit {
            datapath: *datapath,
            words,
            table: tansig::Rom::of(datapath),
            saturated_weights: 0,
            saturated_sums: AtomicU64::new(0),
        }
    }

    /// Address of a sum in the table of activations, signed, and whether the sum lies past the table.
    pub fn address(&self, sum: i64) -> (i64, bool) {
        let address =
            wrapped(self.table.address(L1In::new(sum)) as i64, self.datapath.address_bits);
        let rounded = (sum + (1 << (self.table.shift - 1))) >> self.table.shift;
        (address, address != rounded)
    }

    /// Depth of a histogram as the word that it is, not wrapped; `record` is shown every neuron.
    pub fn depth(&self, histogram: &[u32], record: impl FnMut(HiddenNeuron<i64>)) -> i64 {
        let mut past_the_table = 0;
        let activate = |sum| {
            past_the_table += u64::from(self.address(sum).1);
            self.table.activation(L1In::new(sum)).get()
        };
        let sum = self.words.pass(histogram, activate, record);
        self.saturated_sums.fetch_add(past_the_table, Ordering::Relaxed);
        self.datapath.depth(sum)
    }

    /// Depth of a histogram [m].
    pub fn depth_m(&self, histogram: &[u32]) -> f64 {
        self.depth(histogram, |_| ()) as f64 * (-f64::from(DEPTH_FRACTION)).exp2()
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
    use tofsim::firmware::histogram_builder::Params;
    use tofsim::network::{Network, estimate};

    fn peak(bin: usize, height: u32) -> Vec<u32> {
        peak_of(256, bin, height)
    }

    fn peak_of(bins: usize, bin: usize, height: u32) -> Vec<u32> {
        (0..bins).map(|k| height / (1 + k.abs_diff(bin) as u32)).collect()
    }

    #[test]
    fn the_firmware_s_formats_give_what_the_firmware_gives() {
        for name in Network::builtin_names() {
            let network = Network::builtin(name).unwrap().unwrap();
            let circuit = Circuit::new(&network.twin(), &network.datapath).unwrap();
            let size = Params { bins: network.fixed.bins(), ..Params::default() };
            for bin in (5..size.bins - 6).step_by(7) {
                let histogram = peak_of(size.bins, bin, 200 + 20 * (bin % 250) as u32);
                let expected = estimate(&network.params(&size), &histogram).depth.to_f64();
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
            let datapath = Datapath { address_bits, range_log2: 3, ..Datapath::THESIS };
            let circuit = Circuit::new(&float, &datapath).unwrap();
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
        let circuit = Circuit::new(&wild, &Datapath::THESIS).unwrap();
        assert_eq!(circuit.saturated_weights, 1);
    }
}
