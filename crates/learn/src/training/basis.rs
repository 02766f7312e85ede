//! Smooth hidden weights: linear between knots, so that few numbers stand for many.
//!
//! The knots are dense where the echo of a near target falls, which is narrow in time because the
//! first photon decides, and sparse where only pile-up and ambient light are. How dense is a matter of the
//! pulse's width, for a smooth pulse leaves nothing finer than itself in a histogram. No knots are closer than
//! bins, and those beyond the last bin have none.

use std::iter::successors;
use std::sync::LazyLock;

use tofsim::firmware::histogram_builder::BINS;

/// Columns that are worked on together: the knots and a constant fill whole tiles of so many.
pub const LANES: usize = 8;
/// Number of the thesis's knots.
pub const KNOTS: usize = 71;

/// Up to which bin the thesis's knots have which spacing [bins].
const SPACINGS: [(f64, f64); 5] =
    [(18.0, 9.0), (50.0, 1.5), (100.0, 2.5), (184.0, 4.0), (f64::INFINITY, 12.0)];

/// Places of the thesis's knots, from the first bin to beyond the last [bins].
pub fn knots() -> [f64; KNOTS] {
    let mut knots = [0.0f64; KNOTS];
    for k in 1..KNOTS {
        knots[k] = next(knots[k - 1], &SPACINGS).unwrap_or(f64::INFINITY);
    }
    knots
}

/// The knot after another one, unless all stretches end before it.
fn next(knot: f64, spacings: &[(f64, f64)]) -> Option<f64> {
    spacings
        .iter()
        .find_map(|(until, spacing)| (knot + spacing <= *until).then_some(knot + spacing))
}

/// Expected places of echoes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Echoes {
    /// Places of the nearest one and of the farthest [bins].
    pub places: [f64; 2],
    /// Standard deviation of each [bins].
    pub sigma: f64,
}

/// Those that the thesis's knots are for: of 0.1 to 0.6 m, of 137 ps in bins of 25 ps.
const THESIS_ECHOES: Echoes = Echoes { places: [26.7, 160.1], sigma: 137.0 / 25.0 };
/// Most knots that an instrument gets without being asked; the normal equations grow with their square.
const MOST: usize = 255;
/// Knots behind the dense ones, where there is room behind the echoes.
const TAIL: usize = 6;
/// Least stretch before the dense knots [bins].
const LEAST_HEAD: f64 = 2.0;
/// Least stretch behind them [bins].
const LEAST_TAIL: f64 = 12.0;

/// Whether so many knots and a constant fill tiles.
pub fn fill_tiles(knots: usize) -> bool {
    (knots + 1).is_multiple_of(LANES)
}

/// Places of the knots for echoes in so many bins: where the echoes are, as dense as the thesis's in parts of the
/// pulse's width, or `count` in all, a number that [fills tiles](fill_tiles).
pub fn knots_for(echoes: &Echoes, bins: usize, count: Option<usize>) -> Vec<f64> {
    let stretch = Stretch::of(echoes, bins);
    let asked = (stretch.least(1.0) + 1).next_multiple_of(LANES) - 1;
    let count = count.unwrap_or(asked.min(MOST));
    let densest = if count > asked { 0.1 } else { 1.0 };
    let mut factors = successors(Some(densest), |factor| Some(factor * 1.02));
    let factor = factors.find(|factor| stretch.least(*factor) <= count).unwrap_or(densest);
    stretch.knots(factor, count)
}

/// The bins that the dense knots are for.
struct Stretch {
    from: f64,
    until: f64,
    /// End of all bins.
    end: f64,
    /// Width of the pulse, of the thesis's [1].
    scale: f64,
    /// Knots behind it at least.
    tail: usize,
}

