//! Fisher scoring of the profile likelihood.
//!
//! The effect of a shape parameter is separated from that of each histogram's arrival, signal and background: the
//! information on these three is eliminated (Schur complement), histogram by histogram. The rest is summed, and its
//! inverse is the covariance of the parameters.

use rayon::prelude::*;

use tofsim::error::{Input, Result};

use crate::estimation::acquisition::{Acquisition, Echo};
use crate::estimation::likelihood::solve::solve;
use crate::estimation::likelihood::{Likelihood, Model};

use super::Sightings;
use super::shape::Shape;

/// Most steps of the climb.
const MOST_STEPS: usize = 60;
/// The climb is over when a step promises less than this gain of the log likelihood [1].
const TOLERANCE: f64 = 1e-4;
/// Most halvings of a step.
const MOST_HALVINGS: i32 = 12;
/// Differences of an echo's parameters: of its arrival in deviations, and of the logarithms of the others [1].
const DIFFERENCE: f64 = 1e-3;
/// Probability that is as good as none [1].
const IMPROBABLE: f64 = 1e-12;

/// The most likely shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Climbed {
    /// Its parameters.
    pub shape: Shape,
    /// Their covariance; zero for one that the formula does not have.
    pub covariance: [[f64; 2]; 2],
    /// Logarithm of the likelihood of the histograms, up to a constant.
    pub log_likelihood: f64,
}

/// Climbs from a shape; the sightings follow.
///
/// # Errors
/// When the histograms tell nothing of the shape, or the climb does not end.
pub fn climb(
    acquisition: &Acquisition,
    sightings: &mut Sightings,
    mut shape: Shape,
) -> Result<Climbed> {
    let fault = |expected: &str| Input::new("calibrate", expected);
    let mut value = sightings.refit(acquisition, &shape.pulse())?;
    for _ in 0..MOST_STEPS {
        let (score, information) = slope(acquisition, sightings, &shape)?;
        let covariance = inverse(&information, shape.free()).ok_or_else(|| {
            fault("expected histograms with an echo that shows the pulse: none has one")
        })?;
        let mut step = [0, 1].map(|i| covariance[i][0] * score[0] + covariance[i][1] * score[1]);
        if shape.at[1] == 0.0 && step[1] <= 0.0 {
            // There is no less than no tail, and the width alone moves.
            step = [score[0] / information[0][0], 0.0];
        }
        let gain: f64 = score.iter().zip(step).map(|(score, step)| score * step).sum();
        let mut taken = false;
        for halving in 0..MOST_HALVINGS {
            let to = shape.moved(&step, libm::exp2(-f64::from(halving)));
            let mut there = sightings.clone();
            let reached = there.refit(acquisition, &to.pulse())?;
            if reached >= value {
                taken = to != shape && reached - value > TOLERANCE / 10.0;
                (shape, value, *sightings) = (to, reached, there);
                break;
            }
        }
        if gain < TOLERANCE || !taken {
            return Ok(Climbed { shape, covariance, log_likelihood: value });
        }
    }
    Err(fault("the climb to the most likely pulse did not end").into())
}

