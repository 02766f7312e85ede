//! What the estimator's ROMs hold for a network.

use std::sync::{Arc, LazyLock};

use crate::firmware::depth_estimator::Params;
use crate::firmware::forward1::{self, Row};
use crate::firmware::forward2::{self, MOST_NEURONS, NEURONS};
use crate::firmware::histogram_builder;
use crate::firmware::tansig;
use crate::kernel::S;

use super::file::Network;
use super::formats::{Fixed, L1_OUT, Overflow, TANSIG_RANGE};

impl Network {
    /// Whether it has as many inputs as the histogram has bins.
    pub fn fits(&self, histogram: &histogram_builder::Params) -> bool {
        self.fixed.bins() == histogram.bins
    }

    /// The estimator's ROMs, for such a histogram, which has as many bins as the network has inputs.
    pub fn params(&self, histogram: &histogram_builder::Params) -> Params {
        let (hidden, output) = (hidden(&self.fixed, histogram), output(&self.fixed));
        Params { forward1: Arc::new(hidden), tansig: tansig_table(), forward2: output }
    }
}

/// A network for such a histogram whose weights are all zero.
pub fn blank(histogram: &histogram_builder::Params) -> Params {
    let (w1, b1) = (vec![Row::default(); histogram.bins], Row::default());
    Params {
        forward1: Arc::new(forward1::Rom::new(w1, b1, histogram)),
        tansig: tansig_table(),
        forward2: forward2::Rom { neurons: NEURONS, w2: Default::default(), b2: S::new(0) },
    }
}

/// MEM1: a row of weights for each bin, and the biases.
fn hidden(fixed: &Fixed, histogram: &histogram_builder::Params) -> forward1::Rom {
    let (mut w1, mut b1) = (vec![Row::default(); histogram.bins], Row::default());
    for (neuron, (weights, bias)) in fixed.w1.iter().zip(&fixed.b1).enumerate() {
        for (row, weight) in w1.iter_mut().zip(weights) {
            row[neuron] = S::new(weight.to_bits().into());
        }
        b1[neuron] = S::new(bias.to_bits().into());
    }
    forward1::Rom::new(w1, b1, histogram)
}

/// MEM3.
fn output(fixed: &Fixed) -> forward2::Rom {
    let mut w2 = [S::new(0); MOST_NEURONS];
    for (word, weight) in w2.iter_mut().zip(&fixed.w2) {
        *word = S::new(weight.to_bits().into());
    }
    forward2::Rom { neurons: fixed.neurons(), w2, b2: S::new(fixed.b2.to_bits().into()) }
}

/// MEM2: tanh at each address, a signed 12-bit word over +-4, rounded half away from zero. The
/// last entries would be 1.0, which the word does not have; they are 32767.
pub fn tansig_table() -> Arc<tansig::Rom> {
    static TABLE: LazyLock<Arc<tansig::Rom>> = LazyLock::new(|| {
        let step = 2.0 * TANSIG_RANGE as f64 / tansig::ENTRIES as f64;
        Arc::new(std::array::from_fn(|place| {
            let address = S::<{ tansig::ADDRESS_BITS }>::new(place as i64).get();
            let entry = L1_OUT.round(libm::tanh(address as f64 * step), Overflow::Saturate);
            S::new(entry.unwrap_or_default())
        }))
    });
    TABLE.clone()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_tanh_from_minus_4_to_4_with_its_sign_in_the_top_address_bit() {
        let table = tansig_table();
        let entry = |place: usize| table[place].get();
        assert_eq!([entry(0), entry(1), entry(4095)], [0, 64, -64]);
        assert_eq!(entry(512), 24956, "tanh(1) = 0.761594");
        assert_eq!(entry(2048), -32746, "tanh(-4) = -0.999329");
        assert_eq!(entry(2047), 32746);
        for place in 1..2048 {
            assert_eq!(entry(place), -entry(4096 - place));
            assert!(entry(place) >= entry(place - 1));
        }
    }

    #[test]
    fn a_row_of_the_hidden_rom_is_a_bin() {
        let network = Network::builtin("uniform").unwrap().unwrap();
        let params = network.params(&histogram_builder::Params::default());
        let fixed = &network.fixed;
        assert_eq!(params.forward1.w1[5][2].get(), i64::from(fixed.w1[2][5].to_bits()));
        assert_eq!(params.forward1.b1[3].get(), i64::from(fixed.b1[3].to_bits()));
        assert_eq!(params.forward2.w2[7].get(), i64::from(fixed.w2[7].to_bits()));
        assert_eq!(params.forward2.b2.get(), i64::from(fixed.b2.to_bits()));
        assert_eq!(params.forward1.w1[5][8..], [S::new(0); 8]);
    }
}
