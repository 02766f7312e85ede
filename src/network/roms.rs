//! ROM contents of the network estimator.

use std::sync::Arc;

use crate::firmware::depth_estimator::Params;
use crate::firmware::depth_estimator::datapath::Datapath;
use crate::firmware::forward1::{self, Row};
use crate::firmware::forward2;
use crate::firmware::histogram_builder;
use crate::firmware::tansig;
use crate::kernel::S;

use super::file::Network;
use super::weights::Fixed;

impl Network {
    /// Returns whether the network has one input per histogram bin.
    pub fn fits(&self, histogram: &histogram_builder::Params) -> bool {
        self.fixed.bins() == histogram.bins
    }

    /// Returns the estimator's ROMs for a histogram with one bin per input of the network.
    pub fn params(&self, histogram: &histogram_builder::Params) -> Params {
        params(&self.fixed, &self.datapath, histogram)
    }
}

/// Returns the ROMs for weights in a given datapath.
pub fn params(fixed: &Fixed, datapath: &Datapath, histogram: &histogram_builder::Params) -> Params {
    Params {
        forward1: Arc::new(hidden(fixed, datapath, histogram)),
        tansig: tansig::Rom::of(datapath),
        forward2: output(fixed, datapath),
    }
}

/// Builds MEM1: a row of weights for each bin, and the biases.
fn hidden(
    fixed: &Fixed,
    datapath: &Datapath,
    histogram: &histogram_builder::Params,
) -> forward1::Rom {
    let (mut w1, mut b1) = (vec![Row::default(); histogram.bins], Row::default());
    for (neuron, (weights, bias)) in fixed.w1.iter().zip(&fixed.b1).enumerate() {
        for (row, &weight) in w1.iter_mut().zip(weights) {
            row[neuron] = S::new(weight.into());
        }
        b1[neuron] = S::new((*bias).into());
    }
    forward1::Rom::new(w1, b1, fixed.neurons(), datapath, histogram)
}

/// Builds MEM3: the output weights and bias.
fn output(fixed: &Fixed, datapath: &Datapath) -> forward2::Rom {
    let word = |neuron: usize| S::new(fixed.w2.get(neuron).copied().unwrap_or_default().into());
    forward2::Rom {
        neurons: fixed.neurons(),
        w2: std::array::from_fn(word),
        b2: S::new(fixed.b2.into()),
        datapath: *datapath,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_of_the_hidden_rom_is_a_bin() {
        let network = Network::builtin("uniform").unwrap().unwrap();
        let params = network.params(&histogram_builder::Params::default());
        let fixed = &network.fixed;
        assert_eq!(params.forward1.w1[5][2].get(), i64::from(fixed.w1[2][5]));
        assert_eq!(params.forward1.b1[3].get(), i64::from(fixed.b1[3]));
        assert_eq!(params.forward2.w2[7].get(), i64::from(fixed.w2[7]));
        assert_eq!(params.forward2.b2.get(), i64::from(fixed.b2));
        assert_eq!(params.forward1.w1[5][8..], [S::new(0); 24]);
    }
}
