//! The parameters of a pulse with a formula.
//!
//! Not sigma and tail, because a tail's first order is zero at no tail: the whole deviation s, as ln s, and the
//! part of the third moment g = (tail / s)^3, in which the likelihood is smooth from g = 0 on.

use tofsim::kernel::pulse::Pulse;

/// Most of the third moment: beyond, the pulse has hardly a rise.
const MOST_SKEW: f64 = 0.98;

/// Formula of a pulse shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formula {
    /// A Gaussian.
    Gaussian,
    /// A Gaussian and an exponential tail.
    Tail,
}

/// A point in the parameters of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    formula: Formula,
    /// ln s, s in ps, and g.
    pub at: [f64; 2],
}

/// Width and tail with their standard errors [ps].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Width {
    /// Standard deviation of the Gaussian part.
    pub sigma_ps: f64,
    /// Its standard error.
    pub sigma_se_ps: f64,
    /// Mean of the exponential part; 0 without one.
    pub tail_ps: f64,
    /// Its standard error; of one that is not seen [`Width::most_tail_ps`] says more.
    pub tail_se_ps: f64,
    /// Whether the third moment is at least two standard errors.
    pub is_tail_seen: bool,
    /// The longest tail that would be seen so by chance once in twenty times.
    pub most_tail_ps: f64,
}

impl Shape {
    /// Of a Gaussian, from which a fit begins.
    pub fn new(formula: Formula, sigma_ps: f64) -> Self {
        let skew = if formula == Formula::Tail { 0.1 } else { 0.0 };
        Shape { formula, at: [libm::log(sigma_ps), skew] }
    }

    /// Parameters that the formula has.
    pub fn free(&self) -> usize {
        match self.formula {
            Formula::Gaussian => 1,
            Formula::Tail => 2,
        }
    }

    /// Gaussian part and tail [ps].
    fn parts_ps(at: &[f64; 2]) -> [f64; 2] {
        let part = libm::cbrt(at[1]);
        let whole_ps = libm::exp(at[0]);
        [whole_ps * (1.0 - part * part).sqrt(), whole_ps * part]
    }

    /// The pulse there.
    pub fn pulse(&self) -> Pulse {
        let [sigma_ps, tail_ps] = Shape::parts_ps(&self.at);
        Pulse::tailed(sigma_ps, tail_ps)
    }

    /// Another point, moved into the range of the parameters.
    pub fn moved(&self, step: &[f64; 2], scale: f64) -> Self {
        let mut to = *self;
        to.at[0] += (scale * step[0]).clamp(-0.5, 0.5);
        to.at[1] = (to.at[1] + scale * step[1]).clamp(0.0, MOST_SKEW);
        to
    }

    /// Two points to either side of this in a parameter, or this and one beside it at the end of a range.
    pub fn around(&self, parameter: usize) -> [Shape; 2] {
        const STEP: f64 = 1e-3;
        let mut step = [0.0; 2];
        step[parameter] = STEP;
        [self.moved(&step, -1.0), self.moved(&step, 1.0)]
    }

    /// Width and tail, with the standard errors that a covariance of the parameters makes of them.
    pub fn width(&self, covariance: &[[f64; 2]; 2]) -> Width {
        let [sigma_ps, tail_ps] = Shape::parts_ps(&self.at);
        let slope = |of: usize, by: usize| {
            let [low, high] = self.around(by);
            let rise = Shape::parts_ps(&high.at)[of] - Shape::parts_ps(&low.at)[of];
            let run = high.at[by] - low.at[by];
            if run > 0.0 { rise / run } else { 0.0 }
        };
        let error = |of: usize| {
            let by = [slope(of, 0), slope(of, 1)];
            let terms = [0, 1].map(|i| [0, 1].map(|j| by[i] * covariance[i][j] * by[j]));
            terms.iter().flatten().sum::<f64>().max(0.0).sqrt()
        };
        let skew_se = covariance[1][1].sqrt();
        let most = [self.at[0], (self.at[1] + 1.645 * skew_se).min(MOST_SKEW)];
        Width {
            sigma_ps,
            sigma_se_ps: error(0),
            tail_ps,
            tail_se_ps: if self.free() > 1 { error(1) } else { 0.0 },
            is_tail_seen: self.at[1] > 2.0 * skew_se,
            most_tail_ps: Shape::parts_ps(&most)[1],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parameters_are_deviation_and_skew_of_the_pulse() {
        let shape = Shape { formula: Formula::Tail, at: [libm::log(170.0), 0.216] };
        assert!((shape.pulse().sigma_ps() - 170.0).abs() < 1e-9);
        let Pulse::Tailed { tail_ps, .. } = shape.pulse() else { panic!("no tail") };
        assert!((tail_ps - 0.6 * 170.0).abs() < 1e-9);
        let Pulse::Gaussian { sigma_ps } = Shape::new(Formula::Gaussian, 137.0).pulse() else {
            panic!("a tail")
        };
        assert!((sigma_ps - 137.0).abs() < 1e-9);
    }

    #[test]
    fn errors_of_width_and_tail_follow_from_those_of_the_parameters() {
        let gaussian = Shape::new(Formula::Gaussian, 100.0).width(&[[1e-4, 0.0], [0.0, 0.0]]);
        assert!(
            (gaussian.sigma_ps - 100.0).abs() < 1e-9 && (gaussian.sigma_se_ps - 1.0).abs() < 1e-3
        );
        assert_eq!((gaussian.tail_ps, gaussian.tail_se_ps), (0.0, 0.0));
        let tail = Shape { formula: Formula::Tail, at: [libm::log(100.0), 0.125] };
        let width = tail.width(&[[0.0, 0.0], [0.0, 1e-4]]);
        // The tail is 50 ps; 100 g^(1/3) grows by 100 / 3 / 0.25 for each g.
        assert!((width.tail_ps - 50.0).abs() < 1e-9 && (width.tail_se_ps - 4.0 / 3.0).abs() < 1e-3);
        assert!(width.most_tail_ps > 52.0 && width.most_tail_ps < 52.3, "{width:?}");
    }
}
