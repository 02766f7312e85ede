//! Elaborates a scenario's keys and files into firmware, optics and light.

use std::sync::Arc;

use crate::error::{Input, Result};
use crate::firmware::pll::Pll;
use crate::firmware::tof_top::estimator_params::EstimatorParams;
use crate::firmware::tof_top::{FirmwareEstimator, HistogramSource, Params};
use crate::firmware::{centroid_estimator, frame_ctrl, histogram_builder, vcsel_driver};
use crate::kernel::pulse::Pulse;
use crate::kernel::scan::Scan;
use crate::kernel::{S, Time, U};
use crate::network::Network;
use crate::optics::Budget;
use crate::optics::dark::DarkRates;
use crate::scenario::builtin::Source;
use crate::scenario::dark::Measured;
use crate::scenario::mesh::Mesh;
use crate::scenario::wiring::Wiring;
use crate::scenario::{self, Array, Loaded, MOST_SEED, Scenario, dark, glass, mesh, pulse};
use crate::sim::timeline::pins_at_power_up;

use super::converter::Converter;
use super::detector::{SimulatedRow, by_budget};
use super::stimulus::stimulus;
use super::{Setup, fits, recalibration};

impl Setup {
    /// Loads the files that the scenario names, and elaborates it, for histograms without depths: unlike
    /// [`Setup::new`], it accepts a network for another histogram.
    ///
    /// # Errors
    /// When one of the files cannot be read or used, or the scenario has an array of several pixels.
    pub fn of_counts(loaded: Loaded) -> Result<Self> {
        let Array { rows, columns, banks, .. } = loaded.scenario.array;
        for (key, count) in
            [("array.rows", rows), ("array.columns", columns), ("array.banks", banks)]
        {
            if count > 1 {
                let expected = "expected 1 here: `tofsim image` simulates arrays, `tofsim run --pixel` one of the \
                                pixels";
                let fault = Input::new(format!("scenario {}", loaded.name), expected);
                return Err(fault.field(key).value(count).into());
            }
        }
        Setup::elaborated(loaded, Budget::of_scene)
    }

    /// Elaborates a scenario with the budget that `budget` computes from it, its pulse and its mesh.
    pub(super) fn elaborated(
        loaded: Loaded,
        budget: impl FnOnce(&Scenario, Pulse, Option<&Mesh>) -> Budget,
    ) -> Result<Self> {
        let Loaded { name, scenario, set, files, renamed } = loaded;
        check_seed(&name, scenario.seed)?;
        let network = network(&scenario, &files)?;
        let pll = Pll::new(&scenario.pll.params());
        let histogram = scenario.histogram();
        let converter = Converter::new(&scenario, &files, pll.cycle)?;
        let (code_source, histogram_source, light) = stimulus(&scenario, &files, &histogram)?;
        let measured = dark::load(&scenario, &files)?;
        let of_row = measured.as_ref().map(Measured::selected);
        let (dark, wiring) = (DarkRates::new(&scenario.spad, of_row), Wiring::of(&scenario.spad));
        let pulse = pulse::load(&scenario.laser, &files)?;
        let glass = glass::load(&scenario.estimator, &files)?;
        let mesh = mesh::load(&scenario.target, &files)?;
        let budget = budget(&scenario, pulse, mesh.as_deref()).with_dark_rates(&dark);
        let row = (light.is_none() && wiring.has_unwired()).then(|| {
            let light = by_budget(&budget.of_row(&wiring, &dark), scenario.seed);
            SimulatedRow { light: Arc::new(light), wiring }
        });
        let light = light.unwrap_or_else(|| by_budget(&budget, scenario.seed));
        let mut estimators = EstimatorParams::of(&histogram);
        estimators.centroid_estimator = Arc::new(centroid(&scenario.estimator, histogram));
        if network.fits(&histogram) {
            estimators.depth_estimator = Arc::new(network.params(&histogram));
        }
        let preloaded = matches!(histogram_source, HistogramSource::Preload(_));
        let params = Params {
            histogram,
            frame_ctrl: frame_ctrl(&scenario.firmware, histogram, preloaded),
            vcsel_driver: vcsel_driver(&scenario.firmware),
            tdc: converter.tdc,
            channels: Vec::new(),
            tdc_calibration: converter.tdc_calibration,
            estimators,
            estimator: scenario.estimator.kind,
            code_source,
            histogram_source,
            is_hosted: false,
        };
        let (pins, no_depth) = (pins_at_power_up(&scenario.firmware), None);
        let seeds = scenario.seed.into();
        let mut setup = Setup {
            name,
            scenario,
            set,
            renamed,
            budget,
            dark,
            glass,
            mesh,
            params,
            calibrated: converter.calibrated,
            known_tdc: converter.known,
            course: converter.course,
            disturbance: converter.disturbance,
            network,
            pll,
            light,
            row,
            pins,
            no_depth,
            seeds,
            pixel_files: Arc::default(),
        };
        setup.check_fits()?;
        let shots = setup.params.frame_ctrl.shots_per_frame.into();
        // One that the estimator is not for has a stand-in, which nothing starts.
        if let Ok(own) = setup.likelihood(shots) {
            setup.params.estimators.likelihood_estimator = Arc::new(own);
        }
        Ok(Setup { no_depth: setup.why_no_depth(), ..setup })
    }
}

