//! The likelihood estimator read as a formula: the same stages in double precision, written without a look at
//! how words are rounded.

use tofsim::firmware::likelihood_estimator::words::{LEAST_WAITING, STEPS};
use tofsim::firmware::tof_top::status::{Status, StatusSet};

use super::model::Model;
use super::scan::{Best, scan};
use super::shots::{Ambient, Shots};
use super::step::{Information, Point, step};

/// Squared deviations that an echo has at least, one that is sure, and another one.
const LEAST_SCORE: f64 = 25.0;
const SURE_SCORE: f64 = 100.0;
const ANOTHER_SCORE: f64 = 36.0;
/// Largest variance of log S, and with a score that is not sure.
const MOST_VARIANCE: f64 = 1.0 / 16.0;
const MOST_UNSURE: f64 = 1.0 / 25.0;
/// A residual of so many squared deviations is no chance.
const FAR: f64 = 25.0;

/// An estimate, and all that it comes by.
#[derive(Clone, Debug)]
pub struct Twin {
    /// Ambient light found in the blocks of bins.
    pub ambient: Ambient,
    /// The highest place of the box.
    pub start: Best,
    /// Start of the fit.
    pub begin: Point,
    /// Point after each step, and the information used for it.
    pub steps: [(Point, Information); STEPS],
    /// The highest place of the box outside of the fit.
    pub other: Best,
    /// Depth of the target [m].
    pub depth_m: f64,
    /// Its standard deviation [m].
    pub sigma_m: f64,
    /// Sum of squared residuals over their variances, a quarter of a count more [1].
    pub chi_square: f64,
    /// Reasons to reject the depth.
    pub status: StatusSet,
}

impl Twin {
    /// Of a histogram.
    pub fn new(model: &Model, histogram: &[u32]) -> Self {
        let shots = Shots::new(model, histogram);
        let ambient = shots.ambient(model);
        let start = scan(model, &shots, ambient.hazard, &(0..0));
        let begin = Point::start(model, &start, ambient.hazard);
        let (mut point, mut information) = (begin, Information::default());
        let steps = std::array::from_fn(|_| {
            (point, information) = step(model, &shots, &point);
            (point, information)
        });
        let window = model.window(point.arrival_ps);
        let other = scan(model, &shots, point.ambient, &window);
        let terms = point.terms(model, &shots);
        let square = |over: f64| {
            let each = move |(terms, _): &(super::shots::Terms, f64)| {
                terms.residual * terms.residual / (terms.weight + over)
            };
            terms.iter().map(each)
        };
        let sigma_ps = information.variance_ps2.sqrt();
        let margin_ps = model.sigma_ps / 2.0;
        let used_up = window
            .clone()
            .find(|&bin| model.width(bin) > 0.0)
            .is_some_and(|bin| shots.waiting[bin] < LEAST_WAITING as f64);
        let variance = information.variance_of_log;
        let no_echo = variance > MOST_VARIANCE
            || variance > MOST_UNSURE && start.score < SURE_SCORE
            || start.score < LEAST_SCORE
            || sigma_ps > model.sigma_ps;
        let reasons = [
            (no_echo, Status::NoEcho),
            (
                point.arrival_ps < margin_ps || model.end_ps() - point.arrival_ps < margin_ps,
                Status::CutOff,
            ),
            (used_up, Status::UsedUp),
            (other.score > ANOTHER_SCORE, Status::Another),
            (information.cut > 0 || information.move_ps.abs() > 2.0 * sigma_ps, Status::NotSettled),
            (square(1.0).take(window.len()).any(|square| square > FAR), Status::NoFit),
        ];
        Twin {
            depth_m: (point.arrival_ps - model.delay_ps) * model.metres_per_ps,
            sigma_m: sigma_ps * model.metres_per_ps,
            chi_square: square(0.25).sum(),
            status: StatusSet::of(&reasons),
            ambient,
            start,
            begin,
            steps,
            other,
        }
    }
}
