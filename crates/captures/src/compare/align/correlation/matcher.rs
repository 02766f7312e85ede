//! Search of one sequence in another by Fourier transforms.

use rustfft::algorithm::Radix4;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftDirection};

/// Number of candidates that are kept.
pub(crate) const KEPT: usize = 8;

/// An offset with its number of differences.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    /// Sample of the longer side that corresponds to the first of the shorter side.
    pub(crate) offset: i64,
    /// Number of bits that differ.
    pub(crate) differing: u64,
    /// Number of bits compared.
    pub(crate) compared: u64,
}

impl Candidate {
    /// Returns the delay of the second side, given that `side` is the shorter one [samples].
    pub(crate) fn later(&self, side: usize) -> i64 {
        if side == 0 { self.offset } else { -self.offset }
    }

    /// Returns the proportion of bits that differ.
    pub(crate) fn rate(&self) -> f64 {
        self.differing as f64 / self.compared.max(1) as f64
    }
}

/// Bits of some pairs at consecutive samples: 1, -1, or 0 if unknown.
pub(crate) type Rows = Vec<Vec<i8>>;

/// Searches chunks of one sequence for another.
pub(super) struct Matcher {
    template: Rows,
    /// Bits per sample.
    width: usize,
    /// Length of a chunk [samples].
    pub(super) size: usize,
    forward: Radix4<f64>,
    inverse: Radix4<f64>,
}

impl Matcher {
    pub(super) fn new(template: Rows, width: usize) -> Self {
        let size = (4 * template.len()).next_power_of_two();
        let [forward, inverse] =
            [FftDirection::Forward, FftDirection::Inverse].map(|way| Radix4::new(size, way));
        Matcher { template, width, size, forward, inverse }
    }

    /// Ranks the offsets at which the sequence lies within the chunk that begins at sample `base`.
    pub(super) fn scan(&mut self, chunk: &Rows, base: i64, best: &mut Vec<Candidate>) {
        let zero = Complex::new(0.0, 0.0);
        let mut product = vec![zero; self.size];
        let mut both = vec![zero; self.size];
        for bit in 0..self.width {
            both.fill(zero);
            both.iter_mut().zip(&self.template).for_each(|(z, row)| z.re = f64::from(row[bit]));
            both.iter_mut().zip(chunk).for_each(|(z, row)| z.im = f64::from(row[bit]));
            self.forward.process(&mut both);
            for k in 0..self.size {
                let (z, mirror) = (both[k], both[(self.size - k) % self.size].conj());
                let (a, b) = ((z + mirror) * 0.5, (z - mirror) * Complex::new(0.0, -0.5));
                product[k] += a.conj() * b;
            }
        }
        self.inverse.process(&mut product);
        let all = (self.template.len() * self.width) as f64;
        let offsets = (chunk.len().min(self.size) + 1).saturating_sub(self.template.len());
        for (k, score) in product.iter().enumerate().take(offsets) {
            let differing = ((all - score.re / self.size as f64) / 2.0).round().max(0.0) as u64;
            let worst = best.last().map_or(u64::MAX, |worst| worst.differing);
            if best.len() < KEPT || differing < worst {
                let candidate = Candidate { offset: base + k as i64, differing, compared: 0 };
                let place = best.partition_point(|other| other.differing <= differing);
                best.insert(place, candidate);
                best.truncate(KEPT);
            }
        }
    }
}
