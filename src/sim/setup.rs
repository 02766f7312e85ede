//! From a scenario to a device: what elaboration, optics and stimuli come to.

pub mod array;
mod converter;
mod detector;
mod effects;
mod elaboration;
mod expectations;
mod fits;
mod instrument;
mod length;
mod notes;
mod pixel_files;
mod recalibration;
mod record;
mod stimulus;
pub mod truth;

use std::sync::Arc;

use crate::error::{Input, Result};
use crate::firmware::carry_chain::Delays;
use crate::firmware::pll::Pll;
use crate::firmware::tdc;
use crate::firmware::tof_top::slot::EstimateWords;
use crate::firmware::tof_top::slotted::Slotted;
use crate::firmware::tof_top::{Params, Pins};
use crate::in_slot;
use crate::kernel::Time;
use crate::network::Network;
use crate::note::Note;
use crate::optics::dark::DarkRates;
use crate::optics::{Bins, Budget};
use crate::scenario::drift::Course;
use crate::scenario::glass::GlassTemplate;
use crate::scenario::mesh::Mesh;
use crate::scenario::{self, Loaded, Scenario};
use crate::sensor::light::Light;
use crate::sensor::streams::Seeds;

use super::device::Device;
use super::disturbance::Disturbance;
use super::estimates::{Clockless, Estimate};
use super::jitter::Jitter;
use super::timeline::Timeline;

use detector::SimulatedRow;
pub(super) use detector::effects;
use pixel_files::PixelFiles;

/// A scenario, ready to run.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The scenario's name.
    pub name: String,
    /// The scenario's values.
    pub scenario: Scenario,
    /// The `key=value` overrides that are in them, as given.
    pub set: Vec<String>,
    /// Notes on keys that were given by a former name.
    renamed: Vec<Note>,
    /// The link budget.
    pub budget: Budget,
    /// Avalanches in the dark.
    #[doc(hidden)]
    pub dark: DarkRates,
    /// Template of the cover window's light, if the estimator has one.
    #[doc(hidden)]
    pub glass: Option<Arc<GlassTemplate>>,
    /// The triangles of the target, if it is a mesh.
    #[doc(hidden)]
    pub mesh: Option<Arc<Mesh>>,
    /// Parameters of the firmware.
    #[doc(hidden)]
    pub params: Params,
    /// The delays that the TDC was calibrated by, if it has drifted since.
    calibrated: Option<Delays>,
    /// The converter as its calibration has it, if it is another.
    known_tdc: Option<tdc::Params>,
    /// Course of the delays over a run, if they change.
    pub(super) course: Option<Course>,
    /// Disturbance of the chain from edge to edge, if there is one.
    disturbance: Option<Disturbance>,
    /// The network in the estimator.
    pub network: Network,
    /// Why no depth of a run can be that of the target, if none can.
    no_depth: Option<Note>,
    pll: Pll,
    /// Light on the SPADs that are on the TDC.
    pub(super) light: Light,
    /// The SPADs that are simulated, if these are more.
    row: Option<SimulatedRow>,
    pub(super) pins: Pins,
    /// Seeds of the random streams: the scenario's, or those of a pixel.
    pub(super) seeds: Seeds,
    /// What files say of an array's pixels.
    pixel_files: Arc<PixelFiles>,
}

impl Setup {
    /// Loads a built-in scenario by name or a file by path, with overrides such as
    /// `target.distance_m=0.3`, and makes it ready to run.
    ///
    /// # Errors
    /// When there is no such scenario, a key or value is wrong, or a file that the scenario names cannot
    /// be read or used.
    pub fn load(name: &str, overrides: &[&str]) -> Result<Self> {
        let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
        Setup::new(scenario::load(name, &overrides)?)
    }

    /// Loads the files that the scenario names, and elaborates it.
    ///
    /// # Errors
    /// When one of the files cannot be read or used, or the estimator is a network for another histogram.
    pub fn new(loaded: Loaded) -> Result<Self> {
        let setup = Setup::of_counts(loaded)?;
        setup.check_estimator()?;
        Ok(setup)
    }

    /// Checks that the network has as many inputs as the histogram has bins.
    ///
    /// # Errors
    /// When it has not.
    pub fn check_network(&self) -> Result<()> {
        let (network, bins) = (&self.network, self.params.histogram.bins);
        if network.fits(&self.params.histogram) {
            return Ok(());
        }
        let expected = format!(
            "it has {} inputs, expected {bins} as tdc.bins says: train one with those keys, or set \
             estimator.kind=centroid",
            network.fixed.bins()
        );
        let source = format!("scenario {}", self.name);
        Err(Input::new(source, expected).field("estimator.network").value(&network.name).into())
    }

    /// Returns the seed of the random streams: the scenario's, or that of the pixel.
    pub fn seed(&self) -> u64 {
        self.seeds.pixel
    }

    /// The clocks.
    pub fn pll(&self) -> &Pll {
        &self.pll
    }

    /// Period of `clk_sys`.
    pub fn cycle(&self) -> Time {
        self.pll.cycle
    }

    /// The device at power-up.
    pub fn device(&self) -> Device {
        let scenario = &self.scenario;
        let rms_ps = scenario.pll.jitter_rms_ps;
        let jitter = (rms_ps > 0.0).then(|| Jitter::new(rms_ps, self.seeds.row));
        let calibrates = self.params.tdc_calibration.is_some();
        let front_end = detector::front_end(scenario, calibrates, self.seed());
        let spads = detector::spads(&scenario.spad, &self.dark, self.row.as_ref(), self.seeds);
        Device::new(
            (self.pins, &self.params),
            self.pll.clone(),
            jitter,
            self.disturbance.clone(),
            self.light_of_row().clone(),
            (spads, front_end),
            Timeline::new(scenario),
        )
    }

    /// Returns the light on all SPADs that are simulated.
    pub(super) fn light_of_row(&self) -> &Light {
        self.row.as_ref().map_or(&self.light, |row| &row.light)
    }

    /// Returns the avalanche times of each code.
    pub fn bins(&self) -> Bins {
        Bins::of_tdc(&self.params.tdc)
    }

    /// Returns the bins of the calibration, which estimators use: without drift since, and without what a code density
    /// could not see.
    pub fn known_bins(&self) -> Bins {
        self.known_tdc.as_ref().map_or_else(|| self.bins(), Bins::of_tdc)
    }

    /// Returns the disturbance of the chain, if there is one: registers that sample at any instant of a set-up window,
    /// or delays that follow conditions.
    #[doc(hidden)]
    pub fn disturbance(&self) -> Option<&Disturbance> {
        self.disturbance.as_ref()
    }

    /// Returns whether the chain has drifted since its calibration.
    pub fn has_drifted(&self) -> bool {
        self.calibrated.is_some()
    }

    /// Returns the delays that the TDC was calibrated by.
    pub fn known_delays(&self) -> &Delays {
        self.calibrated.as_ref().unwrap_or(&self.params.tdc.delays)
    }

    /// Returns the estimate of the firmware's estimator for a histogram, without its clock.
    pub fn estimate(&self, histogram: &[u32]) -> Estimate {
        Estimate::of_words(self.params.estimator, &self.estimate_words(histogram))
    }

    /// Returns the words of that estimate.
    pub fn estimate_words(&self, histogram: &[u32]) -> EstimateWords {
        let p = &self.params;
        in_slot!(p.estimator, E => E::estimate(E::params(p), histogram))
    }
}
