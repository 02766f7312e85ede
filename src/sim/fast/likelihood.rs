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

/// All on the way to an estimate.
#[derive(Clone, Debug)]
pub struct Stages {
    /// Ambient hazard at the start, 30 fraction bits [1 / unit].
    pub ambient: i64,
    /// Where the box stands highest, and how high.
    pub start: scan::Best,
    /// Where each step began, and last where the last one ended.
    pub points: Vec<Point>,
    /// What the last step knew.
    pub information: Information,
    /// The highest box beside the fit.
    pub other: scan::Best,
    /// What comes out.
    pub found: Found,
}

/// The estimate of a histogram.
pub fn estimate(p: &Params, histogram: &[u32]) -> Found {
    stages(p, histogram).found
}

/// The same, with all that is on the way.
pub fn stages(p: &Params, histogram: &[u32]) -> Stages {
    let shots = Shots::new(p, histogram);
    let ambient = shots.ambient(p);
    let start = scan::scan(p, &shots, ambient, 0..0);
    let mut points = vec![Point::start(p, &start, ambient)];
    let mut information = Information::default();
    for _ in 0..STEPS {
        let to;
        (to, information) = step(p, &shots, &points[points.len() - 1]);
        points.push(to);
    }
    let last = &points[STEPS];
    let other = scan::scan(p, &shots, last.ambient, last.window(p));
    let found = verdict(p, &shots, &start, &other, &points, &information);
    Stages { ambient, start, points, information, other, found }
}

#[cfg(test)]
mod tests;
