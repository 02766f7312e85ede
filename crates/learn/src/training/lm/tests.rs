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
    fn cost(&self, x: &[f64]) -> f64 {
        let (r, _) = (self.residuals)(x);
        r.iter().map(|r| r * r).sum::<f64>() / r.len() as f64
    }

    fn linearise(&self, x: &[f64]) -> NormalEquations {
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
        NormalEquations { cost: self.cost(x), matrix, gradient }
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
    let text = include_str!("../../../tests/reference/lm_small_network.csv");
    let mut lm = Lm::new(vec![0.5, -0.8, 0.1, -0.2, 0.3, 0.4, 0.05], &LmSettings::default());
    let problem = dense(7, small_network, &[]);
    let mut steps = 0;
    for line in text.lines().filter(|line| !line.starts_with(['#', 'e'])) {
        let numbers: Vec<f64> = line.split(',').map(|n| n.parse().unwrap()).collect();
        lm.epoch(&problem, &LmSettings::default()).unwrap();
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
    let mut lm = Lm::new(vec![0.0], &LmSettings::default());
    for _ in 0..20 {
        lm.epoch(&problem, &LmSettings::default()).unwrap();
    }
    assert_eq!(lm.stop, Some(Stop::Gradient));
    assert!((lm.x[0] - 3.0).abs() < 1e-7);
}

#[test]
fn a_step_that_cannot_help_stops_it_and_one_that_cannot_be_made_is_an_error() {
    let settings = LmSettings { mu_max: 1e3, ..LmSettings::default() };
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
    let settings = LmSettings { mu: 0.0, ..LmSettings::default() };
    let mut lm = Lm::new(vec![0.0, 0.0], &settings);
    lm.epoch(&sum, &settings).unwrap();
    assert!(lm.mu > 0.0 && lm.cost < 1e-6, "{lm:?}");
    assert!((lm.x[0] + lm.x[1] - 2.0).abs() < 1e-3, "{lm:?}");
}

#[test]
fn a_growing_validation_error_stops_it() {
    let settings = LmSettings { max_fail: 2, ..LmSettings::default() };
    let problem = dense(7, small_network, &[1.0, 1.5, 0.5, 0.6, 0.7, 0.1]);
    let mut lm = Lm::new(vec![0.5, -0.8, 0.1, -0.2, 0.3, 0.4, 0.05], &settings);
    let mut passed = Vec::new();
    for _ in 0..8 {
        lm.epoch(&problem, &settings).unwrap();
        passed.push(lm.x.clone());
    }
    assert_eq!((lm.epochs, lm.stop), (5, Some(Stop::Validation)));
    assert_eq!((lm.validation, &lm.x), (Some(0.5), &passed[2]), "back where it was least");
}
