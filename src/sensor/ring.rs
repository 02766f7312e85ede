//! Ring oscillator that calibrates the TDC with edges uncorrelated with the clock.
//!
//! It runs only on request, and starts at a random phase. Each half period has a normally distributed deviation, and
//! deviations accumulate.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;

use crate::kernel::Time;

use super::streams::{Source, normal, stream, uniform};

/// Period and jitter of the ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// Half period.
    pub half: Time,
    /// Standard deviation of a half period [fs].
    pub jitter_fs: f64,
}

/// Range of accumulated jitter that counts as covered, to either side [standard deviations].
const COVERED: f64 = 2.0;

impl Params {
    /// Returns the widest interval of the clock period that none of the ring's first `rises` rising edges hits,
    /// because its period is nearly a rational multiple of the clock's. Returns `None` if it is not wider than
    /// `finest`.
    pub fn in_step(&self, period: Time, rises: u64, finest: Time) -> Option<Time> {
        let [own, period] = [2 * self.half.fs(), period.fs()];
        let walk = COVERED * self.jitter_fs * (2.0 * rises as f64).sqrt();
        // After `turns` the ring is nearly where it was, off by `creep`; the places between are covered by creeping on.
        let empty = |turns: u64| {
            let past = (u128::from(own) * u128::from(turns) % u128::from(period)) as u64;
            let creep = past.min(period - past) as f64;
            let covered = creep * (rises / turns) as f64 + walk;
            Time::from_fs((period as f64 / turns as f64 - covered).max(0.0) as u64)
        };
        let most = (period / finest.fs().max(1)).min(rises);
        (1..=most).map(empty).max().filter(|empty| *empty > finest)
    }
}

/// The oscillator.
#[derive(Clone, Debug)]
pub struct Ring {
    params: Option<Params>,
    seed: u64,
    /// Number of starts.
    runs: u64,
    words: ChaCha8Rng,
    level: bool,
    next: Time,
}

impl Ring {
    /// Creates a stopped ring. Without parameters it never runs.
    pub fn new(params: Option<Params>, seed: u64) -> Self {
        let words = stream(seed, Source::Ring, 0);
        Ring { params, seed, runs: 0, words, level: false, next: Time::NEVER }
    }

    /// Returns whether the ring runs.
    #[inline(always)]
    pub fn is_on(&self) -> bool {
        self.next != Time::NEVER
    }

    /// Returns the ring's output, which is low while it is stopped.
    pub fn level(&self) -> bool {
        self.level
    }

    /// Returns the time of the next edge.
    #[inline(always)]
    pub fn next_event(&self) -> Time {
        self.next
    }

    /// Starts or stops the ring.
    pub fn switch(&mut self, on: bool, now: Time) {
        self.level = false;
        let Some(params) = self.params.filter(|_| on) else {
            self.next = Time::NEVER;
            return;
        };
        self.words = stream(self.seed, Source::Ring, self.runs);
        self.runs += 1;
        let wait = uniform(self.words.next_u64()) * params.half.fs() as f64;
        self.next = now + Time::from_fs(wait.round() as u64 + 1);
    }

    /// Toggles the output.
    pub fn event(&mut self) {
        let Some(params) = self.params else { return };
        self.level = !self.level;
        let late = (normal(self.words.next_u64()) * params.jitter_fs).round() as i64;
        // However large the jitter, time goes on.
        let half = params.half.fs().saturating_add_signed(late).max(1);
        self.next += Time::from_fs(half);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edges(ring: &mut Ring, count: usize) -> Vec<u64> {
        (0..count)
            .map(|_| {
                let now = ring.next_event().fs();
                ring.event();
                now
            })
            .collect()
    }

    #[test]
    fn halves_scatter_with_the_given_deviation_about_the_given_length() {
        let params = Params { half: Time::from_fs(30_900_000), jitter_fs: 5_000.0 };
        let mut ring = Ring::new(Some(params), 1);
        assert!(!ring.is_on());
        ring.switch(true, Time::from_ns(100));
        let edges = edges(&mut ring, 20_001);
        let halves: Vec<_> = edges.windows(2).map(|pair| (pair[1] - pair[0]) as f64).collect();
        let mean = halves.iter().sum::<f64>() / halves.len() as f64;
        let variance =
            halves.iter().map(|half| (half - mean).powi(2)).sum::<f64>() / halves.len() as f64;
        assert!((mean - 30_900_000.0).abs() < 5.0 * 5_000.0 / 141.0, "{mean} fs");
        assert!((variance.sqrt() / 5_000.0 - 1.0).abs() < 0.03, "{} fs", variance.sqrt());
    }

    #[test]
    fn a_ring_in_step_with_the_clock_leaves_stretches_empty() {
        let [period, finest] = [8_000_000, 11_500].map(Time::from_fs);
        // The stretch, and what the rises really leave.
        let of = |ring_fs: u64, jitter_fs: f64| {
            let (half, rises) = (Time::from_fs(ring_fs / 2), 1 << 14);
            let params = Params { half, jitter_fs };
            let mut ring = Ring::new(Some(params), 1);
            ring.switch(true, Time::ZERO);
            let edges = edges(&mut ring, 2 * rises);
            let mut places: Vec<_> = edges.iter().step_by(2).map(|at| at % 8_000_000).collect();
            places.sort_unstable();
            places.push(places[0] + 8_000_000);
            let widest = places.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap();
            (params.in_step(period, rises as u64, finest).map(Time::fs), widest)
        };
        for (ring_fs, empty_fs) in [
            (64_000_000, 8_000_000),
            (60_000_000, 4_000_000),
            (61_800_000, 200_000),
            (64_000_100, 6_361_600),
            (63_999_900, 6_361_600),
        ] {
            let (found, widest) = of(ring_fs, 0.0);
            assert_eq!(found, Some(empty_fs), "{ring_fs}");
            assert!(widest.abs_diff(empty_fs) < 1_000, "{ring_fs}: {widest}");
        }
        let (found, widest) = of(64_000_000, 2_000.0);
        let found = found.unwrap();
        assert!(found.abs_diff(widest) < 1_000_000, "{found} {widest}");
        for (ring_fs, jitter_fs) in
            [(61_803_000, 0.0), (61_800_000, 5_000.0), (64_000_000, 40_000.0)]
        {
            let (found, widest) = of(ring_fs, jitter_fs);
            assert_eq!(found, None, "{ring_fs}: {widest}");
        }
        assert!(of(61_803_000, 0.0).1 < 11_500);
    }

    #[test]
    fn each_run_begins_at_another_place_and_low() {
        let mut ring = Ring::new(Some(Params { half: Time::from_ns(31), jitter_fs: 0.0 }), 1);
        let mut first = |at: u64| {
            ring.switch(true, Time::from_ns(at));
            let wait = ring.next_event() - Time::from_ns(at);
            ring.event();
            assert!(ring.level());
            ring.switch(false, Time::from_ns(at + 100));
            assert!(!ring.level() && !ring.is_on());
            wait
        };
        let waits = [first(0), first(1_000), first(2_000)];
        assert!(waits[0] != waits[1] && waits[1] != waits[2], "{waits:?}");
        assert!(waits.iter().all(|wait| *wait <= Time::from_fs(31_000_001)), "{waits:?}");
    }
}
