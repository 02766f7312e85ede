//! Source of histograms: the optics, chain and frame of a scenario, in closed form.
//!
//! The thesis's bins, edges every 25 ps and no chain, are those of profile `ideal` to the femtosecond: two taps of
//! 12.5 ps to a bin.

use std::sync::Arc;

use tofsim::error::{Input, Result};
use tofsim::firmware::histogram_builder;
use tofsim::kernel::pulse::Pulse;
use tofsim::network::Histogram;
use tofsim::optics::dark::DarkRates;
use tofsim::optics::{BinProbabilities, Bins, Budget, Hazard};
use tofsim::scenario::Scenario;
use tofsim::scenario::glass::GlassTemplate;
use tofsim::scenario::mesh::Mesh;
use tofsim::sensor::streams::{self, stream};
use tofsim::sim::fast::histogram::independent_shots;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;

use crate::estimation::Acquisition;

use super::grid::Scene;

/// Draws histograms of any scene, all else being as a scenario has it, or as one of several has it.
#[derive(Clone, Debug)]
pub struct HistogramSource {
    settings: Vec<Setting>,
}

/// A scenario, whose scene does not matter, and its chains.
#[derive(Clone, Debug)]
struct Setting {
    scenario: Scenario,
    /// The chain of each column of an array whose columns have chains of their own, or else the only one.
    chains: Vec<Chain>,
    pulse: Pulse,
    dark: DarkRates,
    glass: Option<Arc<GlassTemplate>>,
    mesh: Option<Arc<Mesh>>,
    /// The array whose pixels the scenes are, if there are several.
    array: Option<Arc<ArraySetup>>,
}

/// A carry chain.
#[derive(Clone, Debug)]
struct Chain {
    bins: Bins,
    /// Bins that estimators assume.
    known_bins: Bins,
}

impl HistogramSource {
    /// With the optics, chain and shots of `setup`; its own scene does not matter.
    ///
    /// # Errors
    /// When its histograms have no closed form: see [`independent_shots`].
    pub fn new(setup: &Setup) -> Result<Self> {
        Ok(HistogramSource { settings: vec![Setting::new(setup)?] })
    }

    /// The same for each setting of a grid's other keys, in their order; one at least.
    ///
    /// # Errors
    /// When the histograms of one have no closed form.
    pub fn of_settings(setups: &[Setup]) -> Result<Self> {
        HistogramSource::of(setups.iter().map(Setting::new).collect::<Result<_>>()?)
    }

    /// The same of the pixels of an array, in each setting.
    ///
    /// # Errors
    /// As [`HistogramSource::of_settings`].
    pub fn of_arrays(arrays: &[Arc<ArraySetup>]) -> Result<Self> {
        let setting = |array: &Arc<ArraySetup>| {
            let chains = array.columns().iter().map(Chain::new).collect::<Result<_>>()?;
            Ok(Setting { chains, array: Some(array.clone()), ..Setting::new(array.common())? })
        };
        HistogramSource::of(arrays.iter().map(setting).collect::<Result<_>>()?)
    }

    fn of(settings: Vec<Setting>) -> Result<Self> {
        let Some(first) = settings.first() else {
            return Err(Input::new("grid", "expected one setting at least").into());
        };
        let bins = first.scenario.tdc.bins;
        if let Some(other) = settings.iter().find(|setting| setting.scenario.tdc.bins != bins) {
            let expected = format!("expected {bins} for all: histograms of a grid are of one size");
            let fault = Input::new("--grid", expected).field("tdc.bins");
            return Err(fault.value(other.scenario.tdc.bins).into());
        }
        Ok(HistogramSource { settings })
    }

    fn setting(&self, scene: &Scene) -> &Setting {
        &self.settings[scene.setting]
    }

    /// Shots of a histogram; of the first setting.
    pub fn shots(&self) -> u32 {
        self.settings[0].shots()
    }

    /// Shots of a histogram, where all settings have equally many.
    pub fn shots_of_all(&self) -> Option<u32> {
        let same = self.settings.iter().all(|setting| setting.shots() == self.shots());
        same.then(|| self.shots())
    }

    /// Shots of a scene's histogram.
    pub fn shots_of(&self, scene: &Scene) -> u32 {
        self.setting(scene).shots()
    }

    /// The scenario, with the scene that was not asked for; of the first setting.
    pub fn scenario(&self) -> &Scenario {
        &self.settings[0].scenario
    }

    /// The scenarios of all settings.
    pub fn scenarios(&self) -> impl Iterator<Item = &Scenario> {
        self.settings.iter().map(|setting| &setting.scenario)
    }

    /// The array whose pixels the scenes are, if there are several; in the first setting.
    pub fn array(&self) -> Option<&ArraySetup> {
        self.settings[0].array.as_deref()
    }

