//! Smooth hidden weights: linear between knots, so that few numbers stand for many.
//!
//! The knots are dense where the echo of a near target falls, which is narrow in time because the
//! first photon decides, and sparse where only pile-up and ambient light are. Where there are fewer bins than
//! knots, each bin has a knot of its own, and those that are left have no bin.

use std::sync::LazyLock;

use tofsim::firmware::histogram_builder::BINS;

/// Number of knots.
pub const KNOTS: usize = 71;

/// Up to which bin the knots have which spacing [bins].
const SPACINGS: [(f64, f64); 5] =
    [(18.0, 9.0), (50.0, 1.5), (100.0, 2.5), (184.0, 4.0), (f64::INFINITY, 12.0)];

/// Places of the knots, from the first bin to beyond the last [bins].
pub fn knots() -> [f64; KNOTS] {
    let mut knots = [0.0f64; KNOTS];
    for k in 1..KNOTS {
        let next = |&(until, spacing): &(f64, f64)| {
            let knot = knots[k - 1] + spacing;
            (knot <= until).then_some(knot)
        };
        knots[k] = SPACINGS.iter().find_map(next).unwrap_or(f64::INFINITY);
    }
    knots
}

/// What a bin takes from the knots around it: the first knot's place and both shares.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Mix {
    knot: usize,
    shares: [f64; 2],
}

/// Places of the knots for echoes from one of so many bins to another: as dense as the thesis's range of distances
/// has them, in parts of the range. Where the range ends near the last bin, no knots are left for what
/// comes behind it.
pub fn knots_between([first, last]: [f64; 2], bins: usize) -> [f64; KNOTS] {
    if bins < BINS {
        let spacing = ((bins - 1) as f64 / (KNOTS - 1) as f64).max(1.0);
        return std::array::from_fn(|k| k as f64 * spacing);
    }
    // The range of the dense knots, and by how much it reaches beyond the echoes of 0.1 to 0.6 m.
    let ((begin, _), (end, spacing)) = (SPACINGS[0], SPACINGS[3]);
    let (before, behind) = (ECHOES[0] - begin, end - ECHOES[1]);
    let end_of_bins = bins as f64 - 0.5;
    let from = (first - before).clamp(LEAST_HEAD, end_of_bins - LEAST_TAIL);
    let until = (last + behind).min(end_of_bins);
    let has_tail = until <= end_of_bins - LEAST_TAIL;
    let mut knots = knots();
    let tail = knots.partition_point(|&knot| knot <= end);
    let (until, last_dense) = match has_tail {
        true => (until, end),
        false => {
            for k in tail..KNOTS {
                knots[k] = knots[k - 1] + spacing;
            }
            (end_of_bins, knots[KNOTS - 1])
        }
    };
    let behind = (end_of_bins - until) / (knots[KNOTS - 1] - last_dense).max(1.0);
    knots.map(|knot| match knot {
        _ if knot <= begin => from * knot / begin,
        _ if knot <= last_dense => from + (until - from) * (knot - begin) / (last_dense - begin),
        _ => until + (knot - last_dense) * behind,
    })
}

/// Least stretch for the knots before and behind the dense ones [bins].
const LEAST_HEAD: f64 = 2.0;
/// See [`LEAST_HEAD`].
const LEAST_TAIL: f64 = 12.0;
/// Bins of the echoes of 0.1 and 0.6 m.
const ECHOES: [f64; 2] = [26.7, 160.1];

/// The matrix of bins and knots; each row has two elements.
#[derive(Clone, Debug)]
pub struct Basis(Vec<Mix>);

impl Basis {
    /// Of so many bins with knots in rising order; of none, of the thesis's.
    pub fn new(knots: &[f64], bins: usize) -> Self {
        match <[f64; KNOTS]>::try_from(knots) {
            Ok(knots) => Basis(mixes(&knots, bins)),
            Err(_) => THESIS.clone(),
        }
    }

    /// Weights of all bins from those at the knots.
    pub fn expand(&self, weights: &[f64]) -> Vec<f64> {
        let at =
            |mix: &Mix| mix.shares[0] * weights[mix.knot] + mix.shares[1] * weights[mix.knot + 1];
        self.0.iter().map(at).collect()
    }

