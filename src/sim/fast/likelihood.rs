//! Maximum likelihood in integers, without its clock: bit for bit what
//! [`likelihood_estimator`](crate::firmware::likelihood_estimator) computes.

mod arithmetic;
mod histogram;
mod scan;
mod step;
mod terms;
mod verdict;

use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::words::STEPS;

use histogram::Shots;
use step::{Information, Point, step};
use verdict::verdict;

pub use verdict::Found;

/// The estimate of a histogram.
pub fn estimate(p: &Params, histogram: &[u32]) -> Found {
    let shots = Shots::new(p, histogram);
    let ambient = shots.ambient(p);
    let start = scan::scan(p, &shots, ambient, 0..0);
    let (mut point, mut information) = (Point::start(p, &start, ambient), Information::default());
    for _ in 0..STEPS {
        (point, information) = step(p, &shots, &point);
    }
    let other = scan::scan(p, &shots, point.ambient, point.window(p));
    verdict(p, &shots, &start, &other, &point, &information)
}

#[cfg(test)]
mod tests;
