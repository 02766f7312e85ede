//! Levenberg and Marquardt's method as MATLAB's `trainlm` has it (Hagan and Menhaj, 1994).

use serde::{Deserialize, Serialize};

use tofsim::error::{Input, Result};

use super::cholesky::Symmetric;

/// A sum of squares to make small.
pub trait Problem: Sync {
    /// The mean square at `x`.
    fn cost(&self, x: &[f64]) -> f64;

    /// The mean square at `x` and its normal equations.
    fn linearise(&self, x: &[f64]) -> NormalEquations;

    /// The mean square over data that no step is made from, if there are any.
    fn validation(&self, _x: &[f64]) -> Option<f64> {
        None
    }
}

/// The normal equations at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalEquations {
    /// Mean square of the residuals r.
    pub cost: f64,
    /// J'J / n, with J the derivatives of the residuals.
    pub matrix: Symmetric,
    /// J'r / n, half the gradient of the mean square.
    pub gradient: Vec<f64>,
}

/// The method's constants; names and defaults are `trainlm`'s where it has them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LmSettings {
    /// Damping to begin with.
    pub mu: f64,
    /// Factor on the damping after a step that helps.
    pub mu_dec: f64,
    /// Factor on the damping after one that does not.
    pub mu_inc: f64,
    /// Damping at which to give up.
    pub mu_max: f64,
    /// Least damping (`trainlm` has none).
    pub mu_min: f64,
    /// Norm of the mean square's gradient at which to stop.
    pub min_grad: f64,
    /// Epochs in a row after which a growing validation error stops the training.
    pub max_fail: u32,
}

impl Default for LmSettings {
    fn default() -> Self {
        LmSettings {
            mu: 1e-3,
            mu_dec: 0.1,
            mu_inc: 10.0,
            mu_max: 1e10,
            mu_min: 0.0,
            min_grad: 1e-7,
            max_fail: 6,
        }
    }
}

/// Why the method stopped of itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stop {
    /// The gradient is next to nothing.
    Gradient,
    /// No step helps, however short.
    Damping,
    /// The validation error grew too often; the parameters are those where it was least.
    Validation,
    /// The caller decided that further epochs gain too little.
    Gain,
}

/// State of the method.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Lm {
    /// The parameters.
    pub x: Vec<f64>,
    /// Mean square there; infinite before the first epoch.
    pub cost: f64,
    /// Damping.
    pub mu: f64,
    /// Epochs made.
    pub epochs: u64,
    /// Validation error after the last epoch, if there is one.
    pub validation: Option<f64>,
    /// Least validation error so far, and the parameters that have it.
    pub least: Option<(f64, Vec<f64>)>,
    /// Epochs since then.
    pub failures: u32,
    /// Why it goes no further.
    pub stop: Option<Stop>,
}

impl Lm {
    /// At the start.
    pub fn new(x: Vec<f64>, settings: &LmSettings) -> Self {
        Lm { x, cost: f64::INFINITY, mu: settings.mu, ..Lm::default() }
    }

    /// Goes on from the same parameters on another problem.
    pub fn restart(&mut self, settings: &LmSettings) {
        *self = Lm { epochs: self.epochs, ..Lm::new(std::mem::take(&mut self.x), settings) };
    }

    /// One epoch: damps until a step helps. Does nothing once stopped.
    ///
    /// # Errors
    /// When the mean square or its derivatives are no numbers, or the normal equations cannot be
    /// solved at any damping.
    pub fn epoch(&mut self, problem: &impl Problem, settings: &LmSettings) -> Result<()> {
        if self.stop.is_some() {
            return Ok(());
        }
        let NormalEquations { cost, matrix, gradient } = problem.linearise(&self.x);
        self.cost = cost;
        if !cost.is_finite() {
            return Err(fault("mean square", cost, "expected a finite number").into());
        }
        if 2.0 * norm(&gradient) < settings.min_grad {
            self.stop = Some(Stop::Gradient);
            return Ok(());
        }
        let mut solved = false;
        while self.mu <= settings.mu_max {
            if let Some(step) = matrix.solve(self.mu, &gradient) {
                solved = true;
                let next: Vec<f64> = self.x.iter().zip(&step).map(|(x, step)| x - step).collect();
                let cost = problem.cost(&next);
                if cost < self.cost {
                    (self.x, self.cost) = (next, cost);
                    self.mu = (self.mu * settings.mu_dec).max(settings.mu_min);
                    self.epochs += 1;
                    self.validate(problem, settings);
                    return Ok(());
                }
            }
            // A damping of zero would stay zero.
            self.mu = (self.mu * settings.mu_inc).max(f64::EPSILON);
        }
        if !solved {
            let expected = format!(
                "the normal equations are singular at every damping up to mu_max = {}",
                settings.mu_max
            );
            return Err(fault("mu", self.mu, expected).into());
        }
        self.stop = Some(Stop::Damping);
        Ok(())
    }

    fn validate(&mut self, problem: &impl Problem, settings: &LmSettings) {
        self.validation = problem.validation(&self.x);
        let Some(error) = self.validation else { return };
        match &mut self.least {
            Some((least, best)) if error >= *least => {
                self.failures += 1;
                if self.failures >= settings.max_fail {
                    (self.x, self.validation) = (std::mem::take(best), Some(*least));
                    (self.least, self.stop) = (None, Some(Stop::Validation));
                }
            }
            _ => (self.least, self.failures) = (Some((error, self.x.clone())), 0),
        }
    }
}

fn fault(field: &str, value: f64, expected: impl std::fmt::Display) -> Input {
    Input::new("training", expected).field(field).value(value)
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests;
