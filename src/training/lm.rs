//! Levenberg and Marquardt's method as MATLAB's `trainlm` has it (Hagan and Menhaj, 1994).

use serde::{Deserialize, Serialize};

use crate::error::{Input, Result};

use super::cholesky::Symmetric;

/// A sum of squares to make small.
pub trait Problem: Sync {
    /// Number of parameters.
    fn parameters(&self) -> usize;

    /// The mean square at `x`.
    fn cost(&self, x: &[f64]) -> f64;

    /// The mean square at `x` and its normal equations.
    fn linearise(&self, x: &[f64]) -> Linear;

    /// The mean square over data that no step is made from, if there are any.
    fn validation(&self, _x: &[f64]) -> Option<f64> {
        None
    }
}

/// The normal equations at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// Mean square of the residuals r.
    pub cost: f64,
    /// J'J / n, with J the derivatives of the residuals.
    pub matrix: Symmetric,
    /// J'r / n, half the gradient of the mean square.
    pub gradient: Vec<f64>,
}

/// The method's constants; names and defaults are `trainlm`'s where it has them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
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

impl Default for Settings {
    fn default() -> Self {
        Settings {
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
    /// The validation error grew too often.
    Validation,
}

/// Where the method is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lm {
    /// The parameters.
    pub x: Vec<f64>,
    /// Mean square there; infinite before the first epoch.
    pub cost: f64,
    /// Damping.
    pub mu: f64,
    /// Epochs made.
    pub epochs: u64,
    /// Least validation error so far.
    pub validation: f64,
    /// Epochs since then.
    pub failures: u32,
    /// Why it goes no further.
    pub stop: Option<Stop>,
}

impl Lm {
    /// At the start.
    pub fn new(x: Vec<f64>, settings: &Settings) -> Self {
        Lm {
            x,
            cost: f64::INFINITY,
            mu: settings.mu,
            epochs: 0,
            validation: f64::INFINITY,
            failures: 0,
            stop: None,
        }
    }

    /// Goes on from the same parameters on another problem.
    pub fn restart(&mut self, settings: &Settings) {
        *self = Lm { epochs: self.epochs, ..Lm::new(std::mem::take(&mut self.x), settings) };
    }

