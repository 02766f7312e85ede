//! Argmax with centroid correction, without its clock: bit for bit what
//! [`centroid_estimator`](crate::firmware::centroid_estimator) computes, as sums over its window.

use crate::firmware::centroid_estimator::{CentroidEstimator, POSITION_FRACTION, Params, Position};
use crate::firmware::forward2::Depth;
use crate::firmware::tof_top::slot::EstimateWords;

use super::Clockless;

/// The result of an estimation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Found {
    /// Depth word, 0 where nothing stands out [m].
    pub depth: Depth,
    /// Height of the highest bin above the background, 0 where nothing stands out [hits].
    pub best: u32,
    /// Bin of that height.
    pub peak: usize,
    /// Hits in its window.
    pub best_sum: u64,
}

impl Clockless for CentroidEstimator {
    fn estimate(p: &Params, histogram: &[u32]) -> EstimateWords {
        EstimateWords::of_depth(locate(p, histogram).depth)
    }
}

/// Estimates the depth of a histogram.
pub fn locate(p: &Params, histogram: &[u32]) -> Found {
    let w = p.half_width as usize;
    let (mut best, mut peak) = (0, 0);
    for (bin, &count) in histogram.iter().enumerate() {
        let height = count.saturating_sub(level(p, histogram, bin));
        if height > best {
            (best, peak) = (height, bin);
        }
    }
    if best == 0 {
        return Found::default();
    }
    let end = peak + w;
    let window = histogram.iter().enumerate().take(end + 1).skip(peak.saturating_sub(w));
    let (mut best_sum, mut ages) = (0, 0);
    for (bin, &count) in window {
        best_sum += u64::from(count);
        ages += u64::from(count) * (end - bin) as u64;
    }
    let quotient = (ages << POSITION_FRACTION) / best_sum;
    let half = 1 << (POSITION_FRACTION - 1);
    let position = ((end as u64) << POSITION_FRACTION) + half - quotient;
    let depth = p.depth(Position::from_bits(position as u32));
    Found { depth, best, peak, best_sum }
}

/// The background at a bin: the word at the begin of its window. Before bin 0 there is none; twice
/// bin 0 stands for those.
fn level(p: &Params, histogram: &[u32], bin: usize) -> u32 {
    match bin.checked_sub(p.half_width as usize) {
        _ if !p.background => 0,
        Some(first) => histogram[first],
        None => 2 * histogram[0],
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::firmware::centroid_estimator::In;
    use crate::firmware::histogram_builder;
    use crate::firmware::tof_top::slot::SlotEstimator;
    use crate::kernel::{S, U};

    /// The firmware's block, stepped from a start until `algo_done`, and the edges it took.
    fn step(p: &Params, histogram: &[u32]) -> (Depth, u64) {
        let mut block = CentroidEstimator::default();
        let mut i = In { rst: false, algo_start: true, count: U::new(0) };
        block.rise(&i, p);
        i.algo_start = false;
        let mut edges = 0;
        while !block.registers.algo_done {
            let word = histogram[block.registers.read_addr.index()];
            block.rise(&In { count: U::new(word.into()), ..i }, p);
            edges += 1;
        }
        (block.registers.depth, edges)
    }

    fn one(bin: usize, count: u32) -> [u32; 256] {
        std::array::from_fn(|k| if k == bin { count } else { 0 })
    }

    #[test]
    fn extreme_histograms_give_what_311_edges_of_the_firmware_give() {
        let (offset, most) = (S::new(-(1 << 29)), U::MAX);
        let most_hits = u32::from(u16::MAX);
        for half_width in [1, 2, 16, 30, 31] {
            for background in [false, true] {
                let p = Params { half_width, background, ..Params::default() };
                for p in [p, Params { slope: most, offset, ..p }] {
                    let level = [[0; 256], [255; 256], [most_hits; 256]];
                    let ones = (0..256).flat_map(|bin| [one(bin, 1), one(bin, most_hits)]);
                    let steps = (0..256).map(|edge| {
                        std::array::from_fn(|bin| if bin < edge { 3 } else { most_hits })
                    });
                    for histogram in level.into_iter().chain(ones).chain(steps) {
                        let expected = (locate(&p, &histogram).depth, p.done());
                        assert_eq!(step(&p, &histogram), expected, "{p:?} {histogram:?}");
                    }
                }
            }
        }
    }

    proptest! {
        #[test]
        fn any_histogram_and_any_parameters_give_what_the_firmware_gives(
            (bin_bits, count_bits) in (4..=10u32, 8..=24u32),
            counts in prop::collection::vec(any::<u32>(), 1024),
            shift in 0..16,
            half_width in 1..=31u64,
            background: bool,
            slope: u64,
            offset: i64,
        ) {
            let p = Params {
                half_width,
                background,
                slope: U::new(slope),
                offset: S::new(offset),
                histogram: histogram_builder::Params { bins: 1 << bin_bits, count_bits },
            };
            let most = (1 << count_bits) - 1;
            let counts = counts.iter().take(1 << bin_bits);
            let histogram: Vec<_> = counts.map(|&count| (count & most) >> shift).collect();
            prop_assert_eq!(step(&p, &histogram), (locate(&p, &histogram).depth, p.done()));
        }
    }

    #[test]
    fn a_symmetric_pulse_is_found_at_its_middle_on_any_level() {
        for level in [0, 200] {
            let pulse = |bin: usize| 1000u32.saturating_sub(100 * bin.abs_diff(80) as u32);
            let histogram: [u32; 256] = std::array::from_fn(|bin| level + pulse(bin));
            let found = locate(&Params::default(), &histogram);
            assert_eq!((found.peak, found.best), (80, 1000));
            let metres = 80.5 * 0.003_747_405_725;
            assert!((found.depth.to_f64() - metres).abs() < 2e-6, "{}", found.depth.to_f64());
        }
    }

    #[test]
    fn what_has_no_peak_stands_out_nowhere() {
        assert_eq!(locate(&Params::default(), &[0; 256]), Found::default());
        assert_eq!(locate(&Params::default(), &[100; 256]), Found::default());
    }
}
