//! The link budget: expected photons and avalanches per shot.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::kernel::Time;
use crate::kernel::pulse::Pulse;
use crate::scenario::mesh::Mesh;
use crate::scenario::wiring::Wiring;
use crate::scenario::{AmbientModel, Filter, Scenario};

use super::dark::DarkRates;
use super::geometry;
use super::scene::{Ambient, Scene};
use super::spread::Spread;
use super::variation::Variation;

/// Planck constant, exact in the SI [J s].
pub const PLANCK_J_S: f64 = 6.626_070_15e-34;
/// Speed of light, exact in the SI [m/s].
pub const LIGHT_M_S: f64 = 299_792_458.0;
/// Detection efficiency at which the fitted ambient rate is stated [1].
const FITTED_EFFICIENCY: f64 = 0.003;
/// Largest distance of Table 4.3, to which the fitted ambient rate belongs [m].
const FARTHEST_FITTED_M: f64 = 0.6;

/// Expected light on the SPADs connected to the TDC, all together.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// Mean number of detected laser photons per shot from the target's diffuse reflection, S_p of eq. 3.14 [1].
    pub signal_per_shot: f64,
    /// Mean number of detected laser photons per shot from a retroreflective patch [1].
    pub retro_per_shot: f64,
    /// Mean number of detected laser photons per shot scattered back by the air [1].
    pub backscatter_per_shot: f64,
    /// Transmission of the air to the target and back [1].
    pub transmission: f64,
    /// Rate of avalanches from ambient light reflected by the target, N_r of eq. 3.20 [1/s].
    pub ambient_rate_hz: f64,
    /// Rate of avalanches from ambient light scattered by the air [1/s].
    pub airlight_rate_hz: f64,
    /// Dark count rate [1/s].
    pub dark_rate_hz: f64,
    /// Energy of a laser pulse [J].
    pub pulse_energy_j: f64,
    /// Mean arrival time of the diffuse reflection, from the laser edge: eq. 3.23 plus the laser's delay.
    pub mean_arrival: Time,
    /// Temporal distribution of the laser light, if it is not a single echo.
    pub spread: Option<Arc<Spread>>,
    /// Delay from the laser edge to the light.
    pub delay: Time,
    /// Pulse shape as timed by the detector.
    pub pulse: Pulse,
    /// Variation from shot to shot.
    pub variation: Variation,
}

/// Returns a budget without any light, with the default pulse.
impl Default for Budget {
    fn default() -> Self {
        Budget {
            signal_per_shot: 0.0,
            retro_per_shot: 0.0,
            backscatter_per_shot: 0.0,
            transmission: 1.0,
            ambient_rate_hz: 0.0,
            airlight_rate_hz: 0.0,
            dark_rate_hz: 0.0,
            pulse_energy_j: 0.0,
            mean_arrival: Time::ZERO,
            spread: None,
            delay: Time::ZERO,
            pulse: Pulse::default(),
            variation: Variation::default(),
        }
    }
}

impl Budget {
    /// Computes the budget of a scene without a mesh, for the given laser pulse and without measured dark rates
    /// ([`Budget::with_dark_rates`]).
    pub fn new(scenario: &Scenario, pulse: Pulse) -> Self {
        Budget::of_scene(scenario, pulse, None)
    }

    /// Computes the budget of a scene that may have a mesh, for the given laser pulse and without measured dark
    /// rates.
    pub fn of_scene(scenario: &Scenario, pulse: Pulse, mesh: Option<&Mesh>) -> Self {
        let scene = scenario.complex_scene().map(|_| Scene::new(scenario, mesh));
        let seen = match &scene {
            None => Ambient { target_sr: seen_sr(scenario), air_sr: 0.0 },
            Some(scene) => scene.ambient(),
        };
        let on_tdc = f64::from(scenario.spad.on_tdc);
        let rate_hz = match scenario.ambient.model {
            AmbientModel::Fitted => fitted_ambient_rate_hz,
            AmbientModel::Physical => physical_ambient_rate_hz,
        };
        let ambient_rate_hz = rate_hz(scenario, scenario.target.reflectance, seen.target_sr);
        let airlight_rate_hz = rate_hz(scenario, 1.0, seen.air_sr);
        let delay = Time::from_ps_f64(scenario.laser.delay_ps);
        let flight = Time::from_ps_f64(2e12 * scenario.target.distance_m / LIGHT_M_S);
        let budget = Budget {
            ambient_rate_hz: on_tdc * ambient_rate_hz,
            airlight_rate_hz: on_tdc * airlight_rate_hz,
            dark_rate_hz: DarkRates::new(&scenario.spad, None).on_tdc_hz(),
            pulse_energy_j: scenario.laser.pulse_energy_j(),
            mean_arrival: delay + flight,
            delay,
            pulse,
            variation: Variation::of(&scenario.laser),
            ..Budget::default()
        };
        match &scene {
            None => Budget { signal_per_shot: on_tdc * signal_per_shot(scenario), ..budget },
            Some(scene) => budget.with_light_of(scene, scenario),
        }
    }

