//! Depth errors while the die heats up: with a TDC calibrated once, and calibrated repeatedly.
//!
//! The conditions are constant within a frame, because a die takes seconds for a degree. Both calibrations are exact
//! when they are made, and use the same random numbers at each moment.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use serde::Serialize;

use tofsim::error::{Input, Result, poll_stop};
use tofsim::scenario::Loaded;
use tofsim::scenario::drift::{Moment, Profile};
use tofsim::sim::setup::Setup;

use crate::dataset::{HistogramSource, Scene};
use crate::estimation::{EstimatorInputs, EstimatorKind, Needs};
use crate::evaluation::Spread;

/// Computation at each moment of a profile.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Estimator of the depths.
    pub kind: EstimatorKind,
    /// From one calibration to the next [s].
    pub every_s: f64,
    /// Histograms at each moment, of each calibration.
    pub repeats: u64,
}

/// The depths over time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Drift {
    /// Name of the estimator on the command line.
    pub estimator: &'static str,
    /// From one calibration to the next [s].
    pub every_s: f64,
    /// Histograms at each moment, of each calibration.
    pub repeats: u64,
    /// In the order of the profile.
    pub points: Vec<Point>,
}

/// The depths at one moment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Point {
    /// When, and in which conditions.
    #[serde(flatten)]
    pub moment: Moment,
    /// When the TDC was calibrated last, where that is done again [s].
    pub calibrated_s: f64,
    /// Errors with the calibration of the first moment.
    pub once: Spread,
    /// Errors with the last of the calibrations that are made again.
    pub repeated: Spread,
}

impl Drift {
    /// Draws the histograms of a scenario at each moment of a profile, and lets the estimator see them, on all
    /// threads of the current pool. `done` hears of histograms as they are done.
    ///
    /// # Errors
    /// When the chain does not fit the clock at one of the temperatures, the estimator or the histograms cannot
    /// be made for the scenario, or it is stopped.
    pub fn new(
        loaded: &Loaded,
        profile: &Profile,
        plan: Plan,
        stop: Option<&AtomicBool>,
        done: impl Fn(u64) + Sync,
    ) -> Result<Self> {
        let Plan { kind, every_s, repeats } = plan;
        if kind.needs() == Needs::Dark {
            let expected = "expected one that needs no dark histograms";
            return Err(Input::new("--estimator", expected).value(kind.name()).into());
        }
        let (moments, begin) = (profile.moments(), profile.moments()[0]);
        let point = |(index, &moment): (usize, &Moment)| {
            poll_stop(stop)?;
            let rounds = ((moment.time_s - begin.time_s) / every_s).floor();
            let last = profile.at(begin.time_s + rounds * every_s);
            let rows = index as u64 * repeats..(index as u64 + 1) * repeats;
            let of = |then: Moment| {
                let spread = spread(loaded, kind, (moment, then), rows.clone());
                done(repeats);
                spread
            };
            Ok(Point { moment, calibrated_s: last.time_s, once: of(begin)?, repeated: of(last)? })
        };
        let points = moments.par_iter().enumerate().map(point).collect::<Result<_>>()?;
        Ok(Drift { estimator: kind.name(), every_s, repeats, points })
    }
}

/// Errors of an instrument in conditions `now` that was calibrated in conditions `then`.
fn spread(
    loaded: &Loaded,
    kind: EstimatorKind,
    (now, then): (Moment, Moment),
    rows: std::ops::Range<u64>,
) -> Result<Spread> {
    let mut loaded = loaded.clone();
    let tdc = &mut loaded.scenario.tdc;
    (tdc.temperature_c, tdc.supply_mv) = (now.temperature_c, now.supply_mv);
    (tdc.calibrated_at_c, tdc.calibrated_at_mv) = (Some(then.temperature_c), Some(then.supply_mv));
    let setup = Setup::of_counts(loaded)?;
    kind.check(&setup)?;
    let source = HistogramSource::new(&setup)?;
    let acquisition = source.acquisition(0);
    let needs = EstimatorInputs { acquisition, network: &setup.network, setup: &setup };
    let estimator = kind.estimator(&needs)?;
    let scenario = &setup.scenario;
    let scene = Scene {
        distance_m: scenario.target.distance_m,
        reflectance: scenario.target.reflectance,
        irradiance_w_m2_nm: scenario.ambient.irradiance_w_m2_nm,
        ..Scene::default()
    };
    let codes = source.probabilities(&scene);
    let errors_m = rows.map(|row| {
        let histogram = source.draw_from(&codes, &scene, scenario.seed, row);
        estimator.estimate(&histogram).ok().map(|depth_m| depth_m - scene.distance_m)
    });
    Ok(Spread::of(errors_m))
}

#[cfg(test)]
mod tests;
