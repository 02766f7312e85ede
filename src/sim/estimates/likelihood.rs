//! Maximum likelihood without a clock: in integers, bit for bit what
//! [`likelihood_estimator`](crate::firmware::likelihood_estimator) computes, and in double precision.
//!
//! The algorithm is one text over a [`Number`] and what is known of an [`Instrument`] in such numbers.

mod histogram;
mod instrument;
mod number;
mod point;
mod scan;
mod step;
mod sums;
mod targets;
mod terms;
mod verdict;

use crate::firmware::likelihood_estimator::LikelihoodEstimator;
use crate::firmware::likelihood_estimator::params::Params;
use crate::firmware::likelihood_estimator::targets::Targets;
use crate::firmware::likelihood_estimator::words::{GLASS_STEPS, STEPS};
use crate::firmware::tof_top::slot::EstimateWords;

use super::Clockless;

use histogram::Shots;
use scan::scan;
use step::step;
use verdict::{Judged, verdict};

pub use histogram::{Ambient, Block};
pub use instrument::Instrument;
pub use number::Number;
pub use point::{Echo, Point};
pub use scan::Best;
pub use step::Information;
pub use targets::Turns;
pub use verdict::{Found, Second};

/// An estimate with its intermediate results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trace<N> {
    /// Ambient light by blocks of bins.
    pub ambient: Ambient<N>,
    /// The highest place of the box.
    pub start: Best<N>,
    /// First point of the fit.
    pub begin: Point<N>,
    /// The point and the information of each step.
    pub steps: [(Point<N>, Information<N>); STEPS],
    /// The highest place of the box outside of the fit.
    pub other: Best<N>,
    /// The result.
    pub found: Found<N>,
    /// The solver's flags: log S is not known to a quarter, to a fifth; nor mu to the pulse's deviation; the arrival is
    /// next to the begin of the window, to its end; the last step was long, to the left, to the right.
    pub flags: [bool; 7],
    /// Shots that wait at the first bin of the fit, if it has one.
    pub waiting: Option<N>,
    /// Two echoes in turn, if a second target is looked for.
    pub turns: Option<Turns<N>>,
}

impl Clockless for LikelihoodEstimator {
    fn targets(p: &Params) -> Targets {
        p.targets
    }

    fn estimate(p: &Params, histogram: &[u32]) -> EstimateWords {
        estimate(p, histogram).words()
    }
}

/// Estimates the depth of a histogram in integers.
pub fn estimate(p: &Params, histogram: &[u32]) -> Found {
    trace(p, histogram).found
}

/// Estimates the depth of a histogram, and returns each stage's result.
pub fn trace<I: Instrument>(p: &I, histogram: &[u32]) -> Trace<I::Number> {
    let shots = Shots::new(p, histogram);
    let ambient = shots.ambient(p);
    let mut dark = Point::dark(ambient.hazard, I::Number::whole(p.words().glass.light));
    if p.has_glass() {
        for _ in 0..GLASS_STEPS {
            dark = step(p, &shots, &dark).0;
        }
    }
    let start = scan(p, &shots, &dark, 0..0);
    let begin = start.start(p, &dark);
    let (mut point, mut information) = (begin, Information::default());
    let steps = std::array::from_fn(|_| {
        (point, information) = step(p, &shots, &point);
        (point, information)
    });
    let other = if p.words().has_more_light() {
        scan(p, &shots, &point, 0..0)
    } else {
        scan(p, &shots, &Point::dark(point.ambient, point.glass), p.window(point.arrival))
    };
    let with = |Judged { found, flags, waiting, .. }, turns| Trace {
        ambient,
        start,
        begin,
        steps,
        other,
        found,
        flags,
        waiting,
        turns,
    };
    if !p.words().has_second() {
        return with(verdict(p, &shots, [&start, &other], &point, &information), None);
    }
    let (judged, turns) = targets::find(p, &shots, [&start, &other], &point, &information);
    with(judged, Some(turns))
}

#[cfg(test)]
mod tests;
