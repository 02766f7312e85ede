//! The matched filter: the place where the pulse explains most of the histogram.
//!
//! Coates's correction takes the pile-up out ([`super::coates`]), so that the hazard of a bin is
//! N times its width plus S times the part of the pulse in it. For each arrival on a grid, a bin or a quarter of the pulse's deviation apart, S
//! and N are fitted by least squares; a bin weighs as many shots as are still waiting after it, so
//! that what is past a strong echo counts for little. The best place is where S times the square
//! root of its weight is largest, and a parabola through three points of that finds it between the
//! grid's. A template of a cover window's light is fitted along with both ([`pedestal`]).

mod pedestal;
mod pulse;

use std::f64::consts::PI;
use std::ops::Range;

use tofsim::error::Input;

use super::acquisition::{ARRIVAL_PS_PER_M, Acquisition, Echo, spans_ps};
use super::coates::{Corrected, correct};
use super::estimator::{Estimator, Failure, hits};

use pedestal::{Glass, Projected};
use pulse::{Pieces, Pulse, pieces, seen};

/// Distance of two places that are tried one after the other [sigma].
const APART: f64 = 3.0;
/// Most places.
const MOST_PLACES: usize = 3;
/// Steps of the grid of arrivals in the pulse's standard deviation, where bins are wider [1].
const STEPS_IN_SIGMA: f64 = 4.0;
/// Finest step of the grid if bins are wider [ps].
const FINEST_STEP_PS: f64 = 25.0;
/// A pulse of which less than this part is weighed, by its square, is not tried [1].
const FAINTEST: f64 = 1e-9;
/// Signal that counts as one, in its own standard deviations [1].
const SIGNIFICANCE: f64 = 4.0;

/// The matched filter of one pulse and one chain.
#[derive(Clone, Debug)]
pub struct MatchedFilter {
    /// Shots of the histogram [shots].
    shots: u64,
    /// Codes in order of time.
    codes: Vec<u16>,
    /// Width of each of their bins, as a part of all [1].
    widths: Vec<f64>,
    /// All bins together [ps].
    range_ps: f64,
    /// Standard deviation of jitter, and the bins that are 3 to 6 of it long after the laser edge.
    jitter: (f64, Range<usize>),
    /// Delay of the light after the laser edge [ps].
    delay_ps: f64,
    /// A step of the grid of arrivals [ps].
    step_ps: f64,
    /// For each arrival on the grid, from 0 on.
    pulses: Vec<Pulse>,
    /// Standard deviation of the pulse [ps].
    sigma_ps: f64,
    /// Template of a cover window's light.
    glass: Option<Glass>,
}

/// Result of the filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// The echo; its background is below zero by chance.
    pub echo: Echo,
    /// Signal in its own standard deviations [1].
    pub significance: f64,
    /// Amplitude of the cover window's light; 0 without a template [1].
    pub amplitude: f64,
}

impl MatchedFilter {
    /// For histograms that come about so; an echo counts from 4 standard deviations on.
    ///
    /// # Errors
    /// When [`Acquisition::check`] fails.
    pub fn new(acquisition: &Acquisition) -> Result<Self, Input> {
        acquisition.check()?;
        let pieces = pieces(acquisition.bins);
        let range_ps: f64 = pieces.iter().map(Pieces::width_ps).sum();
        let end_ps = spans_ps(acquisition.bins).map(|(.., until)| until).fold(0.0, f64::max);
        let shape = seen(acquisition);
        let sigma_ps = shape.sigma_ps();
        let bin_at = |deviations: f64| {
            let t_ps = deviations * acquisition.jitter_ps;
            pieces.partition_point(|bin| bin.spans[0][0] < t_ps)
        };
        let jitter = (acquisition.jitter_ps, bin_at(3.0)..bin_at(6.0));
        let step_ps = acquisition.bins.bin_ps().min(FINEST_STEP_PS.max(sigma_ps / STEPS_IN_SIGMA));
        let pulse = |place| Pulse::new(&pieces, place as f64 * step_ps, &shape);
        Ok(MatchedFilter {
            shots: acquisition.shots,
            codes: pieces.iter().map(|bin| bin.code).collect(),
            widths: pieces.iter().map(|bin| bin.width_ps() / range_ps).collect(),
            range_ps,
            jitter,
            delay_ps: acquisition.delay_ps,
            step_ps,
            pulses: (0..=(end_ps / step_ps) as usize).map(pulse).collect(),
            sigma_ps,
            glass: acquisition
                .glass
                .map(|glass| Glass::new(glass, pieces.iter().map(|bin| bin.code))),
        })
    }