impl Stretch {
    /// It reaches as far beyond the echoes as the thesis's, in parts of the pulse's width. Where it ends near
    /// the last bin, it goes there.
    fn of(echoes: &Echoes, bins: usize) -> Self {
        let (thesis, [first, last]) = (THESIS_ECHOES, echoes.places);
        let (begin, until) = (SPACINGS[0].0, SPACINGS[3].0);
        let scale = echoes.sigma / thesis.sigma;
        let end = bins as f64 - 0.5;
        let from = (first - (thesis.places[0] - begin) * scale).round();
        let from = from.min(end - LEAST_TAIL).max(LEAST_HEAD);
        let until = last + (until - thesis.places[1]) * scale;
        if until <= end - LEAST_TAIL {
            Stretch { from, until: until.max(from), end, scale, tail: TAIL }
        } else {
            Stretch { from, until: end, end, scale, tail: 1 }
        }
    }

    /// Those up to its end, with distances of so many times the thesis's.
    fn dense(&self, factor: f64) -> Vec<f64> {
        let (begin, end) = (SPACINGS[0].0, SPACINGS[3].0);
        let spacings: Vec<_> = SPACINGS[1..4]
            .iter()
            .map(|(until, spacing)| {
                let share = (until - begin) / (end - begin);
                let until = self.from + (self.until - self.from) * share;
                (until, (spacing * self.scale * factor).max(1.0))
            })
            .collect();
        let head = [0.0, self.from / 2.0];
        head.into_iter().chain(successors(Some(self.from), |knot| next(*knot, &spacings))).collect()
    }

    /// Returns the smallest number of knots.
    fn least(&self, factor: f64) -> usize {
        self.dense(factor).len() + self.tail
    }

    /// All, so many; those behind the dense ones are evenly apart.
    fn knots(&self, factor: f64, count: usize) -> Vec<f64> {
        let mut knots = self.dense(factor);
        let (last, left) = (knots[knots.len() - 1], count - knots.len());
        let spacing = ((self.end - last) / left as f64).max(1.0);
        knots.extend((1..=left).map(|k| last + k as f64 * spacing));
        knots
    }
}

/// Weights of a bin on the neighbouring knots: the first knot's index and both shares.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Mix {
    knot: usize,
    shares: [f64; 2],
}

/// The matrix of bins and knots; each row has two elements.
#[derive(Clone, Debug)]
pub struct Basis {
    rows: Vec<Mix>,
    knots: usize,
}

impl Basis {
    /// Of so many bins with knots in rising order; of none, of the thesis's.
    pub fn new(knots: &[f64], bins: usize) -> Self {
        match knots {
            [] => THESIS.clone(),
            knots => Basis { rows: mixes(knots, bins), knots: knots.len() },
        }
    }

    /// Returns the number of knots.
    pub fn knots(&self) -> usize {
        self.knots
    }

    /// Weights of all bins from those at the knots.
    pub fn expand(&self, weights: &[f64]) -> Vec<f64> {
        let at =
            |mix: &Mix| mix.shares[0] * weights[mix.knot] + mix.shares[1] * weights[mix.knot + 1];
        self.rows.iter().map(at).collect()
    }

    /// Counts gathered at the knots, so that weights at knots times these are weights of bins times
    /// counts.
    pub fn gather(&self, counts: &[u32]) -> Vec<f64> {
        let mut knots = vec![0.0; self.knots];
        for (mix, &count) in self.rows.iter().zip(counts) {
            knots[mix.knot] += mix.shares[0] * f64::from(count);
            knots[mix.knot + 1] += mix.shares[1] * f64::from(count);
        }
        knots
    }
}

static THESIS: LazyLock<Basis> =
    LazyLock::new(|| Basis { rows: mixes(&knots(), BINS), knots: KNOTS });

