//! The code-density test: hits that know nothing of the clock, counted by what the decoder makes of them.

use rand::RngExt;
use serde::Serialize;

use tofsim::firmware::tdc;
use tofsim::kernel::Time;
use tofsim::sensor::streams::{Source, stream};

/// A tap with less of the mean tap's width is as good as empty [LSB].
pub const NARROW: f64 = 0.25;

/// A number that the decoder makes, as wide as the span of ages that give it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// The number: the ones count, or the place of the highest one.
    pub n: usize,
    /// Hits.
    pub count: u64,
    /// Width by the delays [ps].
    pub true_width_ps: f64,
    /// Age in the middle of it, by the delays [ps].
    pub true_age_ps: f64,
}

/// The test, over all ages that a hit can have when an edge samples it: a period of the clock, from that at
/// which it reaches tap 0 on.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeDensity {
    /// From the least number that a hit can have to the largest.
    pub bins: Vec<Bin>,
    /// Hits in all.
    pub hits: u64,
    /// Period of the clock [ps].
    pub period_ps: f64,
}

/// Root of the mean square, least and largest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Root of the mean square.
    pub rms: f64,
    /// Least.
    pub least: f64,
    /// Largest.
    pub largest: f64,
}

impl Spread {
    /// Of some values.
    pub fn of(values: &[f64]) -> Self {
        let squares: f64 = values.iter().map(|value| value * value).sum();
        Spread {
            rms: (squares / values.len().max(1) as f64).sqrt(),
            least: values.iter().copied().fold(f64::INFINITY, f64::min),
            largest: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

impl CodeDensity {
    /// Of so many hits on a converter's chain, by its decoder.
    pub fn new(p: &tdc::Params, hits: u64, seed: u64) -> Self {
        let (delays, encoder, period) = (&p.delays, &p.decoder.encoder, p.decoder.scale.period());
        let number = |fs: u64| encoder.of_rank(delays.rank(Time::from_fs(fs)));
        // The least age with that number or more.
        let least = |n: usize| delays.boundary(encoder.least_rank(n) - 1).fs();
        let (begin, end) = (delays.tap_0().fs(), delays.tap_0().fs() + period.fs());
        let mut counts = vec![0u64; delays.taps() + 1];
        let mut random = stream(seed, Source::CodeDensity, 0);
        for _ in 0..hits {
            counts[number(random.random_range(begin..end))] += 1;
        }
        let (first, last) = (number(begin), number(end - 1));
        let bin = |n: usize| {
            let from = least(n).clamp(begin, end);
            let until = if n == last { end } else { least(n + 1).clamp(begin, end) };
            let true_width_ps = (until - from) as f64 * 1e-3;
            let true_age_ps = (until + from) as f64 * 0.5e-3;
            Bin { n, count: counts[n], true_width_ps, true_age_ps }
        };
        let bins = (first.max(1)..=last).map(bin).collect();
        CodeDensity { bins, hits, period_ps: period.fs() as f64 * 1e-3 }
    }

    /// Mean width of the taps that hits come to [ps].
    pub fn lsb_ps(&self) -> f64 {
        self.period_ps / self.bins.len() as f64
    }

    /// Width of a bin by its hits, and the standard error of that [ps].
    pub fn width_ps(&self, bin: &Bin) -> (f64, f64) {
        let hits = self.hits.max(1) as f64;
        let part = bin.count as f64 / hits;
        (self.period_ps * part, self.period_ps * (part * (1.0 - part) / hits).sqrt())
    }

    /// Widths by hits [ps].
    pub fn measured_ps(&self) -> Vec<f64> {
        self.bins.iter().map(|bin| self.width_ps(bin).0).collect()
    }

    /// Widths by the delays [ps].
    pub fn true_ps(&self) -> Vec<f64> {
        self.bins.iter().map(|bin| bin.true_width_ps).collect()
    }

    /// Returns the differential nonlinearity: each width minus the mean width [LSB].
    pub fn dnl(&self, widths_ps: &[f64]) -> Vec<f64> {
        widths_ps.iter().map(|ps| ps / self.lsb_ps() - 1.0).collect()
    }

    /// The sum of the first up to each: how far the end of a bin is from where it were if all were alike [LSB].
    pub fn inl(&self, dnl: &[f64]) -> Vec<f64> {
        let sums = dnl.iter().scan(0.0, |sum, dnl| {
            *sum += dnl;
            Some(*sum)
        });
        sums.collect()
    }

    /// Bins without a hit.
    pub fn empty(&self) -> usize {
        self.bins.iter().filter(|bin| bin.count == 0).count()
    }

    /// Bins that are empty or [as good as that](NARROW), by the delays.
    pub fn narrow(&self) -> usize {
        let limit_ps = NARROW * self.lsb_ps();
        self.bins.iter().filter(|bin| bin.true_width_ps < limit_ps).count()
    }

    /// Width of equal bins that would be as coarse: the root of the sum of cubes over the sum [ps].
    pub fn equivalent_ps(widths_ps: &[f64]) -> f64 {
        let cubes: f64 = widths_ps.iter().map(|ps| ps * ps * ps).sum();
        let sum: f64 = widths_ps.iter().sum();
        if sum > 0.0 { (cubes / sum).sqrt() } else { 0.0 }
    }
}
