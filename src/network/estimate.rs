//! Fixed-point network without a clock: bit-exact with the firmware, computed as integer sums.
//!
//! Sums are exact, and wrap when they are stored in a word.

use crate::firmware::depth_estimator::Params;
use crate::firmware::forward1;
use crate::firmware::forward2::{self, MOST_NEURONS, NEURONS};

/// Final register values of an estimation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Depth word [m].
    pub depth: forward2::Depth,
    /// Sums of the hidden neurons; zero for unused ones.
    pub l1_in: [forward1::L1In; MOST_NEURONS],
}

/// Estimates the depth of a histogram.
pub fn estimate(params: &Params, histogram: &[u32]) -> Estimate {
    let (rom, output) = (&*params.forward1, &params.forward2);
    let mut l1_in = [forward1::L1In::default(); MOST_NEURONS];
    // So many sums that none waits for another, and no more than are wanted.
    for first in (0..params.neurons()).step_by(NEURONS) {
        l1_in[first..first + NEURONS].copy_from_slice(&hidden_sums(rom, first, histogram));
    }
    let products = l1_in.iter().zip(&output.w2).take(params.neurons());
    let terms = products.map(|(l1_in, w2)| params.tansig.activation(*l1_in).get() * w2.get());
    let depth = output.datapath.depth(terms.sum::<i64>() + output.bias());
    Estimate { depth: forward2::Depth::new(depth), l1_in }
}

/// Computes the sums of the neurons from `first` on.
fn hidden_sums(rom: &forward1::Rom, first: usize, histogram: &[u32]) -> [forward1::L1In; NEURONS] {
    let mut sums: [i64; NEURONS] = std::array::from_fn(|unit| rom.bias(first + unit).get());
    for (row, &count) in rom.w1.iter().zip(histogram) {
        for (sum, weight) in sums.iter_mut().zip(&row[first..first + NEURONS]) {
            *sum += weight.get() * i64::from(count);
        }
    }
    sums.map(|sum| rom.sum(sum))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::depth_estimator::datapath::Datapath;
    use crate::firmware::depth_estimator::{DepthEstimator, In};
    use crate::firmware::histogram_builder;
    use crate::firmware::tof_top::slot::SlotEstimator;
    use crate::kernel::{S, U, WordFormat};
    use crate::network::{Network, Weights, roms};
    use proptest::prelude::*;

    /// Steps the firmware's block from reset until `algo_done`, and returns the result and the number of edges.
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

    /// Parameters with the largest possible weights.
    fn worst(neurons: usize) -> Params {
        let mut worst = params("uniform");
        let rom = std::sync::Arc::make_mut(&mut worst.forward1);
        for row in rom.w1.iter_mut().chain([&mut rom.b1]) {
            row[..4].fill(S::new(-32768));
            row[4..neurons].fill(S::new(32767));
        }
        let datapath = worst.forward2.datapath;
        *rom = forward1::Rom::new(
            std::mem::take(&mut rom.w1),
            rom.b1,
            neurons,
            &datapath,
            &histogram_builder::Params::default(),
        );
        worst.forward2.neurons = neurons;
        worst.forward2.w2[..neurons].fill(S::new(-32768));
        worst.forward2.b2 = S::new(-32768);
        worst
    }

    #[test]
    fn extreme_histograms_give_what_267_edges_of_the_firmware_give_or_275_or_291() {
        let most = u32::from(u16::MAX);
        let one = |bin| std::array::from_fn(|k| if k == bin { most } else { 0 });
        let worst = [(worst(8), 267), (worst(16), 275), (worst(32), 291)];
        for (params, edges) in [(params("uniform"), 267)].into_iter().chain(worst) {
            for histogram in [[0; 256], [most; 256], [255; 256], one(0), one(255)] {
                let expected = (estimate(&params, &histogram), edges);
                assert_eq!(step(&params, &histogram), expected);
            }
        }
    }

    /// Random histogram size (bins and count width) with a histogram.
    fn any_size() -> impl Strategy<Value = (usize, u32, Vec<u32>)> {
        let size =
            (4..=10u32, 8..=24u32).prop_map(|(bin_bits, count_bits)| (1 << bin_bits, count_bits));
        size.prop_flat_map(|(bins, count_bits)| {
            let counts = prop::collection::vec(0..1u32 << count_bits, bins);
            (Just(bins), Just(count_bits), counts)
        })
    }

    /// Random number formats that can be built.
    fn any_datapath() -> impl Strategy<Value = Datapath> {
        let word =
            || (2..=24u32, 0..=32u32).prop_map(|(width, fraction)| WordFormat { width, fraction });
        let datapath = (word(), word(), word(), word(), word(), 4..=16u32, 0..=6u32).prop_map(
            |(w1, b1, w2, b2, l1_out, address_bits, range_log2)| {
                let b1 = WordFormat { fraction: b1.fraction.min(w1.fraction), ..b1 };
                let b2 =
                    WordFormat { fraction: b2.fraction.min(w2.fraction + l1_out.fraction), ..b2 };
                Datapath { w1, b1, w2, b2, l1_out, address_bits, range_log2 }
            },
        );
        datapath.prop_filter("formats that cannot be built", |datapath| datapath.fault().is_none())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn any_histogram_and_any_weights_give_what_the_firmware_gives(
            (bins, count_bits, histogram) in any_size(),
            datapath in any_datapath(),
            weights in prop::collection::vec(any::<i32>(), 1025 * 32),
            output in prop::collection::vec(any::<i32>(), 33),
            shift in 0..16,
            neurons in 1usize..=32,
        ) {
            let size = histogram_builder::Params { bins, count_bits };
            let Datapath { w1, b1, w2, b2, .. } = datapath;
            let word = |format: WordFormat, weight: i32| weight >> (32 - format.width);
            let mut rows = weights.chunks(32);
            let mut row = |format| {
                let row = rows.next().into_iter().flatten().take(neurons);
                row.map(|&weight| word(format, weight) >> shift).collect::<Vec<_>>()
            };
            let columns: Vec<_> = (0..bins).map(|_| row(w1)).collect();
            let fixed = Weights {
                w1: (0..neurons).map(|neuron| columns.iter().map(|row| row[neuron]).collect()).collect(),
                b1: row(b1),
                w2: output[..neurons].iter().map(|&weight| word(w2, weight)).collect(),
                b2: word(b2, output[32]),
            };
            let params = roms::params(&fixed, &datapath, &size);
            let histogram: Vec<_> = histogram.iter().map(|&count| count >> shift).collect();
            let edges = (bins + 3 + neurons).max(bins + 7 + neurons.div_ceil(2));
            let expected = (estimate(&params, &histogram), edges);
            prop_assert_eq!(step(&params, &histogram), expected);
        }
    }
}