    /// Whether the laser is on; in the first setting.
    pub fn is_lit(&self) -> bool {
        self.scenario().firmware.laser_en
    }

    /// Whether the laser is on in a scene's setting.
    pub fn is_lit_in(&self, scene: &Scene) -> bool {
        self.setting(scene).scenario.firmware.laser_en
    }

    /// The bins of the scenario's chain, or of the first column's; of the first setting.
    pub fn bins(&self) -> &Bins {
        &self.settings[0].chains[0].bins
    }

    /// Returns the size of the histograms.
    pub fn size(&self) -> histogram_builder::Params {
        self.scenario().histogram()
    }

    /// Returns the acquisition of the histograms of a setting, with the chain of an array's first column.
    pub fn acquisition(&self, setting: usize) -> Acquisition<'_> {
        self.acquisition_of(&Scene { setting, ..Scene::default() })
    }

    /// Returns the acquisition of a scene's histograms.
    pub fn acquisition_of(&self, scene: &Scene) -> Acquisition<'_> {
        let setting = self.setting(scene);
        let Setting { scenario, pulse, glass, .. } = setting;
        let known_bins = &setting.chain(scene).known_bins;
        let shots = scenario.firmware.shots_per_frame;
        let delay_ps = scenario.laser.delay_ps;
        let glass = glass.as_deref();
        Acquisition { delay_ps, glass, ..Acquisition::new(known_bins, shots, pulse) }
    }

    /// Budget of a white target at a scene's distance, or of a pixel of an array, in an irradiance of 1 W/m^2/nm: what all
    /// scenes at that distance have in common, and what takes longest to find.
    pub fn white(&self, scene: &Scene) -> Budget {
        let Setting { scenario, pulse, dark, mesh, array, .. } = self.setting(scene);
        if let Some(array) = array {
            let [_, columns] = array.size();
            return array.white(scene.pixel / columns, scene.pixel % columns);
        }
        let mut scenario = scenario.clone();
        scenario.target.distance_m = scene.distance_m;
        scenario.target.reflectance = 1.0;
        scenario.ambient.irradiance_w_m2_nm = 1.0;
        Budget::of_scene(&scenario, pulse.clone(), mesh.as_deref()).with_dark_rates(dark)
    }

    /// Probability of each code in one shot.
    pub fn probabilities(&self, scene: &Scene) -> BinProbabilities {
        self.probabilities_with(&self.white(scene), scene, self.is_lit_in(scene))
    }

    /// The same where the [white target's budget](HistogramSource::white) at the scene's distance is known,
    /// with the laser on or off, whatever the scenario says.
    pub fn probabilities_with(&self, white: &Budget, scene: &Scene, lit: bool) -> BinProbabilities {
        let budget = scaled(white, scene);
        let hazard = if lit { Hazard::new(&budget) } else { Hazard::dark(&budget) };
        BinProbabilities::new(&hazard, &self.setting(scene).chain(scene).bins)
    }

    /// The histogram of a scene's row, where the probabilities are known.
    pub fn draw_from(
        &self,
        codes: &BinProbabilities,
        scene: &Scene,
        seed: u64,
        row: u64,
    ) -> Histogram {
        let mut random = stream(seed, streams::Source::Dataset, row);
        // A count is at most the number of shots.
        let counts = codes.draw(self.shots_of(scene).into(), &mut random);
        counts.into_iter().map(|count| count as u32).collect()
    }
}

impl Setting {
    fn new(setup: &Setup) -> Result<Self> {
        let chains = vec![Chain::new(setup)?];
        if setup.has_pairs() {
            let expected = "expected false: a dataset's histograms are drawn one by one";
            let fault = Input::new(format!("scenario {}", setup.name), expected);
            return Err(fault.field("firmware.dark_frames").value(true).into());
        }
        let (scenario, pulse) = (setup.scenario.clone(), setup.budget.pulse.clone());
        let (dark, glass, mesh) = (setup.dark.clone(), setup.glass.clone(), setup.mesh.clone());
        Ok(Setting { scenario, chains, pulse, dark, glass, mesh, array: None })
    }

    /// Returns the chain of a scene's pixel.
    fn chain(&self, scene: &Scene) -> &Chain {
        &self.chains[scene.pixel % self.chains.len()]
    }

    fn shots(&self) -> u32 {
        self.scenario.firmware.shots_per_frame as u32
    }
}

impl Chain {
    fn new(setup: &Setup) -> Result<Self> {
        independent_shots(setup, "a dataset")?;
        Ok(Chain { bins: setup.bins(), known_bins: setup.known_bins() })
    }
}

/// Budget of a scene from that of the white target at its distance.
pub fn scaled(white: &Budget, scene: &Scene) -> Budget {
    white.of_white(scene.reflectance, scene.irradiance_w_m2_nm)
}

#[cfg(test)]
mod tests;
