//! The estimator without its clock: bit for bit what the firmware computes, as integer sums.
//!
//! The fixed-point types align the biases; a sum is exact and wraps when it enters its 36-bit word.

use crate::firmware::depth_estimator::Params;
use crate::firmware::forward1::{self, BIAS_ROW};
use crate::firmware::forward2::{self, NEURONS};
use crate::firmware::tansig::address;

use super::Histogram;
use super::formats::{Activation, Depth, HiddenBias, HiddenWeight, L1In, OutputBias, OutputWeight};

/// What an estimation leaves in the registers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Depth word [m].
    pub depth: forward2::Depth,
    /// Sums of the hidden neurons.
    pub l1_in: [forward1::L1In; NEURONS],
}

/// The estimate of a histogram.
pub fn estimate(params: &Params, histogram: &Histogram) -> Estimate {
    let rom = &*params.forward1;
    let mut sums = rom[BIAS_ROW].map(|bias| L1In::from(HiddenBias::from_bits(bias.get() as i16)));
    for (row, &count) in rom.iter().zip(histogram) {
        for (sum, weight) in sums.iter_mut().zip(row) {
            *sum += L1In::from(HiddenWeight::from_bits(weight.get() as i32)) * i64::from(count);
        }
    }
    let l1_in = sums.map(|sum| forward1::L1In::new(sum.to_bits()));
    let mut depth = Depth::from(OutputBias::from_bits(params.forward2.b2.get() as i32));
    for (l1_in, weight) in l1_in.iter().zip(&params.forward2.w2) {
        let activation = Activation::from_bits(params.tansig[address(*l1_in)].get() as i16);
        depth += Depth::from(OutputWeight::from_bits(weight.get() as i16).wide_mul(activation));
    }
    Estimate { depth: forward2::Depth::new(depth.to_bits()), l1_in }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::depth_estimator::{DepthEstimator, In};
    use crate::kernel::{S, U};
    use crate::network::Network;
    use proptest::prelude::*;

    /// The firmware's block, stepped from reset until `algo_done`, and the edges it took.
    fn step(params: &Params, histogram: &Histogram) -> (Estimate, usize) {
        let mut block = DepthEstimator::default();
        let rst = In { rst: true, algo_start: false, count: U::new(0) };
        block.rise(&rst, params);
        block.rise(&In { rst: false, ..rst }, params);
        block.rise(&In { rst: false, algo_start: true, ..rst }, params);
        let mut edges = 0;
        while !block.estimator_ctrl.algo_done {
            let control = &block.estimator_ctrl;
            let word = if control.read_en { histogram[control.read_addr.index()] } else { 0 };
            block.rise(&In { rst: false, algo_start: false, count: U::new(word.into()) }, params);
            edges += 1;
        }
        (Estimate { depth: block.forward2.depth, l1_in: block.forward1.l1_in }, edges)
    }

    fn params() -> Params {
        Network::builtin("uniform").unwrap().unwrap().params()
    }

    #[test]
    fn extreme_histograms_give_what_267_edges_of_the_firmware_give() {
        let mut worst = params();
        let rom = std::sync::Arc::make_mut(&mut worst.forward1);
        rom.iter_mut().for_each(|row| row[..4].fill(S::new(-32768)));
        rom.iter_mut().for_each(|row| row[4..].fill(S::new(32767)));
        worst.forward2.w2.fill(S::new(-32768));
        worst.forward2.b2 = S::new(-32768);
        let one = |bin| std::array::from_fn(|k| if k == bin { u16::MAX } else { 0 });
        for params in [params(), worst] {
            for histogram in [[0; 256], [u16::MAX; 256], [255; 256], one(0), one(255)] {
                let expected = (estimate(&params, &histogram), 267);
                assert_eq!(step(&params, &histogram), expected);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn any_histogram_and_any_weights_give_what_the_firmware_gives(
            histogram in prop::collection::vec(any::<u16>(), 256),
            weights in prop::collection::vec(any::<i16>(), 257 * 8),
            output in prop::collection::vec(any::<i16>(), 9),
            shift in 0..16,
        ) {
            let mut params = params();
            let rom = std::sync::Arc::make_mut(&mut params.forward1);
            for (place, weight) in rom.iter_mut().flatten().zip(&weights) {
                *place = S::new(i64::from(weight >> shift));
            }
            params.forward2.w2 = std::array::from_fn(|k| S::new(output[k].into()));
            params.forward2.b2 = S::new(output[8].into());
            let histogram: Histogram = std::array::from_fn(|bin| histogram[bin] >> shift);
            prop_assert_eq!(step(&params, &histogram), (estimate(&params, &histogram), 267));
        }
    }
}