    /// Returns the most likely places of an echo, the best first, at least three standard deviations of the pulse apart.
    pub fn places(&self, histogram: &[u32]) -> Vec<Match> {
        let (bins, beside) = self.corrected(histogram);
        let fits = self.fits(&bins, &beside);
        let mut order: Vec<_> = (0..fits.len()).collect();
        order.sort_by(|&a, &b| fits[b].score.total_cmp(&fits[a].score));
        let steps = (APART * self.sigma_ps / self.step_ps).ceil() as usize;
        let mut found: Vec<usize> = Vec::new();
        for place in order {
            let is_apart = found.iter().all(|other| other.abs_diff(place) >= steps);
            if found.len() < MOST_PLACES && is_apart {
                found.push(place);
            }
        }
        found.iter().filter_map(|&place| self.refined(&fits, place, &bins, &beside)).collect()
    }

    /// The most likely echo, however faint; `None` where no signal above zero fits.
    pub fn best(&self, histogram: &[u32]) -> Option<Match> {
        let (bins, beside) = self.corrected(histogram);
        let fits = self.fits(&bins, &beside);
        let score = |place: usize| fits[place].score;
        let best = (0..fits.len()).max_by(|&a, &b| score(a).total_cmp(&score(b)))?;
        self.refined(&fits, best, &bins, &beside)
    }

    /// The bins without pile-up, weighed, and what there is beside an echo.
    fn corrected(&self, histogram: &[u32]) -> (Vec<Corrected>, Beside) {
        let counts = self.codes.iter().map(|&code| histogram[code as usize]);
        let mut bins = correct(counts, self.shots - self.lost(histogram));
        self.glass.iter().for_each(|glass| glass.weigh(&mut bins));
        let flat = self.flat(&bins);
        let glass = self.glass.as_ref().map(|glass| glass.projected(&bins, &self.widths, flat));
        (bins, Beside { flat, glass })
    }

    fn fits(&self, bins: &[Corrected], beside: &Beside) -> Vec<Fit> {
        self.pulses.iter().map(|pulse| Fit::new(pulse, self, bins, beside)).collect()
    }

    /// The echo at a place of the grid and between its neighbours.
    fn refined(
        &self,
        fits: &[Fit],
        best: usize,
        bins: &[Corrected],
        beside: &Beside,
    ) -> Option<Match> {
        let score = |place: usize| fits[place].score;
        let fit = &fits[best];
        if fit.score <= 0.0 {
            return None;
        }
        let mut place = best as f64;
        if 0 < best && best + 1 < fits.len() {
            let [before, at, after] = [best - 1, best, best + 1].map(score);
            let bend = before - 2.0 * at + after;
            if bend < 0.0 && before > 0.0 && after > 0.0 {
                place += 0.5 * (before - after) / bend;
            }
        }
        let echo = Echo {
            arrival_ps: place * self.step_ps,
            signal: fit.signal,
            background_per_ps: fit.background / self.range_ps,
        };
        let deviation = self.signal_deviation(&self.pulses[best], bins, fit, beside);
        Some(Match {
            echo,
            significance: fit.signal / deviation,
            amplitude: fit.amplitude.max(0.0),
        })
    }

    /// Shots whose hit jitter puts before the laser edge, where it has no code: so many as hits come
    /// in 0.4 deviations, J / sqrt(2 pi). Taken for waiting ones they would hide all that comes late.
    fn lost(&self, histogram: &[u32]) -> u64 {
        let (jitter_ps, early) = &self.jitter;
        let hits =
            self.codes[early.clone()].iter().map(|&code| u64::from(histogram[code as usize]));
        let width_ps = self.widths[early.clone()].iter().sum::<f64>() * self.range_ps;
        if width_ps == 0.0 {
            return 0;
        }
        let lost = hits.sum::<u64>() as f64 / width_ps * jitter_ps / (2.0 * PI).sqrt();
        let all: u64 = histogram.iter().map(|&count| u64::from(count)).sum();
        (lost.round() as u64).min(self.shots.saturating_sub(all))
    }

