//! Jitter of the PLL's outputs: each rising edge of `clk_laser` is early or late by a normal time.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;

use crate::kernel::Time;
use crate::sensor::streams::{Source, normal, seek, stream};

/// The source of jitter, with the last edge asked for.
#[derive(Clone, Debug)]
pub struct Jitter {
    rms_fs: f64,
    stream: ChaCha8Rng,
    /// The next edge in the stream.
    position: u64,
    last: (u64, i64),
}

impl Jitter {
    /// Jitter of `rms_ps` for each edge.
    pub fn new(rms_ps: f64, seed: u64) -> Self {
        let stream = stream(seed, Source::Jitter, 0);
        Jitter { rms_fs: rms_ps * 1e3, stream, position: 0, last: (u64::MAX, 0) }
    }

    /// Returns the instant of edge `n` of `clk_laser`, which would be at `ideal`.
    pub fn shift(&mut self, ideal: Time, n: u64) -> Time {
        if self.last.0 != n {
            if self.position != n {
                seek(&mut self.stream, 0, n);
            }
            let late = normal(self.stream.next_u64());
            self.last = (n, (late * self.rms_fs).round() as i64);
            self.position = n + 1;
        }
        Time::from_fs(ideal.fs().saturating_add_signed(self.last.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_scatter_with_the_given_deviation_and_can_be_asked_for_in_any_order() {
        let mut jitter = Jitter::new(7.7, 1);
        let ideal = Time::from_ns(1000);
        let late = |time: Time| time.fs() as f64 - ideal.fs() as f64;
        let edges: Vec<_> = (0..20_000).map(|n| late(jitter.shift(ideal, n))).collect();
        let mean = edges.iter().sum::<f64>() / edges.len() as f64;
        let variance = edges.iter().map(|e| e * e).sum::<f64>() / edges.len() as f64;
        assert!(mean.abs() < 5.0 * 7_700.0 / 141.0, "{mean} fs");
        assert!((variance.sqrt() / 7_700.0 - 1.0).abs() < 0.03, "{} fs", variance.sqrt());
        assert_eq!(late(jitter.shift(ideal, 17)), edges[17]);
        assert_eq!(late(jitter.shift(ideal, 17)), edges[17]);
    }
}