    /// Replaces the laser light by that returned from a scene, distributed in time.
    fn with_light_of(self, scene: &Scene, scenario: &Scenario) -> Self {
        let returned = scene.returned();
        let horizon_m = longest_period_s(scenario) * LIGHT_M_S / 2.0;
        let (spread, air) = Spread::new(&returned, &self.pulse, self.delay, horizon_m);
        let white = f64::from(scenario.spad.on_tdc) * white_per_shot(scenario);
        let target = &scenario.target;
        let mean_m = returned.diffuse.mean_m().or_else(|| returned.retro.mean_m());
        let mean_m = mean_m.unwrap_or(target.distance_m);
        let flight = Time::from_ps_f64(2e12 * mean_m / LIGHT_M_S);
        Budget {
            signal_per_shot: white * target.reflectance * returned.diffuse.sum(),
            // Reflectance is per steradian of a hemisphere's pi.
            retro_per_shot: white * PI * target.retro_cd_lx_m2 * returned.retro.sum(),
            backscatter_per_shot: white * PI * air,
            transmission: returned.transmission(),
            mean_arrival: self.delay + flight,
            spread: Some(Arc::new(spread)),
            ..self
        }
    }

    /// Replaces the dark count rate.
    pub fn with_dark_rates(self, dark: &DarkRates) -> Self {
        Budget { dark_rate_hz: dark.on_tdc_hz(), ..self }
    }

    /// Scales the budget of the SPADs on the TDC to all simulated outputs, each of which receives the same light.
    pub fn of_row(&self, wiring: &Wiring, dark: &DarkRates) -> Self {
        let share = wiring.simulated.len() as f64 / wiring.on_tdc.len() as f64;
        Budget { dark_rate_hz: dark.of_row_hz(), ..self.dimmed(share) }
    }

    /// Scales all light and dark counts by a factor.
    pub fn dimmed(&self, part: f64) -> Self {
        Budget {
            signal_per_shot: self.signal_per_shot * part,
            retro_per_shot: self.retro_per_shot * part,
            backscatter_per_shot: self.backscatter_per_shot * part,
            ambient_rate_hz: self.ambient_rate_hz * part,
            airlight_rate_hz: self.airlight_rate_hz * part,
            dark_rate_hz: self.dark_rate_hz * part,
            ..self.clone()
        }
    }

    /// Scales the budget of a white target in 1 W/m^2/nm to another reflectance and irradiance [W/m^2/nm], by eq. 3.13,
    /// 3.19 and 3.20. Light from a retroreflective patch and from the air does not depend on the reflectance.
    pub fn of_white(&self, reflectance: f64, irradiance_w_m2_nm: f64) -> Self {
        Budget {
            signal_per_shot: self.signal_per_shot * reflectance,
            ambient_rate_hz: self.ambient_rate_hz * reflectance * irradiance_w_m2_nm,
            airlight_rate_hz: self.airlight_rate_hz * irradiance_w_m2_nm,
            ..self.clone()
        }
    }

    /// Returns the mean number of detected laser photons per shot, from all origins [1].
    pub fn laser_per_shot(&self) -> f64 {
        self.signal_per_shot + self.retro_per_shot + self.backscatter_per_shot
    }

    /// Returns the arrival times of light from the nearest and the farthest part of the target.
    pub fn target_ends(&self) -> [Time; 2] {
        self.spread.as_ref().map_or([self.mean_arrival; 2], |spread| spread.ends)
    }

    /// Returns the rate of avalanches from ambient light [1/s].
    pub fn ambient_light_hz(&self) -> f64 {
        self.ambient_rate_hz + self.airlight_rate_hz
    }

    /// Returns the mean time of flight, eq. 3.23.
    pub fn flight(&self) -> Time {
        self.mean_arrival - self.delay
    }

    /// Returns the rate of avalanches from ambient light and dark counts [1/s].
    pub fn background_rate_hz(&self) -> f64 {
        self.ambient_light_hz() + self.dark_rate_hz
    }
}

/// Computes S_p of one SPAD: eq. 3.13 in eq. 3.14, with P_s / f as the pulse energy.
fn signal_per_shot(scenario: &Scenario) -> f64 {
    let (target, laser) = (&scenario.target, &scenario.laser);
    let illumination_deg = laser.field_of_illumination_deg;
    let seen_deg = illumination_deg.min(scenario.spad.field_of_view_deg);
    let sin = libm::sin((illumination_deg / 4.0).to_radians());
    let lens_energy_j = laser.pulse_energy_j() * target.reflectance * scenario.lens.area_m2
        / (4.0 * PI * PI * sin * sin)
        * geometry::round_trip(target, seen_deg);
    lens_energy_j * scenario.filter.efficiency * avalanches_per_joule(scenario)
}