    /// Weighted squares of the widths, and widths times hazards.
    fn flat(&self, bins: &[Corrected]) -> [f64; 2] {
        let terms = self.widths.iter().zip(bins);
        terms.fold([0.0; 2], |[squares, product], (width, bin)| {
            let weighted = bin.waiting * width;
            [squares + weighted * width, product + weighted * bin.hazard]
        })
    }

    /// Standard deviation of the fitted signal.
    fn signal_deviation(
        &self,
        pulse: &Pulse,
        bins: &[Corrected],
        fit: &Fit,
        beside: &Beside,
    ) -> f64 {
        let terms = self.widths.iter().zip(bins).enumerate().map(|(k, (width, bin))| {
            let part =
                k.checked_sub(pulse.first).and_then(|k| pulse.parts.get(k)).copied().unwrap_or(0.0);
            let mut alone = part - width * fit.flat_part;
            if let Some(glass) = &beside.glass {
                alone -= glass.shape[k] * fit.glass_part;
            }
            let lever = bin.waiting * alone;
            lever * lever * bin.variance
        });
        terms.sum::<f64>().sqrt() / fit.weight
    }
}

/// What there is beside an echo.
struct Beside {
    /// Weighted squares of the widths, and widths times hazards.
    flat: [f64; 2],
    /// A cover window's light, if there is a template of it.
    glass: Option<Projected>,
}

/// Signal and background at one arrival, by least squares.
struct Fit {
    /// Weighted square of the pulse without its flat part.
    weight: f64,
    /// Fraction of the flat shape in the pulse.
    flat_part: f64,
    /// Fraction of the window's light in the pulse.
    glass_part: f64,
    /// Signal times the square root of the weight; what it explains, but for a constant.
    score: f64,
    signal: f64,
    /// Mean number of other avalanches in all bins.
    background: f64,
    /// Amplitude of the window's light [1].
    amplitude: f64,
}

impl Fit {
    fn new(pulse: &Pulse, filter: &MatchedFilter, bins: &[Corrected], beside: &Beside) -> Self {
        let [flat_squares, flat_product] = beside.flat;
        let (mut squares, mut with_flat, mut product) = (0.0, 0.0, 0.0);
        let there = bins[pulse.first..].iter().zip(&filter.widths[pulse.first..]);
        for (part, (bin, width)) in pulse.parts.iter().zip(there) {
            let weighted = bin.waiting * part;
            squares += weighted * part;
            with_flat += weighted * width;
            product += weighted * bin.hazard;
        }
        let flat_part = if flat_squares > 0.0 { with_flat / flat_squares } else { 0.0 };
        let mut weight = squares - flat_part * with_flat;
        let mut alone = product - flat_part * flat_product;
        let mut glass_part = 0.0;
        if let Some(glass) = &beside.glass {
            let with_glass = glass.within(pulse.first, &pulse.parts, bins);
            glass_part = with_glass / glass.squares;
            weight -= glass_part * with_glass;
            alone -= glass_part * glass.product;
        }
        let tried = weight > FAINTEST * filter.shots as f64;
        let signal = if tried { alone / weight } else { 0.0 };
        let mut background =
            if flat_squares > 0.0 { flat_product / flat_squares - signal * flat_part } else { 0.0 };
        let mut amplitude = 0.0;
        if let Some(glass) = &beside.glass {
            amplitude = glass.product / glass.squares - signal * glass_part;
            background -= amplitude * glass.flat_part;
        }
        let score = signal * weight.max(0.0).sqrt();
        Fit { weight, flat_part, glass_part, score, signal, background, amplitude }
    }
}

impl Estimator for MatchedFilter {
    fn name(&self) -> &'static str {
        "matched"
    }

    fn estimate(&self, histogram: &[u32]) -> Result<f64, Failure> {
        hits(histogram, self.shots as u32)?;
        match self.best(histogram) {
            Some(found) if found.significance >= SIGNIFICANCE => {
                Ok((found.echo.arrival_ps - self.delay_ps) / ARRIVAL_PS_PER_M)
            }
            _ => Err(Failure::NoPeak),
        }
    }
}

#[cfg(test)]
mod tests;
