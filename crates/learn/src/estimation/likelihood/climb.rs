//! Fisher scoring to the top of the likelihood, damped as Levenberg and Marquardt do where a step gains
//! nothing.

use std::array;

use crate::estimation::estimator::Failure;

use super::model::{Model, echoes, pedestal};
use super::solve::{Matrix, inverse_diagonal, solve};

/// Largest step of any coordinate in one iteration [sigma, e-folds].
const LONGEST: f64 = 1.0;
/// The background falls to a tenth in one iteration at most [1].
const FALL: f64 = 0.1;
/// Change of a signal beyond which a climb has diverged, in either direction [e-folds].
const RUNAWAY: f64 = 20.0;
/// A promised gain that rounding may swallow [1].
const NOTHING: f64 = 1e-4;
/// A damping that leaves no step worth trying [1].
const STUCK: f64 = 1e6;
/// Most steps, taken or not.
const MOST_ITERATIONS: usize = 200;
/// The climb is over when a step promises less than this gain of the log likelihood [1].
const TOLERANCE: f64 = 1e-5;
/// Signal that counts as one, in its own standard deviations [1].
const SIGNIFICANCE: f64 = 4.0;

/// A top of the likelihood.
#[derive(Clone, Debug)]
pub struct Top<const N: usize> {
    /// Coordinates.
    pub at: [f64; N],
    /// The log likelihood there, but for a constant.
    pub value: f64,
    /// Variances of the coordinates by the expected curvature.
    pub variances: [f64; N],
}

/// The top that is reached from `at`.
///
/// # Errors
/// When the climb does not end, leaves the bins, or its end has an echo that is none.
pub fn climb<const N: usize>(
    model: &Model,
    histogram: &[u32],
    mut at: [f64; N],
) -> Result<Top<N>, Failure> {
    let mut value = model.log_likelihood(&at, histogram);
    let mut damping = 0.0f64;
    let mut slope = model.slope(&at, histogram);
    for _ in 0..MOST_ITERATIONS {
        let (gradient, information) = &slope;
        // At its lowest the background stays, unless it is to rise, and so does the window's light.
        let mut held = [false; N];
        held[N - 1] = at[N - 1] <= model.least_background() && gradient[N - 1] <= 0.0;
        if let Some(k) = pedestal::<N>() {
            held[k] = at[k] <= 0.0 && gradient[k] <= 0.0;
        }
        let step = solve(information, gradient, damping, &held);
        let gain = step.map(|step| (0..N).map(|k| step[k] * gradient[k]).sum::<f64>());
        if damping == 0.0 && gain.is_some_and(|gain| gain < TOLERANCE) {
            return accept(at, value, information, &held);
        }
        let tried = step.map(|step| go(model, &at, &step));
        let reached = tried.map(|to| (to, model.log_likelihood(&to, histogram)));
        match reached.filter(|(_, reached)| *reached >= value) {
            Some((to, reached)) => {
                (at, value) = (to, reached);
                damping = if damping > 1e-4 { damping * 0.1 } else { 0.0 };
                slope = model.slope(&at, histogram);
            }
            None if damping == 0.0 && gain.is_some_and(|gain| gain < NOTHING) => {
                return accept(at, value, information, &held);
            }
            None => damping = (damping * 10.0).max(1e-3),
        }
        if (0..2 * echoes::<N>()).step_by(2).any(|k| is_outside(model, at[k])) {
            return Err(Failure::NoPeak);
        }
        if damping > STUCK || (1..2 * echoes::<N>()).step_by(2).any(|k| at[k].abs() > RUNAWAY) {
            break;
        }
    }
    Err(Failure::NoConvergence)
}

/// The end of a step, which is shortened so that no coordinate goes too far.
fn go<const N: usize>(model: &Model, at: &[f64; N], step: &[f64; N]) -> [f64; N] {
    let longest = step[..N - 1].iter().fold(LONGEST, |longest, step| longest.max(step.abs()));
    let mut to = array::from_fn(|k| at[k] + step[k] * LONGEST / longest);
    let least = (at[N - 1] * FALL).max(model.least_background());
    to[N - 1] = to[N - 1].max(least);
    if let Some(k) = pedestal::<N>() {
        to[k] = to[k].max(0.0);
    }
    to
}

/// The top, if its signals are some.
fn accept<const N: usize>(
    at: [f64; N],
    value: f64,
    information: &Matrix<N>,
    held: &[bool; N],
) -> Result<Top<N>, Failure> {
    let variances = inverse_diagonal(information, held).ok_or(Failure::NoConvergence)?;
    // The deviation of ln S is that of S by S.
    let faint = |k: usize| variances[k + 1].sqrt() * SIGNIFICANCE > 1.0;
    if (0..2 * echoes::<N>()).step_by(2).any(faint) {
        return Err(Failure::NoPeak);
    }
    Ok(Top { at, value, variances })
}

/// Returns whether an echo there would come before the first bin or after the last, by more than its deviation.
fn is_outside(model: &Model, arrival: f64) -> bool {
    !(-model.sigma_ps..=model.end_ps + model.sigma_ps).contains(&(arrival * model.sigma_ps))
}