    /// One epoch: damps until a step helps. Does nothing once stopped.
    ///
    /// # Errors
    /// When the mean square or its derivatives are no numbers, or the normal equations cannot be
    /// solved at any damping.
    pub fn epoch(&mut self, problem: &impl Problem, settings: &Settings) -> Result<()> {
        if self.stop.is_some() {
            return Ok(());
        }
        let Linear { cost, matrix, gradient } = problem.linearise(&self.x);
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

    fn validate(&mut self, problem: &impl Problem, settings: &Settings) {
        let Some(error) = problem.validation(&self.x) else { return };
        if error < self.validation {
            (self.validation, self.failures) = (error, 0);
        } else {
            self.failures += 1;
            if self.failures >= settings.max_fail {
                self.stop = Some(Stop::Validation);
            }
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
mod tests {
    use super::*;

    /// A small problem in dense matrices.
    pub(crate) struct Dense<F> {
        pub parameters: usize,
        /// Residuals and their derivatives, a row for each residual.
        pub residuals: F,
        pub validation: Vec<f64>,
        pub asked: std::sync::atomic::AtomicUsize,
    }

    impl<F: Fn(&[f64]) -> (Vec<f64>, Vec<Vec<f64>>) + Sync> Problem for Dense<F> {
        fn parameters(&self) -> usize {
            self.parameters
        }

        fn cost(&self, x: &[f64]) -> f64 {
            let (r, _) = (self.residuals)(x);
            r.iter().map(|r| r * r).sum::<f64>() / r.len() as f64
        }

        fn linearise(&self, x: &[f64]) -> Linear {
            let (r, jacobian) = (self.residuals)(x);
            let n = r.len() as f64;
            let mut matrix = Symmetric::zeros(self.parameters);
            let mut gradient = vec![0.0; self.parameters];
            for (row, r) in jacobian.iter().zip(&r) {
                for i in 0..self.parameters {
                    gradient[i] += row[i] * r / n;
                    (0..=i).for_each(|j| matrix.add(i, j, row[i] * row[j] / n));
                }
            }
            Linear { cost: self.cost(x), matrix, gradient }
        }

        fn validation(&self, _x: &[f64]) -> Option<f64> {
            let asked = self.asked.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            self.validation.get(asked).copied()
        }
    }

    fn dense<F>(parameters: usize, residuals: F, validation: &[f64]) -> Dense<F> {
        let asked = std::sync::atomic::AtomicUsize::new(0);
        Dense { parameters, residuals, validation: validation.to_vec(), asked }
    }

    /// 1-2-1 network with tanh, on eleven points of a curve.
    fn small_network(x: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let mut rows = Vec::new();
        let mut residuals = Vec::new();
        for k in 0..11 {
            let t = k as f64 / 5.0 - 1.0;
            let a = [libm::tanh(x[0] * t + x[2]), libm::tanh(x[1] * t + x[3])];
            let g = [x[4] * (1.0 - a[0] * a[0]), x[5] * (1.0 - a[1] * a[1])];
            residuals.push(x[4] * a[0] + x[5] * a[1] + x[6] - (t * t + 0.3 * t));
            rows.push(vec![g[0] * t, g[1] * t, g[0], g[1], a[0], a[1], 1.0]);
        }
        (residuals, rows)
    }

    #[test]
    fn ten_steps_are_those_of_an_independent_implementation() {
        let text = include_str!("../../tests/reference/lm_small_network.csv");
        let mut lm = Lm::new(vec![0.5, -0.8, 0.1, -0.2, 0.3, 0.4, 0.05], &Settings::default());
        let problem = dense(7, small_network, &[]);
        let mut steps = 0;
        for line in text.lines().filter(|line| !line.starts_with(['#', 'e'])) {
            let numbers: Vec<f64> = line.split(',').map(|n| n.parse().unwrap()).collect();
            lm.epoch(&problem, &Settings::default()).unwrap();
            let found = [lm.epochs as f64, lm.mu, lm.cost].into_iter().chain(lm.x.iter().copied());
            for (found, expected) in found.zip(&numbers) {
                assert!((found - expected).abs() <= 1e-9 * expected.abs().max(1.0), "{line}");
            }
            steps += 1;
        }
        assert_eq!(steps, 10);
    }

    #[test]
    fn it_stops_at_the_bottom() {
        let problem = dense(1, |x: &[f64]| (vec![x[0] - 3.0], vec![vec![1.0]]), &[]);
        let mut lm = Lm::new(vec![0.0], &Settings::default());
        for _ in 0..20 {
            lm.epoch(&problem, &Settings::default()).unwrap();
        }
        assert_eq!(lm.stop, Some(Stop::Gradient));
        assert!((lm.x[0] - 3.0).abs() < 1e-7);
    }

    #[test]
    fn a_step_that_cannot_help_stops_it_and_one_that_cannot_be_made_is_an_error() {
        let settings = Settings { mu_max: 1e3, ..Settings::default() };
        // A wrong derivative: every step leads uphill.
        let uphill = dense(1, |x: &[f64]| (vec![x[0] + 1.0], vec![vec![-1.0]]), &[]);
        let mut lm = Lm::new(vec![0.0], &settings);
        lm.epoch(&uphill, &settings).unwrap();
        assert_eq!((lm.stop, lm.x[0]), (Some(Stop::Damping), 0.0));
        let infinite = dense(1, |_: &[f64]| (vec![1.0], vec![vec![f64::INFINITY]]), &[]);
        let mut lm = Lm::new(vec![0.0], &settings);
        let error = lm.epoch(&infinite, &settings).unwrap_err().to_string();
        assert!(error.contains("singular") && error.contains("mu_max = 1000"), "{error}");
        let nan = dense(1, |_: &[f64]| (vec![f64::NAN], vec![vec![1.0]]), &[]);
        let error = Lm::new(vec![0.0], &settings).epoch(&nan, &settings).unwrap_err().to_string();
        assert!(error.contains("mean square = NaN"), "{error}");
    }

    #[test]
    fn singular_equations_are_damped() {
        // Two parameters of which only the sum counts.
        let sum = dense(2, |x: &[f64]| (vec![x[0] + x[1] - 2.0], vec![vec![1.0, 1.0]]), &[]);
        let settings = Settings { mu: 0.0, ..Settings::default() };
        let mut lm = Lm::new(vec![0.0, 0.0], &settings);
        lm.epoch(&sum, &settings).unwrap();
        assert!(lm.mu > 0.0 && lm.cost < 1e-6, "{lm:?}");
        assert!((lm.x[0] - lm.x[1]).abs() < 1e-6, "{lm:?}");
    }

    #[test]
    fn a_growing_validation_error_stops_it() {
        let settings = Settings { max_fail: 2, ..Settings::default() };
        let problem = dense(7, small_network, &[1.0, 1.5, 0.5, 0.6, 0.7, 0.1]);
        let mut lm = Lm::new(vec![0.5, -0.8, 0.1, -0.2, 0.3, 0.4, 0.05], &settings);
        for _ in 0..8 {
            lm.epoch(&problem, &settings).unwrap();
        }
        assert_eq!((lm.epochs, lm.stop), (5, Some(Stop::Validation)));
    }
}