    /// Counts gathered at the knots, so that weights at knots times these are weights of bins times
    /// counts.
    pub fn gather(&self, counts: &[u32]) -> [f64; KNOTS] {
        let mut knots = [0.0; KNOTS];
        for (mix, &count) in self.0.iter().zip(counts) {
            knots[mix.knot] += mix.shares[0] * f64::from(count);
            knots[mix.knot + 1] += mix.shares[1] * f64::from(count);
        }
        knots
    }
}

static THESIS: LazyLock<Basis> = LazyLock::new(|| Basis(mixes(&knots(), BINS)));

fn mixes(knots: &[f64; KNOTS], bins: usize) -> Vec<Mix> {
    let mix = |bin| {
        let at = bin as f64;
        let knot = knots.partition_point(|&knot| knot <= at).clamp(1, KNOTS - 1) - 1;
        let share = (at - knots[knot]) / (knots[knot + 1] - knots[knot]);
        Mix { knot, shares: [1.0 - share, share] }
    };
    (0..bins).map(mix).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_knots_are_denser_where_near_targets_are() {
        let knots = knots();
        assert_eq!(knots[..5], [0.0, 9.0, 18.0, 19.5, 21.0]);
        assert_eq!(knots[22..26], [48.0, 49.5, 52.0, 54.5]);
        assert_eq!(knots[42..46], [97.0, 99.5, 103.5, 107.5]);
        assert_eq!(knots[63..], [179.5, 183.5, 195.5, 207.5, 219.5, 231.5, 243.5, 255.5]);
    }

    #[test]
    fn knots_for_another_range_are_dense_there_and_hold_all_bins() {
        let thesis = knots_between(ECHOES, BINS);
        let apart = thesis.iter().zip(knots()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-9, "{apart}");
        for range in [[13.3, 240.2], [1.0, 20.0], [100.0, 100.0], [0.0, 300.0], [250.0, 255.0]] {
            let knots = knots_between(range, BINS);
            assert!(knots.is_sorted_by(|a, b| a < b), "{range:?}");
            assert!(knots[0] == 0.0 && knots[KNOTS - 1] >= 255.0, "{range:?} {}", knots[KNOTS - 1]);
            let inside = knots.iter().filter(|k| **k > range[0] - 24.0 && **k < range[1] + 24.0);
            assert!(inside.count() > 55, "{range:?} {knots:?}");
        }
    }

    #[test]
    fn few_bins_have_a_knot_each_and_many_are_held_by_the_knots() {
        for bins in [16, 64, 128, 512, 1024] {
            let knots = knots_between([0.1 * bins as f64, 0.9 * bins as f64], bins);
            assert!(knots.is_sorted_by(|a, b| a < b), "{bins}");
            assert!(knots[0] == 0.0 && knots[KNOTS - 1] >= (bins - 1) as f64, "{bins}: {knots:?}");
            let line: Vec<_> = knots.iter().map(|knot| 3.0 - 0.5 * knot).collect();
            let expanded = Basis::new(&knots, bins).expand(&line);
            assert_eq!(expanded.len(), bins);
            for (bin, weight) in expanded.into_iter().enumerate() {
                assert!((weight - (3.0 - 0.5 * bin as f64)).abs() < 1e-9, "{bins}: {bin}");
            }
        }
        assert_eq!(knots_between([2.0, 12.0], 16)[15], 15.0);
    }

    #[test]
    fn a_straight_line_stays_one() {
        let line = knots().map(|knot| 3.0 - 0.5 * knot);
        for (bin, weight) in Basis::new(&[], BINS).expand(&line).into_iter().enumerate() {
            assert!((weight - (3.0 - 0.5 * bin as f64)).abs() < 1e-12, "{bin}");
        }
    }

    #[test]
    fn weights_of_knots_and_of_bins_give_the_same_sums() {
        let weights: [f64; KNOTS] = std::array::from_fn(|k| (k as f64 * 0.9).sin());
        let counts: Vec<_> = (0..256).map(|bin| (bin * bin % 997) as u32).collect();
        let basis = Basis::new(&knots_between([10.0, 240.0], BINS), BINS);
        let bins = basis.expand(&weights).into_iter().zip(&counts).map(|(w, &c)| w * f64::from(c));
        let knots = basis.gather(&counts).iter().zip(weights).map(|(c, w)| c * w).sum::<f64>();
        assert!((bins.sum::<f64>() - knots).abs() < 1e-9);
    }
}
