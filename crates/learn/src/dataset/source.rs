//! Where histograms come from: the optics, chain and frame of a scenario, in closed form.
//!
//! The thesis's bins, edges every 25 ps and no chain, are those of profile `ideal` to the
//! femtosecond: two taps of 12.5 ps to a bin.

use tofsim::error::{Input, Result};
use tofsim::network::Histogram;
use tofsim::optics::{BinProbabilities, Bins, Budget, Hazard};
use tofsim::scenario::Scenario;
use tofsim::sensor::streams::{self, stream};
use tofsim::sim::fast::histogram::independent_shots;
use tofsim::sim::setup::{CYCLE, Setup};

use crate::estimation::Acquisition;

use super::grid::Scene;

/// Draws histograms of any scene, all else being as a scenario has it, or as one of several has it.
#[derive(Clone, Debug)]
pub struct HistogramSource {
    settings: Vec<Setting>,
}

/// A scenario, whose scene does not matter, and its chain.
#[derive(Clone, Debug)]
struct Setting {
    scenario: Scenario,
    bins: Bins,
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
        let settings = setups.iter().map(Setting::new).collect::<Result<Vec<_>>>()?;
        match settings.is_empty() {
            true => Err(Input::new("grid", "expected one setting at least").into()),
            false => Ok(HistogramSource { settings }),
        }
    }

    fn setting(&self, scene: &Scene) -> &Setting {
        &self.settings[scene.setting]
    }

    /// Shots of a histogram, 65,535 at most; of the first setting.
    pub fn shots(&self) -> u16 {
        self.settings[0].shots()
    }

    /// Shots of a histogram, where all settings have equally many.
    pub fn shots_of_all(&self) -> Option<u16> {
        let same = self.settings.iter().all(|setting| setting.shots() == self.shots());
        same.then(|| self.shots())
    }

    /// Shots of a scene's histogram, 65,535 at most.
    pub fn shots_of(&self, scene: &Scene) -> u16 {
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

    /// Whether the laser is on; in the first setting.
    pub fn is_lit(&self) -> bool {
        self.scenario().firmware.laser_en
    }

    /// Whether the laser is on in a scene's setting.
    pub fn is_lit_in(&self, scene: &Scene) -> bool {
        self.setting(scene).scenario.firmware.laser_en
    }

    /// The bins of the scenario's chain; of the first setting.
    pub fn bins(&self) -> &Bins {
        &self.settings[0].bins
    }

    /// How the histograms of a setting come about.
    pub fn acquisition(&self, setting: usize) -> Acquisition<'_> {
        let Setting { scenario, bins } = &self.settings[setting];
        let shots = scenario.firmware.shots_per_frame;
        Acquisition::new(bins, shots, scenario.laser.pulse_sigma_ps)
    }

    /// Budget of a white target at a scene's distance, in an irradiance of 1 W/m^2/nm: what all scenes at
    /// that distance have in common, and what takes longest to find.
    pub fn white(&self, scene: &Scene) -> Budget {
        let mut scenario = self.setting(scene).scenario.clone();
        scenario.target.distance_m = scene.distance_m;
        scenario.target.reflectance = 1.0;
        scenario.ambient.irradiance_w_m2_nm = 1.0;
        Budget::new(&scenario)
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
        BinProbabilities::new(&hazard, &self.setting(scene).bins)
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
        // A count is at most the number of shots, which 16 bits hold.
        codes.draw(self.shots_of(scene).into(), &mut random).map(|count| count as u16)
    }
}

impl Setting {
    fn new(setup: &Setup) -> Result<Self> {
        independent_shots(setup, "a dataset")?;
        if setup.has_pairs() {
            let expected = "expected false: a dataset's histograms are drawn one by one";
            let fault = Input::new(format!("scenario {}", setup.name), expected);
            return Err(fault.field("firmware.dark_frames").value(true).into());
        }
        let tdc = &setup.params.tdc;
        let bins = Bins::of_chain(&tdc.delays, &tdc.cal, CYCLE);
        Ok(Setting { scenario: setup.scenario.clone(), bins })
    }