fn mixes(knots: &[f64], bins: usize) -> Vec<Mix> {
    let mix = |bin| {
        let at = bin as f64;
        let knot = knots.partition_point(|&knot| knot <= at).clamp(1, knots.len() - 1) - 1;
        let share = (at - knots[knot]) / (knots[knot + 1] - knots[knot]);
        Mix { knot, shares: [1.0 - share, share] }
    };
    (0..bins).map(mix).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knots_of(places: [f64; 2], sigma: f64, bins: usize) -> Vec<f64> {
        knots_for(&Echoes { places, sigma }, bins, None)
    }

    #[test]
    fn the_knots_are_denser_where_near_targets_are() {
        let knots = knots();
        assert_eq!(knots[..5], [0.0, 9.0, 18.0, 19.5, 21.0]);
        assert_eq!(knots[22..26], [48.0, 49.5, 52.0, 54.5]);
        assert_eq!(knots[42..46], [97.0, 99.5, 103.5, 107.5]);
        assert_eq!(knots[63..], [179.5, 183.5, 195.5, 207.5, 219.5, 231.5, 243.5, 255.5]);
        assert_eq!(knots_for(&THESIS_ECHOES, BINS, None), knots);
    }

    #[test]
    fn knots_for_any_echoes_rise_hold_all_bins_and_fill_tiles() {
        for bins in [16, 64, 128, 256, 512, 1024] {
            for range in [[0.05, 0.94], [0.0, 0.1], [0.4, 0.4], [0.0, 1.3], [0.98, 1.0], [1.2, 2.0]]
            {
                for sigma in [0.001, 0.5, 2.0, 5.48, 30.0, 500.0] {
                    let knots = knots_of(range.map(|share| share * bins as f64), sigma, bins);
                    let about = format!("{bins} {range:?} {sigma}: {knots:?}");
                    assert!(fill_tiles(knots.len()) && knots.len() <= MOST, "{about}");
                    assert!(knots.windows(2).all(|pair| pair[1] - pair[0] >= 0.999), "{about}");
                    assert!(
                        knots[0] == 0.0 && knots[knots.len() - 1] >= (bins - 1) as f64,
                        "{about}"
                    );
                }
            }
        }
    }

    #[test]
    fn as_many_as_the_echoes_width_asks_for_or_as_are_wanted() {
        let wide = knots_of([98.1, 981.0], 25.0, 1024);
        let narrow = knots_of([98.1, 981.0], 12.5, 1024);
        assert!((80..100).contains(&wide.len()) && narrow.len() > 17 * wide.len() / 10);
        let echoes = Echoes { places: [98.1, 981.0], sigma: 25.0 };
        for count in [15, 47, 127, 255] {
            assert_eq!(knots_for(&echoes, 1024, Some(count)).len(), count);
        }
        // A bin each is the most that echoes of less than a bin can ask for.
        assert_eq!(
            knots_of([2.0, 12.0], 0.1, 16)[..16],
            std::array::from_fn::<f64, 16, _>(|k| k as f64)
        );
    }

    #[test]
    fn a_straight_line_stays_one() {
        for (knots, bins) in [(vec![], BINS), (knots_of([10.0, 53.0], 2.0, 64), 64)] {
            let basis = Basis::new(&knots, bins);
            let places = if knots.is_empty() { super::knots().to_vec() } else { knots };
            let line: Vec<_> = places.iter().map(|knot| 3.0 - 0.5 * knot).collect();
            let expanded = basis.expand(&line);
            assert_eq!(expanded.len(), bins);
            for (bin, weight) in expanded.into_iter().enumerate() {
                assert!((weight - (3.0 - 0.5 * bin as f64)).abs() < 1e-12, "{bin}");
            }
        }
    }

    #[test]
    fn weights_of_knots_and_of_bins_give_the_same_sums() {
        let knots = knots_of([10.0, 240.0], 5.48, BINS);
        let weights: Vec<f64> = (0..knots.len()).map(|k| (k as f64 * 0.9).sin()).collect();
        let counts: Vec<_> = (0..256).map(|bin| (bin * bin % 997) as u32).collect();
        let basis = Basis::new(&knots, BINS);
        let bins = basis.expand(&weights).into_iter().zip(&counts).map(|(w, &c)| w * f64::from(c));
        let knots = basis.gather(&counts).iter().zip(weights).map(|(c, w)| c * w).sum::<f64>();
        assert!((bins.sum::<f64>() - knots).abs() < 1e-9);
    }
}