/// Slope of the profile likelihood by the shape's parameters, and the information on them.
fn slope(
    acquisition: &Acquisition,
    sightings: &Sightings,
    shape: &Shape,
) -> Result<([f64; 2], [[f64; 2]; 2])> {
    let free = shape.free();
    let model_of = |shape: &Shape| -> Result<Model> {
        let pulse = shape.pulse();
        Ok(Likelihood::new(&Acquisition { pulse: &pulse, ..*acquisition })?.model().clone())
    };
    let here = model_of(shape)?;
    let mut sides = Vec::new();
    for parameter in 0..free {
        let [low, high] = shape.around(parameter);
        let run = high.at[parameter] - low.at[parameter];
        sides.push((model_of(&low)?, model_of(&high)?, run));
    }
    let sigma_ps = shape.pulse().sigma_ps();
    let shots = acquisition.shots as f64;
    let each = sightings.histograms.par_iter().zip(&sightings.echoes).map(|(histogram, echo)| {
        let score: Vec<_> = (sides.iter())
            .map(|(low, high, run)| {
                let [low, high] = [low, high].map(|model| model.log_likelihood_of(echo, histogram));
                (high - low) / run
            })
            .collect();
        let by_echo = echoes_around(echo, sigma_ps).map(|[low, high]| {
            difference(&cells(&here, &low), &cells(&here, &high), 2.0 * DIFFERENCE)
        });
        let by_shape = (sides.iter())
            .map(|(low, high, run)| difference(&cells(low, echo), &cells(high, echo), *run));
        let by: Vec<_> = by_echo.into_iter().chain(by_shape).collect();
        let p = cells(&here, echo);
        let information = |i: usize, j: usize| {
            let terms = p.iter().enumerate().filter(|(_, p)| **p > IMPROBABLE);
            shots * terms.map(|(cell, p)| by[i][cell] * by[j][cell] / p).sum::<f64>()
        };
        let echo_block = [0, 1, 2].map(|i| [0, 1, 2].map(|j| information(i, j)));
        let mut left = [[0.0; 2]; 2];
        for j in 0..free {
            let cross = [0, 1, 2].map(|k| information(k, 3 + j));
            // What the echo can take over of the parameter; all of it, where the echo is not known.
            let Some(taken) = solve(&echo_block, &cross, 1e-12, &[false; 3]) else { continue };
            for (i, row) in left.iter_mut().enumerate().take(free) {
                let others: f64 = (0..3).map(|k| information(k, 3 + i) * taken[k]).sum();
                row[j] = information(3 + i, 3 + j) - others;
            }
        }
        (score, left)
    });
    let (mut score, mut information) = ([0.0; 2], [[0.0; 2]; 2]);
    for (own, left) in each.collect::<Vec<_>>() {
        own.iter().enumerate().for_each(|(k, own)| score[k] += own);
        for (row, left) in information.iter_mut().zip(left) {
            row.iter_mut().zip(left).for_each(|(sum, left)| *sum += left);
        }
    }
    Ok((score, information))
}

/// Probabilities of the codes, and of no code.
fn cells(model: &Model, echo: &Echo) -> Vec<f64> {
    let mut cells = model.probabilities(echo);
    let none = 1.0 - cells.iter().sum::<f64>();
    cells.push(none);
    cells
}

fn difference(low: &[f64], high: &[f64], run: f64) -> Vec<f64> {
    low.iter().zip(high).map(|(low, high)| (high - low) / run).collect()
}

/// Two echoes to either side in each parameter.
fn echoes_around(echo: &Echo, sigma_ps: f64) -> [[Echo; 2]; 3] {
    let both = |change: fn(&mut Echo, f64, f64)| {
        [-DIFFERENCE, DIFFERENCE].map(|by| {
            let mut to = *echo;
            change(&mut to, by, sigma_ps);
            to
        })
    };
    [
        both(|echo, by, sigma_ps| echo.arrival_ps += by * sigma_ps),
        both(|echo, by, _| echo.signal *= libm::exp(by)),
        both(|echo, by, _| echo.background_per_ps *= libm::exp(by)),
    ]
}

/// The inverse of the first rows and columns, zero elsewhere.
fn inverse(matrix: &[[f64; 2]; 2], size: usize) -> Option<[[f64; 2]; 2]> {
    let [[a, b], [c, d]] = *matrix;
    if size == 1 {
        return (a > 0.0).then(|| [[1.0 / a, 0.0], [0.0, 0.0]]);
    }
    let determinant = a * d - b * c;
    let regular = a > 0.0 && determinant > 1e-12 * a * d;
    regular.then(|| [[d, -b], [-c, a]].map(|row| row.map(|element| element / determinant)))
}
