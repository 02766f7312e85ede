//! The estimator without its clock: bit for bit what the firmware computes, as integer sums.
//!
//! The fixed-point types align the biases; a sum is exact and wraps when it enters its 36-bit word.

use crate::firmware::depth_estimator::Params;
use crate::firmware::forward1;
use crate::firmware::forward2::{self, MOST_NEURONS, NEURONS};
use crate::firmware::tansig::address;

use super::formats::{Activation, Depth, HiddenBias, HiddenWeight, L1In, OutputBias, OutputWeight};

/// What an estimation leaves in the registers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Depth word [m].
    pub depth: forward2::Depth,
    /// Sums of the hidden neurons; zero past the last.
    pub l1_in: [forward1::L1In; MOST_NEURONS],
}

/// The estimate of a histogram.
pub fn estimate(params: &Params, histogram: &[u32]) -> Estimate {
    let rom = &*params.forward1;
    let mut l1_in = [forward1::L1In::default(); MOST_NEURONS];
    // So many sums that none waits for another, and no more than are wanted.
    match params.neurons() <= NEURONS {
        true => l1_in[..NEURONS].copy_from_slice(&hidden_sums::<NEURONS>(rom, histogram)),
        false => l1_in = hidden_sums(rom, histogram),
    }
    let mut depth = Depth::from(OutputBias::from_bits(params.forward2.b2.get() as i32));
    for (l1_in, weight) in l1_in.iter().zip(&params.forward2.w2) {
        let activation = Activation::from_bits(params.tansig[address(*l1_in)].get() as i16);
        depth += Depth::from(OutputWeight::from_bits(weight.get() as i16).wide_mul(activation));
    }
    Estimate { depth: forward2::Depth::new(depth.to_bits()), l1_in }
}

/// Sums of the first neurons.
fn hidden_sums<const N: usize>(rom: &forward1::Rom, histogram: &[u32]) -> [forward1::L1In; N] {
    let bias = |bias: i64| L1In::from(HiddenBias::from_bits(bias as i16));
    let mut sums: [L1In; N] = std::array::from_fn(|neuron| bias(rom.b1[neuron].get()));
    for (row, &count) in rom.w1.iter().zip(histogram) {
        for (sum, weight) in sums.iter_mut().zip(row) {
            *sum += L1In::from(HiddenWeight::from_bits(weight.get() as i32)) * i64::from(count);
        }
    }
    sums.map(|sum| rom.sum(sum.to_bits()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::depth_estimator::{DepthEstimator, In};
    use crate::firmware::histogram_builder;
    use crate::kernel::{S, U};
    use crate::network::{Network, blank};
    use proptest::prelude::*;

    /// The firmware's block, stepped from reset until `algo_done`, and the edges it took.
    fn step(params: &Params, histogram: &[u32]) -> (Estimate, usize) {
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

    fn params(name: &str) -> Params {
        Network::builtin(name).unwrap().unwrap().params(&Default::default())
    }

    /// The largest weights there are, for so many neurons.
    fn worst(neurons: usize) -> Params {
        let mut worst = params("uniform");
        let rom = std::sync::Arc::make_mut(&mut worst.forward1);
        for row in rom.w1.iter_mut().chain([&mut rom.b1]) {
            row[..4].fill(S::new(-32768));
            row[4..neurons].fill(S::new(32767));
        }
        worst.forward2.neurons = neurons;
        worst.forward2.w2[..neurons].fill(S::new(-32768));
        worst.forward2.b2 = S::new(-32768);
        worst
    }

    #[test]
    fn extreme_histograms_give_what_267_edges_of_the_firmware_give_or_275() {
        let most = u32::from(u16::MAX);
        let one = |bin| std::array::from_fn(|k| if k == bin { most } else { 0 });
        for (params, edges) in [(params("uniform"), 267), (worst(8), 267), (worst(16), 275)] {
            for histogram in [[0; 256], [most; 256], [255; 256], one(0), one(255)] {
                let expected = (estimate(&params, &histogram), edges);
                assert_eq!(step(&params, &histogram), expected);
            }
        }
    }

    /// Bins, bits of a count, and a histogram of that size.
    fn any_size() -> impl Strategy<Value = (usize, u32, Vec<u32>)> {
        let size =
            (4..=10u32, 8..=24u32).prop_map(|(bin_bits, count_bits)| (1 << bin_bits, count_bits));
        size.prop_flat_map(|(bins, count_bits)| {
            let counts = prop::collection::vec(0..1u32 << count_bits, bins);
            (Just(bins), Just(count_bits), counts)
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn any_histogram_and_any_weights_give_what_the_firmware_gives(
            (bins, count_bits, histogram) in any_size(),
            weights in prop::collection::vec(any::<i16>(), 1025 * 16),
            output in prop::collection::vec(any::<i16>(), 17),
            shift in 0..16,
            neurons in 1usize..=16,
        ) {
            let size = histogram_builder::Params { bins, count_bits };
            let mut params = blank(&size);
            let rom = std::sync::Arc::make_mut(&mut params.forward1);
            for (row, weights) in rom.w1.iter_mut().chain([&mut rom.b1]).zip(weights.chunks(16)) {
                for (neuron, (place, weight)) in row.iter_mut().zip(weights).enumerate() {
                    *place = S::new(if neuron < neurons { i64::from(weight >> shift) } else { 0 });
                }
            }
            let w2 = |k: usize| if k < neurons { output[k].into() } else { 0 };
            params.forward2.w2 = std::array::from_fn(|k| S::new(w2(k)));
            params.forward2.b2 = S::new(output[16].into());
            params.forward2.neurons = neurons;
            let histogram: Vec<_> = histogram.iter().map(|&count| count >> shift).collect();
            let edges = (bins + 3 + neurons).max(bins + 7 + neurons.div_ceil(2));
            let expected = (estimate(&params, &histogram), edges);
            prop_assert_eq!(step(&params, &histogram), expected);
        }
    }
}
