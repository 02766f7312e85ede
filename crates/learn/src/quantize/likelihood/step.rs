//! A step of Fisher scoring in (mu, log S, log b), in double precision.

use super::model::Model;
use super::scan::Best;
use super::shots::{Shots, Terms};

/// The part of a pulse in the box.
const IN_BOX: f64 = 0.84;
/// Smallest and largest signal [photons a shot].
const SIGNALS: [f64; 2] = [1.0 / 1024.0, 1024.0];
/// Smallest and largest ambient hazard [1 / bin].
const AMBIENTS: [f64; 2] = [1.0 / 16_777_216.0, 1.0];
/// Regularization of mu, log S and log b [counts].
const RIDGE: [f64; 3] = [1.0 / 16.0, 1.0 / 16.0, 1.0];

/// Parameters of the scene in a fit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Point {
    /// Arrival of the echo [ps].
    pub arrival_ps: f64,
    /// S [photons a shot].
    pub signal: f64,
    /// b [1 / bin].
    pub ambient: f64,
}

/// Intermediate values of a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Information {
    /// Variance of mu [ps^2].
    pub variance_ps2: f64,
    /// Variance of log S [1].
    pub variance_of_log: f64,
    /// Number of times that the step was halved.
    pub cut: u32,
    /// Change of mu [ps].
    pub move_ps: f64,
}

impl Point {
    /// Returns the point of the best box.
    pub fn start(model: &Model, best: &Best, ambient: f64) -> Self {
        let (from, until) = best.bins;
        let bins = (until - from) as f64;
        let signal = best.excess * bins / best.waiting.max(0.5) / IN_BOX;
        Point {
            arrival_ps: (from + until) as f64 / 2.0 * model.bin_ps,
            signal: signal.clamp(SIGNALS[0], SIGNALS[1]),
            ambient,
        }
    }

    /// Computes the terms of each bin of the fit, with the slope of its part, followed by all other bins as one.
    pub fn terms(&self, model: &Model, shots: &Shots) -> Vec<(Terms, f64)> {
        let window = model.window(self.arrival_ps);
        let of = |bin: usize| {
            let (width, [part, slope]) = (model.width(bin), model.part(bin, self.arrival_ps));
            let (ended, waiting) = (shots.ended[bin], shots.waiting[bin]);
            match width > 0.0 {
                true => {
                    (Terms::new(ended, waiting, self.signal * part, self.ambient * width), slope)
                }
                false => (Terms::default(), slope),
            }
        };
        let outside = |of: &[f64]| -> f64 {
            of.iter().enumerate().filter(|(bin, _)| !window.contains(bin)).map(|(_, one)| one).sum()
        };
        let (ended, exposed) = (outside(&shots.ended), outside(&shots.exposed));
        let rest = (Terms::new(ended, exposed, 0.0, self.ambient), 0.0);
        window.clone().map(of).chain([rest]).collect()
    }
}

/// One step from a point.
pub fn step(model: &Model, shots: &Shots, from: &Point) -> (Point, Information) {
    let mut a = [[RIDGE[0], 0.0, 0.0], [0.0, RIDGE[1], 0.0], [0.0, 0.0, RIDGE[2]]];
    let mut y = [0.0; 3];
    for (Terms { residual, weight, share, .. }, slope) in from.terms(model, shots) {
        let by = [share * slope, share, 1.0 - share];
        for row in 0..3 {
            y[row] += residual * by[row];
            (0..3).for_each(|column| a[row][column] += weight * by[row] * by[column]);
        }
    }
    // log b is eliminated, and the rest is solved by Cramer's rule.
    let rest = |row: usize, column: usize| a[row][column] - a[row][2] * a[2][column] / a[2][2];
    let (a11, a12, a22) = (rest(0, 0), rest(0, 1), rest(1, 1));
    let [x1, x2] = [0, 1].map(|row| y[row] - a[row][2] * y[2] / a[2][2]);
    let determinant = (a11 * a22 - a12 * a12).max(f64::MIN_POSITIVE);
    let mut d1 = (a22 * x1 - a12 * x2) / determinant;
    let mut d2 = (a11 * x2 - a12 * x1) / determinant;
    // mu goes by less than 32 of z, and log S by less than one.
    let most_ps = model.sigma_ps * model.sigma_ps / model.stride_ps;
    let along = (d1 * model.stride_ps / most_ps).abs().max(d2.abs());
    let cut = if along >= 1.0 { along.log2().floor() as u32 + 1 } else { 0 };
    (d1, d2) = (d1 / f64::from(cut).exp2(), d2 / f64::from(cut).exp2());
    let d3 = (y[2] - a[2][0] * d1 - a[2][1] * d2) / a[2][2];
    let move_ps = d1 * model.stride_ps;
    let to = Point {
        arrival_ps: (from.arrival_ps + move_ps).clamp(0.0, model.end_ps()),
        signal: (from.signal * (1.0 + d2 + d2 * d2 / 2.0)).clamp(SIGNALS[0], SIGNALS[1]),
        ambient: (from.ambient * (1.0 + d3.clamp(-0.5, 3.0))).clamp(AMBIENTS[0], AMBIENTS[1]),
    };
    let variance_ps2 = a22 / determinant * model.stride_ps * model.stride_ps;
    (to, Information { variance_ps2, variance_of_log: a11 / determinant, cut, move_ps })
}
