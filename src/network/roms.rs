//! What the estimator's ROMs hold for a network.

use std::sync::{Arc, LazyLock};

use crate::firmware::depth_estimator::Params;
use crate::firmware::depth_estimator::datapath::Datapath;
use crate::firmware::forward1::{self, Row};
use crate::firmware::forward2::{self, NEURONS};
use crate::firmware::histogram_builder;
use crate::firmware::tansig;
use crate::kernel::S;

use super::file::Network;
use super::weights::{Fixed, Weights};

impl Network {
    /// Whether it has as many inputs as the histogram has bins.
    pub fn fits(&self, histogram: &histogram_builder::Params) -> bool {
        self.fixed.bins() == histogram.bins
    }

    /// The estimator's ROMs, for such a histogram, which has as many bins as the network has inputs.
    pub fn params(&self, histogram: &histogram_builder::Params) -> Params {
        params(&self.fixed, &self.datapath, histogram)
    }
}

/// The ROMs of words in such a datapath, for such a histogram.
pub fn params(fixed: &Fixed, datapath: &Datapath, histogram: &histogram_builder::Params) -> Params {
    Params {
        forward1: Arc::new(hidden(fixed, datapath, histogram)),
        tansig: tansig_table(datapath),
        forward2: output(fixed, datapath),
    }
}

/// A network for such a histogram whose weights are all zero, with the thesis's neurons and formats.
pub fn blank(histogram: &histogram_builder::Params) -> Params {
    let w1 = vec![vec![0; histogram.bins]; NEURONS];
    let fixed = Weights { w1, b1: vec![0; NEURONS], w2: vec![0; NEURONS], b2: 0 };
    params(&fixed, &Datapath::THESIS, histogram)
}

/// MEM1: a row of weights for each bin, and the biases.
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

/// MEM3.
fn output(fixed: &Fixed, datapath: &Datapath) -> forward2::Rom {
    let word = |neuron: usize| S::new(fixed.w2.get(neuron).copied().unwrap_or_default().into());
    forward2::Rom {
        neurons: fixed.neurons(),
        w2: std::array::from_fn(word),
        b2: S::new(fixed.b2.into()),
        datapath: *datapath,
    }
}

/// MEM2, made once for the thesis's formats.
fn tansig_table(datapath: &Datapath) -> Arc<tansig::Rom> {
    static THESIS: LazyLock<Arc<tansig::Rom>> =
        LazyLock::new(|| Arc::new(tansig::Rom::new(&Datapath::THESIS)));
    match *datapath == Datapath::THESIS {
        true => THESIS.clone(),
        false => Arc::new(tansig::Rom::new(datapath)),
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
