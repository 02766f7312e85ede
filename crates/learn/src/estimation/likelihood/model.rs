//! The probability of a histogram: the first avalanche of each shot, bin by bin.
//!
//! As [`tofsim::optics`] has it, with Phi itself in place of its broken line: H(t) = N t +
//! S Phi((t - mu) / sigma), H(0) = 0, and a code has the probability exp(-H(a)) - exp(-H(b)), summed
//! over its spans; what lies between the spans and after them has no code. The histogram, with the
//! shots without a code as one more cell, is a multinomial number.
//!
//! Coordinates are mu / sigma, ln S and N times the end of the last bin: numbers of order 1, and S
//! stays positive.

use std::f64::consts::PI;

use tofsim::error::Input;
use tofsim::network::Histogram;
use tofsim::optics::hazard::normal_cdf;

use crate::estimation::acquisition::{ARRIVAL_PS_PER_M, Acquisition, Echo, spans_ps};

use super::solve::{Matrix, inverse_diagonal};

/// Cells: the codes, and no code [1].
const CELLS: usize = 257;
/// Background that is as good as none: hits of it in all shots [hits].
const LEAST: f64 = 0.01;
/// Signal below which no climb begins [1].
const FAINTEST: f64 = 1e-7;
/// Probability that is as good as none [1].
const IMPROBABLE: f64 = 1e-250;

/// The model of one pulse and one chain.
#[derive(Clone, Debug)]
pub struct Model {
    /// Ends of stretches in order of time, from 0 on [ps], and the cell of each [code or 256].
    stretches: Vec<(f64, usize)>,
    /// Shots of the histogram [shots].
    pub(super) shots: u64,
    /// Standard deviation of the pulse [ps].
    pub(super) sigma_ps: f64,
    /// End of the last bin [ps].
    pub(super) end_ps: f64,
}

/// Probabilities of the cells and their derivatives by the coordinates.
struct Cells {
    of: [f64; CELLS],
    by: [[f64; 3]; CELLS],
}

impl Model {
    /// For histograms that come about so.
    ///
    /// # Errors
    /// When [`Acquisition::check`] fails.
    pub fn new(acquisition: &Acquisition) -> Result<Self, Input> {
        acquisition.check()?;
        let mut stretches: Vec<(f64, usize)> = Vec::new();
        let mut end_ps = 0.0;
        for (code, from, until) in spans_ps(acquisition.bins) {
            if from > end_ps {
                stretches.push((from, CELLS - 1));
            }
            stretches.push((until, code.into()));
            end_ps = until;
        }
        let (shots, sigma_ps) = (acquisition.shots, acquisition.pulse_sigma_ps);
        Ok(Model { stretches, shots, sigma_ps, end_ps })
    }

    /// Lower limit of the third coordinate.
    pub fn least_background(&self) -> f64 {
        LEAST / self.shots as f64
    }

    /// Coordinates of an echo, within their limits.
    pub fn coordinates(&self, echo: &Echo) -> [f64; 3] {
        let background = echo.background_per_ps * self.end_ps;
        let signal = echo.signal.max(FAINTEST);
        [
            echo.arrival_ps / self.sigma_ps,
            libm::log(signal),
            background.max(self.least_background()),
        ]
    }

    /// The echo at coordinates.
    pub fn echo(&self, at: &[f64; 3]) -> Echo {
        Echo {
            arrival_ps: at[0] * self.sigma_ps,
            signal: libm::exp(at[1]),
            background_per_ps: at[2] / self.end_ps,
        }
    }

    /// Logarithm of the histogram's probability, but for a constant.
    pub fn log_likelihood(&self, at: &[f64; 3], histogram: &Histogram) -> f64 {
        let cells = self.cells(at);
        let terms = self.counts(histogram).zip(cells.of);
        terms
            .map(|(count, p)| if count > 0.0 { count * libm::log(p.max(IMPROBABLE)) } else { 0.0 })
            .sum()
    }

    /// Derivatives of the log likelihood, and Fisher's information.
    pub fn slope(&self, at: &[f64; 3], histogram: &Histogram) -> ([f64; 3], Matrix) {
        let cells = self.cells(at);
        let mut gradient = [0.0; 3];
        for ((count, p), by) in self.counts(histogram).zip(cells.of).zip(&cells.by) {
            if count > 0.0 && p > IMPROBABLE {
                gradient = [0, 1, 2].map(|k| gradient[k] + count * by[k] / p);
            }
        }
        (gradient, self.information(&cells))
    }

    /// The Cramér-Rao bound: the smallest standard deviation that an unbiased estimate of the
    /// distance can have, if signal and background are not known either [m]. `None` where the
    /// histogram tells nothing.
    pub fn cramer_rao_m(&self, echo: &Echo) -> Option<f64> {
        let information = self.information(&self.cells(&self.coordinates(echo)));
        let variance = inverse_diagonal(&information, false)?[0];
        Some(variance.sqrt() * self.sigma_ps / ARRIVAL_PS_PER_M)
    }

    /// Counts of the cells; last the shots without a code.
    fn counts(&self, histogram: &Histogram) -> impl Iterator<Item = f64> {
        let hits: u64 = histogram.iter().map(|&count| u64::from(count)).sum();
        let without = self.shots.saturating_sub(hits) as f64;
        histogram.map(f64::from).into_iter().chain([without])
    }

    /// Expected curvature of the log likelihood.
    fn information(&self, cells: &Cells) -> Matrix {
        let mut matrix = [[0.0; 3]; 3];
        for (&p, by) in cells.of.iter().zip(&cells.by) {
            if p > IMPROBABLE {
                let weight = self.shots as f64 / p;
                for (row, a) in matrix.iter_mut().zip(by) {
                    row.iter_mut().zip(by).for_each(|(element, b)| *element += weight * a * b);
                }
            }
        }
        matrix
    }

    /// H and its derivatives at the end of a stretch.
    fn hazard(&self, at: &[f64; 3], signal: f64, t_ps: f64) -> (f64, [f64; 3]) {
        let z = t_ps / self.sigma_ps - at[0];
        let density = libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt();
        let (part, of_end) = (signal * normal_cdf(z), t_ps / self.end_ps);
        (at[2] * of_end + part, [-signal * density, part, of_end])
    }

    fn cells(&self, at: &[f64; 3]) -> Cells {
        let mut cells = Cells { of: [0.0; CELLS], by: [[0.0; 3]; CELLS] };
        let signal = libm::exp(at[1]);
        let (mut h, mut by) = (0.0, [0.0; 3]);
        for &(until_ps, cell) in &self.stretches {
            let (next, next_by) = self.hazard(at, signal, until_ps);
            // In this form a small difference keeps its digits.
            let (none_yet, none_after) = (libm::exp(-h), libm::exp(-next));
            let p = -none_yet * libm::expm1(h - next);
            let grown = |k: usize| (next_by[k] - by[k]) * none_after - by[k] * p;
            cells.add(cell, p, [0, 1, 2].map(grown));
            (h, by) = (next, next_by);
        }
        let none = libm::exp(-h);
        cells.add(CELLS - 1, none, by.map(|by| -by * none));
        cells
    }
}

impl Cells {
    fn add(&mut self, cell: usize, p: f64, by: [f64; 3]) {
        self.of[cell] += p;
        self.by[cell].iter_mut().zip(by).for_each(|(sum, by)| *sum += by);
    }
}
