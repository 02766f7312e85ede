//! Two echoes fitted together, where a second one makes the histogram so much more probable.
//!
//! The hazards of both add up ([`super::model`]), and all five coordinates are free. Climbs begin where a box
//! stands out most of what one echo leaves, and, for two that seem to be a wide one, to either side of it.

use crate::estimation::acquisition::{Acquisition, Echo};
use crate::estimation::estimator::{EchoDepth, Estimator, Failure, Found, SecondTarget};

use tofsim::error::Input;
use tofsim::firmware::likelihood_estimator::targets::Targets;

use super::climb::{Top, climb};
use super::{Fit, Likelihood};

/// Its name on the command line.
pub const NAME: &str = "two-echoes";
/// Name of the second target's distances.
const SECOND: &str = "two-echoes-second";

/// Gain of the log likelihood that chance does not make: with two coordinates more it is exponential, so that
/// 18 come once in 6e7 at a given place [1].
const SURE_GAIN: f64 = 18.0;
/// Squared deviations that a box has to stand out by, for a climb to be worth it [1].
const LEAST_SCORE: f64 = 12.0;
/// Expected hits that a bin has at least, so that a few in the dark stand out little [hits].
const ADDED: f64 = 0.1;
/// Length of the box, and how far two that seem one are taken to be from its middle [sigma].
const BOX: f64 = 2.0;
const APART: f64 = 1.0;

/// The most likely scene with two echoes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Both {
    /// The one that comes first, with a deviation that knows of the other.
    pub first: Fit,
    /// The other.
    pub second: Fit,
    /// By how much they are more likely than one echo alone: difference of the logarithms [1].
    pub gain: f64,
}

/// Maximum likelihood of two echoes where two are sure, of one where they are not.
#[derive(Clone, Debug)]
pub struct TwoEchoes(Likelihood);

impl TwoEchoes {
    /// For histograms that come about so.
    ///
    /// # Errors
    /// As [`Likelihood::new`].
    pub fn new(acquisition: &Acquisition) -> Result<Self, Input> {
        Likelihood::new(acquisition).map(TwoEchoes)
    }
}

impl Estimator for TwoEchoes {
    fn name(&self) -> &'static str {
        NAME
    }

    fn estimate(&self, histogram: &[u32]) -> Result<f64, Failure> {
        Ok(self.find(histogram)?.depth_m)
    }

    fn find(&self, histogram: &[u32]) -> Result<Found, Failure> {
        let alone = self.0.fit(histogram)?;
        let both = self.0.fit_both(histogram, &alone);
        let fits = both.map_or(vec![alone], |both| vec![both.first, both.second]);
        let EchoDepth { depth_m, sigma_m, .. } = self.0.depth(&fits[0]);
        let second = fits.get(1).map(|second| self.0.depth(second));
        let pedestal = self.0.pedestal(histogram, &fits);
        Ok(Found { depth_m, sigma_m: Some(sigma_m), second, pedestal })
    }

    fn second(&self) -> Option<SecondTarget> {
        Some(SecondTarget { name: SECOND, targets: Targets::NearestFirst })
    }
}

impl Likelihood {
    /// Both echoes of a histogram, of which `alone` is the most likely scene with one. `None` where a second one
    /// is not sure, and in MODE 1, where it decides how often the diode is armed too.
    pub fn fit_both(&self, histogram: &[u32], alone: &Fit) -> Option<Both> {
        if self.model.free_running.is_some() {
            return None;
        }
        let echo = &alone.echo;
        match alone.amplitude {
            None => self.both_beside(histogram, echo, self.model.coordinates(echo), |at| at),
            Some([amplitude, _]) => {
                let at = self.model.coordinates_with(echo, amplitude);
                self.both_beside(
                    histogram,
                    echo,
                    at,
                    |[one, signal, other, other_signal, background]| {
                        [one, signal, other, other_signal, amplitude, background]
                    },
                )
            }
        }
    }

    /// Both echoes, of which one alone is most likely at the coordinates `alone`; `start` gives the coordinates of a climb
    /// for those of two echoes.
    fn both_beside<const ONE: usize, const TWO: usize>(
        &self,
        histogram: &[u32],
        echo: &Echo,
        alone: [f64; ONE],
        start: impl Fn([f64; 5]) -> [f64; TWO],
    ) -> Option<Both> {
        let other = self.rest(histogram, echo, &self.model.probabilities_at(&alone))?;
        let value = self.model.log_likelihood(&alone, histogram);
        let starts = [(*echo, other), self.halves(echo)];
        let tops = starts.iter().filter_map(|(one, other)| {
            let at = start(self.model.coordinates_of_two(one, other));
            climb(&self.model, histogram, at).ok()
        });
        let top = tops.max_by(|a, b| a.value.total_cmp(&b.value))?;
        let gain = top.value - value;
        (gain > SURE_GAIN).then(|| self.in_order(&top, gain))
    }

    /// Returns the largest residual echo after one echo is removed, with which the codes have those probabilities.
    fn rest(&self, histogram: &[u32], echo: &Echo, probabilities: &[f64]) -> Option<Echo> {
        let shots = self.model.shots as f64;
        let (mut left, mut sums) = (shots, vec![[0.0; 3]]);
        for (&count, chance) in histogram.iter().zip(probabilities) {
            let (hits, expected) = (f64::from(count), shots * chance);
            let [excess, all, waited] = sums[sums.len() - 1];
            sums.push([excess + hits - expected, all + expected + ADDED, waited + left]);
            left -= hits;
        }
        let length = (BOX * self.model.sigma_ps / self.bin_ps).round().max(1.0) as usize;
        let place = |from: usize| {
            let [excess, expected, waited] =
                [0, 1, 2].map(|k| sums[from + length][k] - sums[from][k]);
            let arrival_ps = self.first_ps + (from as f64 + 0.5 * length as f64) * self.bin_ps;
            let signal = excess * length as f64 / waited;
            (excess.max(0.0).powi(2) / expected, Echo { arrival_ps, signal, ..*echo })
        };
        let places = (0..sums.len().saturating_sub(length)).map(place);
        let (score, rest) = places.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (score > LEAST_SCORE).then_some(rest)
    }

    /// Two echoes that one may be.
    fn halves(&self, echo: &Echo) -> (Echo, Echo) {
        let half = |sign: f64| Echo {
            arrival_ps: echo.arrival_ps + sign * APART * self.model.sigma_ps,
            signal: 0.5 * echo.signal,
            ..*echo
        };
        (half(-1.0), half(1.0))
    }

    fn in_order<const N: usize>(&self, top: &Top<N>, gain: f64) -> Both {
        let fit = |which: usize| Fit::of(&self.model, top, which);
        let order = if top.at[0] <= top.at[2] { [0, 1] } else { [1, 0] };
        let [first, second] = order.map(fit);
        Both { first, second, gain }
    }
}
