//! The histograms of a centroid estimator's stimulus.

use tofsim::firmware::centroid_estimator::Params;
use tofsim::firmware::histogram_builder;
use tofsim::sim::estimates::centroid::Found;

use crate::golden::estimations::{Histogram, draws};
use crate::golden::prelude::*;

/// Number of histograms.
const COUNT: usize = 32;

/// Connection of `count` in the bench: as from `histogram_preload`, there is a word while `read_en` is low
/// too.
pub(super) const GLUE: Glue = Glue { histograms: COUNT, gated: false };

/// Description of [`cases`].
pub(super) const CASES: &str =
    "nothing, peak in the first bin, in the last, window cut on the left, on the right, equal maxima";

/// Marks the cases that those parameters allow: bin 0 does not stand above itself.
pub(super) fn reachable(p: &Params) -> [bool; 6] {
    [true, !p.background, true, !p.background || p.half_width > 1, true, true]
}

/// Marks the limits of its range that an estimation met: nothing stands out; the maximum is the first word,
/// or the last; the window begins before the first word, or ends after the last; a later bin is as high.
pub(super) fn cases(p: &Params, histogram: &[u32], found: &Found) -> [bool; 6] {
    if found.best == 0 {
        return [true, false, false, false, false, false];
    }
    let (peak, w) = (found.peak, p.half_width as usize);
    // Alone above nothing, so that equal words are equal heights.
    let alone = |bin: usize| histogram[bin.saturating_sub(w)] == 0;
    let again = |bin| alone(peak) && alone(bin) && histogram[bin] == histogram[peak];
    let (bins, last) = (histogram.len(), histogram.len() - 1);
    let equal = (peak + 1..bins).any(again);
    [false, peak == 0, peak == last, peak < w, peak + w > last, equal]
}

/// Draws histograms of every kind.
pub(super) fn new(p: &Params, draw: &mut Draw) -> Vec<Histogram> {
    let (w, size) = (p.half_width as usize, &p.histogram);
    let (bins, last, most) = (size.bins, size.bins - 1, size.most_hits());
    // A bin of 256, and one so far before it as there are bins.
    let at = |bin: usize| bin * bins / 256;
    let before = |bin: usize, by: usize| bin.saturating_sub(by);
    let with = |words: &[(usize, u64)]| {
        let mut histogram = vec![U::new(0); bins];
        let words = words.iter().filter(|(bin, _)| *bin < bins);
        words.for_each(|&(bin, count)| histogram[bin] = U::new(count.min(most)));
        histogram
    };
    let from = |word: &dyn Fn(usize) -> u64| {
        (0..bins).map(|bin| U::new(word(bin).min(most))).collect::<Histogram>()
    };
    let mut histograms = vec![
        with(&[]),
        from(&|_| most / bins as u64),
        from(&|_| most),
        // Steps: the greatest height, and the greatest sums that stand above a level.
        from(&|bin| if bin < bins / 2 { 0 } else { most }),
        from(&|bin| if bin < bins / 2 { most - 1 } else { most }),
        from(&|bin| bin as u64),
        from(&|bin| (last - bin) as u64),
        with(&[(0, most)]),
        with(&[(0, 1)]),
        with(&[(1, most)]),
        with(&[(last, most)]),
        with(&[(last, 1)]),
        with(&[(0, 7), (1, 15)]),
        with(&[(0, 7), (1, 14)]),
        // Beside the places where the window is first and last whole.
        with(&[(w - 1, 9), (w + 1, 3)]),
        with(&[(w, 9), (0, 3)]),
        with(&[(w + 1, 9), (0, 100), (1, 8)]),
        with(&[(before(last, w), 9), (last, 3)]),
        with(&[(before(last + 1, w), 9), (last, 3)]),
        // Equal maxima: far apart, side by side, with a level below one of them.
        with(&[(at(40), 500), (at(40) + 1, 2), (at(200), 500)]),
        with(&[(at(99), 500), (at(99) + 1, 500), (at(99) + 2, 500)]),
        with(&[(at(150), 600), (before(at(150), w), 100), (at(220), 500)]),
        // Hits at both ends of the window.
        with(&[(at(120), most), (at(120) + w, most)]),
        with(&[(at(120), most), (before(at(120), w + 1), most), (at(120) + 1 + w, most)]),
    ];
    histograms.extend((0..2).map(|_| (0..bins).map(|_| U::new(draw.bits() & most)).collect()));
    histograms.resize_with(COUNT, || measured(size, draw));
    histograms
}

/// A histogram with a peak, some of them cut by either end, on a level of ambient light that falls.
fn measured(size: &histogram_builder::Params, draw: &mut Draw) -> Histogram {
    let (bins, (hits, each)) = (size.bins as u64, draws(size));
    let (peak, ambient) = (draw.below(bins + 8), draw.below(8) + 1);
    let mut histogram = vec![U::new(0); size.bins];
    for _ in 0..draw.below(hits) {
        let near = (peak + draw.below(8) + draw.below(8)).saturating_sub(8);
        let early = draw.below(bins).min(draw.below(bins));
        let bin = if draw.below(9) < ambient { early } else { near } as usize;
        if let Some(word) = histogram.get_mut(bin) {
            *word = *word + each;
        }
    }
    histogram
}
