//! Smooth hidden weights: linear between knots, so that few numbers stand for 256.
//!
//! The knots are dense where the echo of a near target falls, which is narrow in time because the
//! first photon decides, and sparse where only pile-up and ambient light are.

use std::sync::LazyLock;

use tofsim::firmware::histogram_builder::BINS;
use tofsim::network::Histogram;

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

/// The matrix of bins and knots; each row has two elements.
static MIXES: LazyLock<[Mix; BINS]> = LazyLock::new(|| {
    let knots = knots();
    std::array::from_fn(|bin| {
        let at = bin as f64;
        let knot = knots.partition_point(|&knot| knot <= at).clamp(1, KNOTS - 1) - 1;
        let share = (at - knots[knot]) / (knots[knot + 1] - knots[knot]);
        Mix { knot, shares: [1.0 - share, share] }
    })
});

/// Weights of all bins from those at the knots.
pub fn expand(weights: &[f64]) -> [f64; BINS] {
    let at = |mix: &Mix| mix.shares[0] * weights[mix.knot] + mix.shares[1] * weights[mix.knot + 1];
    std::array::from_fn(|bin| at(&MIXES[bin]))
}

/// Counts gathered at the knots, so that weights at knots times these are weights of bins times
/// counts.
pub fn gather(counts: &Histogram) -> [f64; KNOTS] {
    let mut knots = [0.0; KNOTS];
    for (mix, &count) in MIXES.iter().zip(counts) {
        knots[mix.knot] += mix.shares[0] * f64::from(count);
        knots[mix.knot + 1] += mix.shares[1] * f64::from(count);
    }
    knots
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
    fn a_straight_line_stays_one() {
        let line = knots().map(|knot| 3.0 - 0.5 * knot);
        for (bin, weight) in expand(&line).into_iter().enumerate() {
            assert!((weight - (3.0 - 0.5 * bin as f64)).abs() < 1e-12, "{bin}");
        }
    }

    #[test]
    fn weights_of_knots_and_of_bins_give_the_same_sums() {
        let weights: [f64; KNOTS] = std::array::from_fn(|k| (k as f64 * 0.9).sin());
        let counts: Histogram = std::array::from_fn(|bin| (bin * bin % 997) as u16);
        let bins = expand(&weights).into_iter().zip(counts).map(|(w, c)| w * f64::from(c));
        let knots = gather(&counts).iter().zip(weights).map(|(c, w)| c * w).sum::<f64>();
        assert!((bins.sum::<f64>() - knots).abs() < 1e-9);
    }
}
