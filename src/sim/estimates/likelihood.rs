//! Maximum likelihood in integers, without its clock: bit for bit what
//! [`likelihood_estimator`](crate::firmware::likelihood_estimator) computes.

mod arithmetic;
mod histogram;
mod scan;
mod step;
mod terms;
mod verdict;

use crate::firmware::likelihood_estimator::LikelihoodEstimator;
use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::words::STEPS;
use crate::firmware::tof_top::slot::EstimateWords;

use super::Clockless;

use histogram::Shots;
use step::step;
use verdict::verdict;

pub use histogram::{Ambient, Block};
pub use scan::Best;
pub use step::{Information, Point};
pub use verdict::Found;

/// An estimate with its intermediate results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trace {
    /// Ambient light by blocks of bins.
    pub ambient: Ambient,
    /// The highest place of the box.
    pub start: Best,
    /// First point of the fit.
    pub begin: Point,
    /// The point and the information of each step.
    pub steps: [(Point, Information); STEPS],
    /// The highest place of the box outside of the fit.
    pub other: Best,
    /// The result.
    pub found: Found,
}

impl Clockless for LikelihoodEstimator {
    fn estimate(p: &Params, histogram: &[u32]) -> EstimateWords {
        estimate(p, histogram).words()
    }
}

/// Estimates the depth of a histogram.
pub fn estimate(p: &Params, histogram: &[u32]) -> Found {
    trace(p, histogram).found
}

/// Estimates the depth of a histogram, and returns each stage's result.
pub fn trace(p: &Params, histogram: &[u32]) -> Trace {
    let shots = Shots::new(p, histogram);
    let ambient = shots.ambient(p);
    let start = scan::scan(p, &shots, ambient.hazard, 0..0);
    let begin = Point::start(p, &start, ambient.hazard);
    let (mut point, mut information) = (begin, Information::default());
    let steps = std::array::from_fn(|_| {
        (point, information) = step(p, &shots, &point);
        (point, information)
    });
    let other = scan::scan(p, &shots, point.ambient, point.window(p));
    let found = verdict(p, &shots, &start, &other, &point, &information);
    Trace { ambient, start, begin, steps, other, found }
}

#[cfg(test)]
mod tests;
