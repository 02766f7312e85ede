//! The histograms of a depth estimator's stimulus.

use tofsim::firmware::depth_estimator::Params;
use tofsim::firmware::forward2::NEURONS;
use tofsim::firmware::histogram_builder;

use crate::golden::estimations::{Histogram, draws};
use crate::golden::prelude::*;

/// Number of histograms.
const COUNT: usize = 128;
/// Number of measured histograms that each estimator under test must have seen, at least.
const MEASURED: usize = 5;

/// Connection of `count` in the bench.
pub(super) const GLUE: Glue = Glue { histograms: COUNT, gated: true };

/// Empty, level, random, all hits in the bin that drives each neuron to either end, more than there
/// can be for sums of the whole width of eight neurons, and measured ones; how many of them are not
/// just more of the last kind; and what of the tansig's ends they reach, as neuron x entries + address.
pub(super) fn new(
    params: &Params,
    size: &histogram_builder::Params,
    draw: &mut Draw,
) -> (Vec<Histogram>, u64, Vec<u64>) {
    let (bins, most) = (size.bins, size.most_hits());
    let level = vec![U::new(most / bins as u64); bins];
    let random = (0..bins).map(|_| U::new(draw.bits() & most)).collect();
    let mut histograms = vec![vec![U::new(0); bins], level, random];
    let mut ends = Vec::new();
    for neuron in 0..params.neurons() {
        let rom = &params.forward1;
        let sum = |bin: &usize| {
            most as i64 * rom.w1[*bin][neuron].get() + rom.bias(neuron).get()
        };
        let (low, high) = ((0..bins).min_by_key(sum), (0..bins).max_by_key(sum));
        let entries = params.tansig.entries.len();
        for (bin, end) in [(low, entries / 2), (high, entries / 2 - 1)] {
            let bin = bin.unwrap_or_default();
            let mut histogram = vec![U::new(0); bins];
            histogram[bin] = U::new(most);
            histograms.push(histogram);
            if params.tansig.address(rom.sum(sum(&bin))) == end {
                ends.push((neuron * entries + end) as u64);
            }
        }
    }
    histograms.extend((0..params.neurons().min(NEURONS)).map(|neuron| {
        let up = |bin: usize| params.forward1.w1[bin][neuron].get() > 0;
        (0..bins).map(|bin| U::new(if up(bin) { most } else { 0 })).collect()
    }));
    let special = (histograms.len() + MEASURED) as u64;
    histograms.resize_with(COUNT, || measured(size, draw));
    (histograms, special, ends)
}

/// A histogram with a peak on a level of ambient light.
fn measured(size: &histogram_builder::Params, draw: &mut Draw) -> Histogram {
    let (bins, (hits, each)) = (size.bins as u64, draws(size));
    let (peak, ambient) = (draw.below((bins - 16).max(1)), draw.below(8) + 1);
    let mut histogram = vec![U::new(0); size.bins];
    for _ in 0..draw.below(hits) {
        let near = peak + draw.below(8) + draw.below(8);
        let bin = if draw.below(9) < ambient { draw.below(bins) } else { near };
        histogram[bin as usize] = histogram[bin as usize] + each;
    }
    histogram
}
