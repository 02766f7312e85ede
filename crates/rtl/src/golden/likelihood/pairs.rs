//! Histograms with two echoes, drawn until a fit of both ends in each way that it can.

use tofsim::firmware::likelihood_estimator::targets::{HINT, LEAST_APART, LEAST_DROP, NEAR};
use tofsim::sim::estimates::likelihood::trace;

use crate::golden::draw::Draw;

use super::kinds::*;
use super::{Estimations, TRIES};

impl Estimations<'_> {
    /// Draws pairs until one has that fate; the last two take turns.
    pub(super) fn of_fate(&mut self, fate: u64, draw: &mut Draw) -> Vec<u32> {
        let fate = if fate == ALONE { fate + self.begun % 2 } else { fate };
        for _ in 1..TRIES {
            let pair = self.pair(fate, draw);
            if self.has_fate(&pair, fate) {
                self.pairs.see(fate);
                return pair;
            }
        }
        self.pair(fate, draw)
    }

    /// Returns whether a fit of two echoes ends so.
    fn has_fate(&self, histogram: &[u32], fate: u64) -> bool {
        let trace = trace(self.params, histogram);
        let Some(turns) = trace.turns else { return false };
        let ([alone, both], sigma) = (turns.chi_squares, self.params.sigma);
        let drop = alone - both;
        match fate {
            FOUND => trace.found.second.is_some_and(|second| second.status.is_empty()),
            REJECTED => trace.found.second.is_some_and(|second| !second.status.is_empty()),
            TOO_NEAR => drop > LEAST_DROP && turns.apart < LEAST_APART * sigma,
            MOVED => (HINT..LEAST_DROP).contains(&drop) && turns.apart < NEAR * sigma,
            ALONE => (HINT..LEAST_DROP).contains(&drop) && turns.apart > NEAR * sigma,
            UNCERTAIN => drop > LEAST_DROP && turns.apart > LEAST_APART * sigma && !turns.are_two,
            _ => true,
        }
    }

    /// Draws two echoes, near each other, far from each other, or faint.
    fn pair(&self, fate: u64, draw: &mut Draw) -> Vec<u32> {
        if fate == UNCERTAIN {
            return self.with_last(draw);
        }
        let mut part = || draw.below(1000) as f64 / 1000.0;
        let sigma = self.params.sigma as f64 / (64 * self.params.histogram.bins) as f64;
        let first = 0.2 + 0.5 * part();
        let apart = match fate {
            FOUND | REJECTED => 2.9 + 4.0 * part(),
            TOO_NEAR | MOVED => 1.0 + 1.7 * part(),
            _ => 5.0 + 10.0 * part(),
        };
        // What comes back falls with the square of the distance.
        let level = |least: f64, part: f64| first * first * least * (1.0 + 4.0 * part);
        let [one, other] = match fate {
            FOUND | TOO_NEAR => [level(0.1, part()), level(0.1, part())],
            REJECTED => [level(0.3, part()), level(0.3, part())],
            MOVED => [level(0.02, part()), level(0.005, part())],
            _ => [level(0.05, part()), level(0.002, part())],
        };
        let second = (first + apart * sigma).min(0.98);
        let mut counts = self.scene(first, one, 0.2, draw);
        let other = self.scene(second, other, 0.2, draw);
        counts.iter_mut().zip(other).for_each(|(count, other)| *count = (*count + other) / 2);
        if fate == REJECTED {
            // A bin of one of both has too many hits.
            let peak = (0..counts.len()).max_by_key(|bin| counts[*bin]).unwrap_or(0);
            let odd = (peak + 6).min(counts.len() - 1);
            counts[odd] += counts[odd] / 4 + 100;
        }
        counts
    }
    /// Draws a bright echo, and puts the shots that it leaves around a place after it.
    fn with_last(&self, draw: &mut Draw) -> Vec<u32> {
        let place = 0.1 + 0.1 * (draw.below(1000) as f64 / 1000.0);
        let mut counts = self.scene(place, 0.35 + draw.below(1000) as f64 / 2500.0, 0.02, draw);
        let ended: u64 = counts.iter().map(|&count| u64::from(count)).sum();
        let left = self.params.shots.saturating_sub(ended).min(2000);
        let last = counts.len() as u64 - 1;
        let middle = counts.len() as u64 / 2 + draw.below(last / 4);
        let sigma = self.params.sigma as u64 / 64;
        for _ in 0..left {
            let by: u64 = (0..4).map(|_| draw.below(2 * sigma + 1)).sum();
            counts[(middle + by).min(last) as usize] += 1;
        }
        counts
    }
}