    fn shots(&self) -> u16 {
        self.scenario.firmware.shots_per_frame as u16
    }
}

/// Budget of a scene from that of the white target at its distance: signal is proportional to reflectance (eq. 3.13), ambient light to reflectance
/// and irradiance (eq. 3.19 and 3.20).
pub fn scaled(white: &Budget, scene: &Scene) -> Budget {
    Budget {
        signal_per_shot: white.signal_per_shot * scene.reflectance,
        ambient_rate_hz: white.ambient_rate_hz * scene.reflectance * scene.irradiance_w_m2_nm,
        ..*white
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::distribution::{ChiSquared, ContinuousCDF};
    use tofsim::kernel::Time;
    use tofsim::scenario;

    fn source(overrides: &[&str]) -> Result<HistogramSource> {
        let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
        HistogramSource::new(&Setup::new(scenario::load("kc705", &overrides)?)?)
    }

    const SCENE: Scene =
        Scene { distance_m: 0.3, reflectance: 0.34, irradiance_w_m2_nm: 0.2, setting: 0 };

    #[test]
    fn the_bins_of_the_ideal_chain_are_those_of_the_thesis() {
        let source = source(&["tdc.profile=ideal"]).unwrap();
        let spans = source.bins().spans();
        assert_eq!(spans.len(), 256);
        // An avalanche on a tap's border is seen by that tap: bins begin a femtosecond late.
        let edge = |k: usize| Time::from_fs(25_000 * k as u64 + u64::from(k > 0));
        for (k, span) in spans.iter().enumerate() {
            assert_eq!((span.from, span.until, span.code), (edge(k), edge(k + 1), k as u8));
        }
    }

    #[test]
    fn the_mean_histogram_has_the_probabilities() {
        let source = source(&[]).unwrap();
        let codes = source.probabilities(&SCENE);
        let rows = 400;
        let mut sums = [0u64; 256];
        for row in 0..rows {
            let histogram = source.draw_from(&codes, &SCENE, 5, row);
            sums.iter_mut().zip(histogram).for_each(|(sum, count)| *sum += u64::from(count));
        }
        let shots = f64::from(source.shots()) * rows as f64;
        let missed = shots - sums.iter().sum::<u64>() as f64;
        let expected_missed = shots * (1.0 - codes.of_code().iter().sum::<f64>());
        let cells = sums.iter().zip(codes.of_code()).map(|(&sum, p)| (sum as f64, shots * p));
        let cells = cells.chain([(missed, expected_missed)]).filter(|cell| cell.1 >= 5.0);
        let term = |(found, expected): (f64, f64)| (found - expected).powi(2) / expected;
        let chi2: f64 = cells.clone().map(term).sum();
        let freedom = cells.count() as f64 - 1.0;
        let level = 1.0 - ChiSquared::new(freedom).unwrap().cdf(chi2);
        assert!(level > 0.001, "chi2 {chi2} of {freedom}, level {level}");
    }

    #[test]
    fn rows_vary_as_independent_multinomial_draws_do() {
        let source = source(&["firmware.shots_per_frame=5000"]).unwrap();
        let codes = source.probabilities(&SCENE);
        let (mut chi2, mut freedom) = (0.0, 0.0);
        for row in 0..200 {
            for (&count, p) in source.draw_from(&codes, &SCENE, 1, row).iter().zip(codes.of_code())
            {
                let expected = 5000.0 * p;
                if expected >= 5.0 {
                    chi2 += (f64::from(count) - expected).powi(2) / (expected * (1.0 - p));
                    freedom += 1.0;
                }
            }
        }
        // Bins of a row hardly depend on one another; 4.5 sigma of chi2.
        let deviation = (chi2 - freedom) / (2.0 * freedom).sqrt();
        assert!(deviation.abs() < 4.5, "chi2 {chi2} of {freedom}");
    }

    #[test]
    fn a_scene_is_what_the_scenario_with_its_values_gives() {
        let other = source(&["target.distance_m=0.1", "ambient.irradiance_w_m2_nm=0"]).unwrap();
        let own = source(&["target.distance_m=0.3"]).unwrap();
        assert_eq!(other.probabilities(&SCENE), own.probabilities(&SCENE));
        let dark = source(&["firmware.laser_en=false"]).unwrap().probabilities(&SCENE);
        assert!(dark.of_code()[80] < 0.5 * own.probabilities(&SCENE).of_code()[80]);
    }

    #[test]
    fn the_budget_is_that_of_the_scenario_in_either_ambient_model() {
        for model in ["fitted", "physical"] {
            let mut scenario =
                source(&[&format!("ambient.model={model}")]).unwrap().scenario().clone();
            scenario.target.distance_m = 0.6;
            scenario.target.reflectance = 0.37;
            scenario.ambient.irradiance_w_m2_nm = 0.35;
            let expected = Budget::new(&scenario);
            let scene =
                Scene { distance_m: 0.6, reflectance: 0.37, irradiance_w_m2_nm: 0.35, setting: 0 };
            let source = source(&[&format!("ambient.model={model}")]).unwrap();
            let found = scaled(&source.white(&scene), &scene);
            let close = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-14;
            assert!(close(found.signal_per_shot, expected.signal_per_shot), "{found:?}");
            assert!(close(found.ambient_rate_hz, expected.ambient_rate_hz), "{found:?}");
            let Budget { signal_per_shot, ambient_rate_hz, .. } = expected;
            assert_eq!(Budget { signal_per_shot, ambient_rate_hz, ..found }, expected);
        }
    }

    #[test]
    fn a_histogram_never_has_more_counts_than_shots() {
        let source = source(&["firmware.shots_per_frame=65535", "spad.pdp=1"]).unwrap();
        let near =
            Scene { distance_m: 0.001, reflectance: 1.0, irradiance_w_m2_nm: 100.0, setting: 0 };
        let histogram = source.draw_from(&source.probabilities(&near), &near, 1, 0);
        assert_eq!(histogram.iter().map(|&count| u64::from(count)).sum::<u64>(), 65_535);
        assert_eq!(histogram[0], 65_535);
    }

    #[test]
    fn each_setting_has_its_own_optics_chain_and_shots() {
        let of = |keys: &[&str]| {
            let keys: Vec<_> = keys.iter().map(|&key| key.to_owned()).collect();
            Setup::new(scenario::load("kc705", &keys).unwrap()).unwrap()
        };
        let wide =
            ["laser.pulse_sigma_ps=200", "tdc.profile=ideal", "firmware.shots_per_frame=500"];
        let both = HistogramSource::of_settings(&[of(&[]), of(&wide)]).unwrap();
        for (setting, keys) in [&[][..], &wide].into_iter().enumerate() {
            let (alone, scene) = (source(keys).unwrap(), Scene { setting, ..SCENE });
            let codes = both.probabilities(&scene);
            assert_eq!(codes, alone.probabilities(&SCENE));
            let drawn = both.draw_from(&codes, &scene, 1, 7);
            assert_eq!(drawn, alone.draw_from(&codes, &SCENE, 1, 7));
        }
        assert!(HistogramSource::of_settings(&[]).is_err());
    }

    #[test]
    fn what_has_no_closed_form_is_refused() {
        let refused = |set: &str| source(&[set]).unwrap_err().to_string();
        let error = refused("firmware.mode=1");
        assert!(error.starts_with("scenario kc705: firmware.mode = 1: a dataset"), "{error}");
        assert!(refused("pll.jitter_rms_ps=7.7").contains("pll.jitter_rms_ps = 7.7"));
        assert!(refused("firmware.rst=true").contains("firmware.rst = true"));
    }
}
