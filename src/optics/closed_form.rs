//! The histogram of a frame in one step, for SPAD mode 0, where the first avalanche decides.
//!
//! The probability of a bin is the sum of `exp(-H(a)) - exp(-H(b))` over the time spans that give its code, which
//! depend on the carry chain. The remaining probability has no code.

use rand::Rng;
use rand_distr::{Binomial, Distribution};

use crate::firmware::tdc;
use crate::firmware::tdc_decoder::TimeScale;
use crate::kernel::Time;

use super::hazard::Hazard;

/// A span of avalanche times with the same code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// Start, from the laser edge.
    pub from: Time,
    /// End, excluded.
    pub until: Time,
    /// TDC code [bins].
    pub code: u16,
}

/// Mapping from avalanche times to codes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bins {
    /// Spans in order of time, not overlapping.
    spans: Vec<Span>,
    /// Nominal time scale of the codes.
    scale: TimeScale,
}

impl Bins {
    /// Computes the mapping of a converter.
    ///
    /// The chain must be clear before the first edge of the next shot, two periods after `spad_rst` rises, or a hit
    /// would be counted together with the previous one.
    pub fn of_tdc(p: &tdc::Params) -> Self {
        let (delays, period) = (&p.delays, p.decoder.scale.period());
        let mut spans = Vec::new();
        let (tap_0, ages) = (delays.tap_0(), delays.arrivals());
        for coarse in 0..p.coarse_counter.window() {
            let edge = Time::from_fs((coarse + 1) * period.fs());
            if (1..=ages.len()).all(|n| p.decoder.is_late(coarse, n)) {
                break;
            }
            // The first edge at or after the arrival at tap 0 sees the avalanche.
            let first = first_younger(tap_0 + period, edge);
            let end = first_younger(tap_0, edge);
            for n in (1..=ages.len()).rev() {
                let Some(code) = p.decoder.code_of_rank(coarse, n) else { continue };
                let from = ages.get(n).map_or(first, |&age| first_younger(age, edge).max(first));
                let until = first_younger(ages[n - 1], edge).min(end);
                push(&mut spans, Span { from, until, code: code.get() as u16 });
            }
        }
        Bins { spans, scale: p.decoder.scale }
    }

    /// Computes the mapping of an ideal converter with unlimited resolution: each bin has its nominal limits, as far
    /// as the window reaches.
    pub fn without_taps(p: &tdc::Params) -> Self {
        let scale = p.decoder.scale;
        let end = Time::from_fs(p.coarse_counter.window() * scale.period().fs());
        let mut spans = Vec::with_capacity(scale.bins());
        for code in 0..scale.bins() as u64 {
            let at = |bin: u64| (scale.first() + Time::from_fs(bin * scale.bin().fs())).min(end);
            push(&mut spans, Span { from: at(code), until: at(code + 1), code: code as u16 });
        }
        Bins { spans, scale }
    }

    /// Bins of equal width, of a sensor whose converter is not modelled.
    pub fn even(first: Time, bin: Time, count: usize) -> Self {
        let scale = TimeScale::new(TimeScale::default().period(), bin, first, 0, count);
        let at = |code: usize| first + Time::from_fs(code as u64 * bin.fs());
        let span = |code| Span { from: at(code), until: at(code + 1), code: code as u16 };
        Bins { spans: (0..count).map(span).collect(), scale }
    }

    /// Returns the spans of all codes, in order of time.
    pub fn spans(&self) -> &[Span] {
        &self.spans
    }

    /// Returns the number of bins.
    pub fn count(&self) -> usize {
        self.scale.bins()
    }

    /// Returns the start of each bin, followed by the end of the last one, provided that codes increase with time. A
    /// code that never occurs is a bin of zero width [ps].
    pub fn edges_ps(&self) -> Vec<f64> {
        let mut edges = vec![0.0; self.count() + 1];
        for span in &self.spans {
            let end = &mut edges[span.code as usize + 1];
            *end = f64::max(*end, span.until.fs() as f64 * 1e-3);
        }
        for bin in 1..edges.len() {
            edges[bin] = edges[bin].max(edges[bin - 1]);
        }
        edges
    }

    /// Returns begin and end of each bin, both 0 for a code that never occurs [ps].
    pub fn limits_ps(&self) -> Vec<[f64; 2]> {
        let mut limits = vec![[0.0; 2]; self.count()];
        for span in &self.spans {
            let [from_ps, until_ps] = [span.from, span.until].map(|time| time.fs() as f64 * 1e-3);
            let bin = &mut limits[span.code as usize];
            *bin = if bin[1] == 0.0 {
                [from_ps, until_ps]
            } else {
                [bin[0].min(from_ps), bin[1].max(until_ps)]
            };
        }
        limits
    }

