//! The histograms of a depth estimator's stimulus.

use tofsim::firmware::depth_estimator::Params;
use tofsim::firmware::forward1::BIAS_ROW;
use tofsim::firmware::forward2::NEURONS;
use tofsim::firmware::histogram_builder::BINS;
use tofsim::firmware::tansig::{ENTRIES, address};

use crate::golden::estimations::Histogram;
use crate::golden::prelude::*;

/// Hits of a full frame.
const HITS: u64 = u16::MAX as u64;
/// How many histograms.
const COUNT: usize = 64;
/// How many are measured ones that each estimator under test must have seen, at least.
const MEASURED: usize = 5;

/// How the bench reads them.
pub(super) const GLUE: Glue = Glue {
    drives: "count",
    verilog: "  reg [15:0] histograms [0:16383];\n  \
                  initial $readmemh(\"histograms.mem\", histograms);\n  \
                  wire [15:0] count = read_en ? histograms[{histogram, read_addr}] : 16'd0;\n",
    vhdl: (
        "constant histograms : words(0 to 16383) := read_words(\"histograms.mem\", 16384);",
        "count <= std_logic_vector(to_unsigned(histograms(\n    \
         to_integer(unsigned(histogram) & unsigned(read_addr))), 16)) when read_en = '1'\n    \
         else (others => '0');",
    ),
};

/// Empty, level, random, all hits in the bin that drives each neuron to either end, more than there
/// can be for sums of the whole width of eight neurons, and measured ones; how many of them are not
/// just more of the last kind; and what of the tansig's ends they reach, as neuron x 4096 + address.
pub(super) fn new(params: &Params, draw: &mut Draw) -> (Vec<Histogram>, u64, Vec<u64>) {
    let level = [U::new(HITS / BINS as u64); BINS];
    let random = std::array::from_fn(|_| draw.word());
    let mut histograms = vec![[U::new(0); BINS], level, random];
    let mut ends = Vec::new();
    for neuron in 0..params.neurons() {
        let row = |row: usize| params.forward1[row][neuron].get();
        let sum = |bin: &usize| HITS as i64 * row(*bin) + 1024 * row(BIAS_ROW);
        let (low, high) = ((0..BINS).min_by_key(sum), (0..BINS).max_by_key(sum));
        for (bin, end) in [(low, ENTRIES / 2), (high, ENTRIES / 2 - 1)] {
            let bin = bin.unwrap_or_default();
            let mut histogram = [U::new(0); BINS];
            histogram[bin] = U::new(HITS);
            histograms.push(histogram);
            if address(S::new(sum(&bin))) == end {
                ends.push((neuron * ENTRIES + end) as u64);
            }
        }
    }
    histograms.extend((0..params.neurons().min(NEURONS)).map(|neuron| {
        let up = |bin: usize| params.forward1[bin][neuron].get() > 0;
        std::array::from_fn(|bin| if up(bin) { U::MAX } else { U::new(0) })
    }));
    let special = (histograms.len() + MEASURED) as u64;
    histograms.resize_with(COUNT, || measured(draw));
    (histograms, special, ends)
}

/// A histogram with a peak on a level of ambient light.
fn measured(draw: &mut Draw) -> Histogram {
    let (peak, ambient) = (draw.below(BINS as u64 - 16), draw.below(8) + 1);
    let mut histogram = [U::new(0); BINS];
    for _ in 0..draw.below(HITS) {
        let near = peak + draw.below(8) + draw.below(8);
        let bin = if draw.below(9) < ambient { draw.below(BINS as u64) } else { near };
        histogram[bin as usize] = histogram[bin as usize] + 1;
    }
    histogram
}