/// Computes S_p of one SPAD for a white target whose sum in eq. 3.13 is 1 per square metre [m^2].
fn white_per_shot(scenario: &Scenario) -> f64 {
    let sin = libm::sin((scenario.laser.field_of_illumination_deg / 4.0).to_radians());
    let lens_energy_j_m2 =
        scenario.laser.pulse_energy_j() * scenario.lens.area_m2 / (4.0 * PI * PI * sin * sin);
    lens_energy_j_m2 * scenario.filter.efficiency * avalanches_per_joule(scenario)
}

/// Returns the longest laser period that the run may use [s].
fn longest_period_s(scenario: &Scenario) -> f64 {
    let firmware = &scenario.firmware;
    let changes = scenario.control.iter().filter_map(|change| change.laser_freq);
    let codes = [firmware.laser_freq].into_iter().chain(changes);
    let cycles = codes.filter_map(|code| firmware.laser_periods.get(code as usize)).max();
    cycles.map_or(0.0, |cycles| *cycles as f64) * scenario.pll.params().cycle().seconds()
}

/// Computes N_r of one SPAD, proportional to irradiance and reflectance, with the constant fitted to Table 4.3, and
/// scaled by the ambient light that the optics collect from a projected solid angle, relative to the optics for which
/// the constant is stated.
fn fitted_ambient_rate_hz(scenario: &Scenario, reflectance: f64, seen_sr: f64) -> f64 {
    let ambient = &scenario.ambient;
    let of_the_thesis_optics =
        ambient.fitted_rate_hz_per_w_m2_nm * ambient.irradiance_w_m2_nm * reflectance
            / FITTED_EFFICIENCY
            * scenario.spad.detection_efficiency();
    of_the_thesis_optics * against_the_thesis_optics(scenario, seen_sr)
}

/// Returns the ratio of ambient photons with a scenario's optics to those with the thesis's: exactly 1 for the
/// thesis's optics and distances, because both are the same sum [1].
///
/// The reference is the thesis's target at the scenario's distance, because Table 4.3 has one rate for all distances,
/// and beyond the table's largest distance it is constant.
fn against_the_thesis_optics(scenario: &Scenario, own_sr: f64) -> f64 {
    let mut thesis = Scenario::default();
    thesis.target.distance_m = scenario.target.distance_m.min(FARTHEST_FITTED_M);
    thesis.target.cells = scenario.target.cells;
    ambient_photons_hz(scenario, own_sr) / ambient_photons_hz(&thesis, seen_sr(&thesis))
}

/// Computes the rate of ambient photons on one SPAD from a white target of the given projected solid angle, in an
/// irradiance of 1 W/m^2/nm [1/s].
fn ambient_photons_hz(scenario: &Scenario, seen_sr: f64) -> f64 {
    passband_nm(&scenario.filter) / PI
        * scenario.lens.area_m2
        * seen_sr
        * photons_per_joule(scenario)
}

/// Computes N_r of one SPAD by eq. 3.20, with the factors that eq. 3.19 omits: pi of a diffuse reflector, and the
/// solid angle.
fn physical_ambient_rate_hz(scenario: &Scenario, reflectance: f64, seen_sr: f64) -> f64 {
    let radiance_w_m2_sr =
        scenario.ambient.irradiance_w_m2_nm * passband_nm(&scenario.filter) * reflectance / PI;
    radiance_w_m2_sr * scenario.lens.area_m2 * seen_sr * avalanches_per_joule(scenario)
}

/// Returns the integral of the filter's transmission, eq. 3.17 [nm].
fn passband_nm(filter: &Filter) -> f64 {
    filter.efficiency * (2.0 * PI).sqrt() * filter.sigma_nm
}

/// Returns the projected solid angle of the visible part of a plain target [sr].
fn seen_sr(scenario: &Scenario) -> f64 {
    geometry::projected_solid_angle(&scenario.target, scenario.spad.field_of_view_deg)
}

/// Returns the number of avalanches of one SPAD per joule on the lens: eq. 3.14 behind the filter [1/J].
fn avalanches_per_joule(scenario: &Scenario) -> f64 {
    photons_per_joule(scenario) * scenario.spad.detection_efficiency()
}

/// Returns the number of photons on one SPAD per joule on the lens. The factor 2 / pi is the square array within the
/// lens's round image [1/J].
fn photons_per_joule(scenario: &Scenario) -> f64 {
    let photon_j = PLANCK_J_S * LIGHT_M_S / (scenario.laser.wavelength_nm * 1e-9);
    let share = 2.0 / (PI * scenario.spad.count as f64);
    scenario.lens.efficiency * share / photon_j
}

#[cfg(test)]
mod tests;