    /// Returns the nominal bin width [ps].
    pub fn bin_ps(&self) -> f64 {
        self.scale.bin().fs() as f64 * 1e-3
    }

    /// Returns the nominal start of bin 0 [ps].
    pub fn first_ps(&self) -> f64 {
        self.scale.first().fs() as f64 * 1e-3
    }

    /// Converts a time from the laser edge [ps] to a nominal position on the scale of bins [bins].
    pub fn place(&self, ps: f64) -> f64 {
        (ps - self.first_ps()) / self.bin_ps()
    }

    /// Returns whether the scale equals the KC705's.
    pub fn are_kc705(&self) -> bool {
        let kc705 = |scale: &TimeScale| (scale.bin(), scale.first(), scale.bins());
        kc705(&self.scale) == kc705(&TimeScale::default())
    }

    /// Returns the code of an avalanche at `t` from the laser edge.
    pub fn code_at(&self, t: Time) -> Option<u16> {
        let next = self.spans.partition_point(|span| span.from <= t);
        let span = self.spans[..next].last()?;
        (t < span.until).then_some(span.code)
    }
}

/// Returns the earliest avalanche time with an age below `age` at `edge`.
fn first_younger(age: Time, edge: Time) -> Time {
    (edge + Time::from_fs(1)).since(age)
}

/// Appends a span unless it is empty, and merges it with the previous one if they are contiguous.
fn push(spans: &mut Vec<Span>, span: Span) {
    if span.from >= span.until {
        return;
    }
    match spans.last_mut() {
        Some(last) if last.until == span.from && last.code == span.code => last.until = span.until,
        _ => spans.push(span),
    }
}

/// Probability of each code in one shot.
#[derive(Clone, Debug, PartialEq)]
pub struct BinProbabilities(Vec<f64>);

impl BinProbabilities {
    /// Computes the probabilities for shots that are armed at the laser edge, averaged over the variation from shot
    /// to shot.
    pub fn new(hazard: &Hazard, bins: &Bins) -> Self {
        if hazard.variation().is_none() {
            return BinProbabilities(first_avalanches(|t| hazard.at(t), bins));
        }
        let mut of_code = vec![0.0; bins.count()];
        hazard.each(|weight, shot| {
            let own = first_avalanches(|t| shot.at(t), bins);
            of_code.iter_mut().zip(own).for_each(|(sum, own)| *sum += weight * own);
        });
        BinProbabilities(of_code)
    }

    /// Computes the probabilities for identical shots that are armed at the laser edge, with avalanches from several
    /// hazards: that of one surface including the ambient light, and those of others without it.
    pub fn of_all(hazards: &[Hazard], bins: &Bins) -> Self {
        let together = |t| hazards.iter().map(|hazard| hazard.at(t)).sum();
        BinProbabilities(first_avalanches(together, bins))
    }

    /// Returns the probabilities, by code.
    pub fn of_code(&self) -> &[f64] {
        &self.0
    }

    /// Returns the codes that occur, each with its probability in a shot that has none of the codes before, and
    /// the probability of such a shot.
    pub fn shares(&self) -> impl Iterator<Item = (usize, f64, f64)> {
        let occur = self.0.iter().enumerate().filter(|(_, probability)| **probability != 0.0);
        occur.scan(1.0, |left, (code, &probability)| {
            let before = *left;
            *left -= probability;
            let share = if probability < before { probability / before } else { 1.0 };
            Some((code, share, before))
        })
    }

    /// Draws a histogram of `shots` shots: a multinomial draw, as one binomial draw per code from the remaining
    /// shots.
    pub fn draw(&self, shots: u64, rng: &mut impl Rng) -> Vec<u64> {
        let (mut histogram, mut shots_left) = (vec![0; self.0.len()], shots);
        for (code, share, _) in self.shares() {
            if shots_left == 0 {
                break;
            }
            let count = Binomial::new(shots_left, share).map_or(0, |binomial| binomial.sample(rng));
            histogram[code] = count;
            shots_left -= count;
        }
        histogram
    }
}

/// Computes the probability that a shot's first avalanche has each code, given the cumulative hazard.
fn first_avalanches(at_time: impl Fn(Time) -> f64, bins: &Bins) -> Vec<f64> {
    let mut of_code = vec![0.0; bins.count()];
    // Hazard, and probability of no avalanche, up to where we are.
    let (mut at, mut none_yet) = (0.0, 1.0);
    let mut advance = |t: Time| {
        let to = at_time(t);
        let probability = -none_yet * libm::expm1(at - to);
        none_yet -= probability;
        at = to;
        probability
    };
    for span in &bins.spans {
        advance(span.from);
        of_code[span.code as usize] += advance(span.until);
    }
    of_code
}

#[cfg(test)]
pub(super) mod tests;
