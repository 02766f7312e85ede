//! The histograms of a centroid estimator's stimulus.

use tofsim::firmware::centroid_estimator::Params;
use tofsim::firmware::histogram_builder::BINS;
use tofsim::sim::fast::centroid::Found;

use crate::golden::estimations::Histogram;
use crate::golden::prelude::*;

/// Largest word [hits].
const MOST: u64 = u16::MAX as u64;
/// Last bin.
const LAST: usize = BINS - 1;
/// How many histograms.
const COUNT: usize = 32;

/// How the bench reads them: as from `histogram_preload`, there is a word while `read_en` is low too.
pub(super) const GLUE: Glue = Glue {
    drives: "count",
    verilog: "  reg [15:0] histograms [0:8191];\n  \
                  initial $readmemh(\"histograms.mem\", histograms);\n  \
                  wire [15:0] count = histograms[{histogram, read_addr}];\n",
    vhdl: (
        "constant histograms : words(0 to 8191) := read_words(\"histograms.mem\", 8192);",
        "count <= std_logic_vector(to_unsigned(histograms(\n    \
         to_integer(unsigned(histogram) & unsigned(read_addr))), 16));",
    ),
};

/// What [`cases`] are of.
pub(super) const CASES: &str =
    "nothing, peak in bin 0, in bin 255, window cut on the left, on the right, equal maxima";

/// Which of the cases those parameters allow: bin 0 does not stand above itself.
pub(super) fn reachable(p: &Params) -> [bool; 6] {
    [true, !p.background, true, !p.background || p.half_width > 1, true, true]
}

/// Which limits of its range an estimation met: nothing stands out; the maximum is the first word, or
/// the last; the window begins before the first word, or ends after the last; a later bin is as high.
pub(super) fn cases(p: &Params, histogram: &[u16; BINS], found: &Found) -> [bool; 6] {
    if found.best == 0 {
        return [true, false, false, false, false, false];
    }
    let (peak, w) = (found.peak, p.half_width as usize);
    // Alone above nothing, so that equal words are equal heights.
    let alone = |bin: usize| histogram[bin.saturating_sub(w)] == 0;
    let again = |bin| alone(peak) && alone(bin) && histogram[bin] == histogram[peak];
    let equal = (peak + 1..BINS).any(again);
    [false, peak == 0, peak == LAST, peak < w, peak + w > LAST, equal]
}

/// Those of every kind.
pub(super) fn new(p: &Params, draw: &mut Draw) -> Vec<Histogram> {
    let w = p.half_width as usize;
    let with = |words: &[(usize, u64)]| {
        let mut histogram = [U::new(0); BINS];
        words.iter().for_each(|&(bin, count)| histogram[bin] = U::new(count));
        histogram
    };
    let from = |word: &dyn Fn(usize) -> u64| std::array::from_fn(|bin| U::new(word(bin)));
    let mut histograms = vec![
        with(&[]),
        from(&|_| MOST / BINS as u64),
        from(&|_| MOST),
        // Steps: the greatest height, and the greatest sums that stand above a level.
        from(&|bin| if bin < BINS / 2 { 0 } else { MOST }),
        from(&|bin| if bin < BINS / 2 { MOST - 1 } else { MOST }),
        from(&|bin| bin as u64),
        from(&|bin| (LAST - bin) as u64),
        with(&[(0, MOST)]),
        with(&[(0, 1)]),
        with(&[(1, MOST)]),
        with(&[(LAST, MOST)]),
        with(&[(LAST, 1)]),
        with(&[(0, 7), (1, 15)]),
        with(&[(0, 7), (1, 14)]),
        // Beside the places where the window is first and last whole.
        with(&[(w - 1, 9), (w + 1, 3)]),
        with(&[(w, 9), (0, 3)]),
        with(&[(w + 1, 9), (0, 100), (1, 8)]),
        with(&[(LAST - w, 9), (LAST, 3)]),
        with(&[(LAST + 1 - w, 9), (LAST, 3)]),
        // Equal maxima: far apart, side by side, with a level below one of them.
        with(&[(40, 500), (41, 2), (200, 500)]),
        with(&[(99, 500), (100, 500), (101, 500)]),
        with(&[(150, 600), (150 - w, 100), (220, 500)]),
        // Hits at both ends of the window.
        with(&[(120, MOST), (120 + w, MOST)]),
        with(&[(120, MOST), (119 - w, MOST), (121 + w, MOST)]),
    ];
    histograms.extend((0..2).map(|_| std::array::from_fn(|_| draw.word())));
    histograms.resize_with(COUNT, || measured(draw));
    histograms
}

/// A histogram with a peak, some of them cut by either end, on a level of ambient light that falls.
fn measured(draw: &mut Draw) -> Histogram {
    let (peak, ambient) = (draw.below(BINS as u64 + 8), draw.below(8) + 1);
    let mut histogram = [U::new(0); BINS];
    for _ in 0..draw.below(MOST) {
        let near = (peak + draw.below(8) + draw.below(8)).saturating_sub(8);
        let early = draw.below(BINS as u64).min(draw.below(BINS as u64));
        let bin = if draw.below(9) < ambient { early } else { near } as usize;
        if let Some(word) = histogram.get_mut(bin) {
            *word = *word + 1;
        }
    }
    histogram
}