impl Setup {
    /// Checks that the estimator and its template of a cover window fit the instrument.
    pub fn check_estimator(&self) -> Result<()> {
        if let Some(glass) = &self.glass {
            let bins = self.known_bins();
            glass.check(&bins.limits_ps(), bins.bin_ps())?;
        }
        match self.params.estimator {
            FirmwareEstimator::Network => self.check_network(),
            FirmwareEstimator::LikelihoodEstimator => {
                self.likelihood(self.params.frame_ctrl.shots_per_frame.into())?;
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Checks that the parts fit each other, with the longest delays that the chain has in a run.
    pub(super) fn check_fits(&self) -> Result<()> {
        let Setup { name, scenario, params, .. } = self;
        fits::check(name, params)?;
        let slowest = self.course.as_ref().map_or(1.0, |course| course.slowest);
        let longest = params.tdc.delays.longest().fs() as f64 * slowest;
        fits::check_pulses(name, scenario, Time::from_fs(longest.ceil() as u64))?;
        match params.tdc_calibration {
            Some(_) => {
                fits::check_ring(name, &recalibration::ring(&scenario.tdc), &params.tdc, slowest)
            }
            None => Ok(()),
        }
    }
}

fn check_seed(name: &str, seed: u64) -> Result<()> {
    if seed <= MOST_SEED {
        return Ok(());
    }
    let fault = Input::new(format!("scenario {name}"), format!("expected 0 to {MOST_SEED}"));
    Err(fault.field("seed").value(seed).into())
}

fn network(scenario: &Scenario, files: &Source) -> Result<Network> {
    let folder = match files {
        Source::BuiltIn => None,
        Source::Folder(folder) => Some(folder.as_path()),
    };
    Network::find(&scenario.estimator.network, folder)
}

fn frame_ctrl(
    keys: &scenario::Firmware,
    histogram: histogram_builder::Params,
    preloaded: bool,
) -> frame_ctrl::Params {
    let shots_per_frame = keys.shots_of_a_frame() as u32;
    let drain_cycles = keys.drain_cycles;
    let scan = Scan::default();
    frame_ctrl::Params { shots_per_frame, histogram, preloaded, drain_cycles, scan }
}

fn vcsel_driver(keys: &scenario::Firmware) -> vcsel_driver::Params {
    let (periods, pulse_half_cycles) = (keys.laser_periods.clone(), keys.pulse_half_cycles);
    vcsel_driver::Params { periods, pulse_half_cycles }
}

/// The scale's words round half away from zero.
fn centroid(
    keys: &scenario::Estimator,
    histogram: histogram_builder::Params,
) -> centroid_estimator::Params {
    let word = |value: f64, fraction: u32| (value * (1u64 << fraction) as f64).round() as i64;
    centroid_estimator::Params {
        histogram,
        half_width: keys.centroid_half_width,
        background: keys.centroid_background,
        slope: U::new(word(keys.centroid_slope_m, centroid_estimator::SLOPE_FRACTION) as u64),
        offset: S::new(word(keys.centroid_offset_m, 29)),
    }
}
