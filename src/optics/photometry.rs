//! From optical power and solid angles to avalanches of a SPAD: eq. 3.13 to 3.20.

use std::f64::consts::PI;

use crate::scenario::{AmbientModel, Filter, Scenario, Target};

use super::geometry;

/// Planck constant, exact in the SI [J s].
pub const PLANCK_J_S: f64 = 6.626_070_15e-34;
/// Speed of light, exact in the SI [m/s].
pub const LIGHT_M_S: f64 = 299_792_458.0;
/// Detection efficiency at which the fitted ambient rate is stated [1].
const FITTED_EFFICIENCY: f64 = 0.003;
/// Largest distance of Table 4.3, to which the fitted ambient rate belongs [m].
const FARTHEST_FITTED_M: f64 = 0.6;

/// Computes S_p of one SPAD from a plain target: eq. 3.13 in eq. 3.14, with P_s / f as the pulse energy.
pub fn signal_per_shot(scenario: &Scenario, target: &Target) -> f64 {
    let laser = &scenario.laser;
    let illumination_deg = laser.field_of_illumination_deg;
    let seen_deg = illumination_deg.min(scenario.spad.field_of_view_deg);
    let sin = libm::sin((illumination_deg / 4.0).to_radians());
    let lens_energy_j = laser.pulse_energy_j() * target.reflectance * scenario.lens.area_m2
        / (4.0 * PI * PI * sin * sin)
        * geometry::round_trip(target, seen_deg);
    lens_energy_j * scenario.filter.efficiency * avalanches_per_joule(scenario)
}

/// Computes S_p of one SPAD for a white target whose sum in eq. 3.13 is 1 per square metre [m^2].
pub fn white_per_shot(scenario: &Scenario) -> f64 {
    let sin = libm::sin((scenario.laser.field_of_illumination_deg / 4.0).to_radians());
    let lens_energy_j_m2 =
        scenario.laser.pulse_energy_j() * scenario.lens.area_m2 / (4.0 * PI * PI * sin * sin);
    lens_energy_j_m2 * scenario.filter.efficiency * avalanches_per_joule(scenario)
}

/// Computes the detected photons of one SPAD per shot if all of the pulse energy came to the lens from within its
/// field of view.
pub fn whole_pulse_per_shot(scenario: &Scenario) -> f64 {
    let laser = &scenario.laser;
    laser.pulse_energy_j() * scenario.filter.efficiency * avalanches_per_joule(scenario)
}

/// Rate of avalanches of one SPAD from ambient light reflected at a target's distance, by the scenario's model.
#[derive(Clone, Copy, Debug)]
pub struct AmbientRate {
    /// Rate of ambient photons with the thesis's optics, to which the fitted rate belongs; `None` for the physical
    /// model [1/s].
    thesis_hz: Option<f64>,
}

impl AmbientRate {
    /// Returns the rate for the optics of a scenario and the distance of a target.
    pub fn of(scenario: &Scenario, target: &Target) -> Self {
        let is_fitted = matches!(scenario.ambient.model, AmbientModel::Fitted);
        AmbientRate { thesis_hz: is_fitted.then(|| thesis_photons_hz(target)) }
    }

    /// Computes N_r for a target of that reflectance and projected solid angle [1/s].
    pub fn hz(&self, scenario: &Scenario, reflectance: f64, seen_sr: f64) -> f64 {
        match self.thesis_hz {
            Some(thesis_hz) => {
                let ratio = photons_hz(scenario, seen_sr) / thesis_hz;
                fitted_rate_hz(scenario, reflectance) * ratio
            }
            None => physical_rate_hz(scenario, reflectance, seen_sr),
        }
    }
}

/// Rates of ambient light from the target and from a second surface.
#[derive(Clone, Copy, Debug)]
pub struct AmbientRates {
    /// That of the target.
    pub target: AmbientRate,
    /// That of the second surface, if there is one.
    pub second: Option<AmbientRate>,
}

impl AmbientRates {
    /// Returns the rates for the optics and the distances of a scenario.
    pub fn of(scenario: &Scenario) -> Self {
        let of = |target: &Target| AmbientRate::of(scenario, target);
        AmbientRates {
            target: of(&scenario.target),
            second: scenario.target.second().as_ref().map(of),
        }
    }
}

/// Computes N_r with the constant fitted to Table 4.3, proportional to irradiance and reflectance, for the optics for
/// which the constant is stated.
fn fitted_rate_hz(scenario: &Scenario, reflectance: f64) -> f64 {
    let ambient = &scenario.ambient;
    ambient.fitted_rate_hz_per_w_m2_nm * ambient.irradiance_w_m2_nm * reflectance
        / FITTED_EFFICIENCY
        * scenario.spad.detection_efficiency()
}

/// Computes the rate of ambient photons with the thesis's optics and distances [1/s].
///
/// The reference is the thesis's target at the target's distance, because Table 4.3 has one rate for all distances,
/// and beyond the table's largest distance it is constant.
fn thesis_photons_hz(target: &Target) -> f64 {
    let mut thesis = Scenario::default();
    thesis.target.distance_m = target.distance_m.min(FARTHEST_FITTED_M);
    thesis.target.cells = target.cells;
    photons_hz(&thesis, seen_sr(&thesis, &thesis.target))
}

/// Computes the rate of ambient photons on one SPAD from a white target of the given projected solid angle, in an
/// irradiance of 1 W/m^2/nm [1/s].
fn photons_hz(scenario: &Scenario, seen_sr: f64) -> f64 {
    passband_nm(&scenario.filter) / PI
        * scenario.lens.area_m2
        * seen_sr
        * photons_per_joule(scenario)
}

/// Computes N_r of one SPAD by eq. 3.20, with the factors that eq. 3.19 omits: pi of a diffuse reflector, and the
/// solid angle.
fn physical_rate_hz(scenario: &Scenario, reflectance: f64, seen_sr: f64) -> f64 {
    let radiance_w_m2_sr =
        scenario.ambient.irradiance_w_m2_nm * passband_nm(&scenario.filter) * reflectance / PI;
    radiance_w_m2_sr * scenario.lens.area_m2 * seen_sr * avalanches_per_joule(scenario)
}

/// Returns the integral of the filter's transmission, eq. 3.17 [nm].
fn passband_nm(filter: &Filter) -> f64 {
    filter.efficiency * (2.0 * PI).sqrt() * filter.sigma_nm
}

/// Returns the projected solid angle of the visible part of a plain target [sr].
pub fn seen_sr(scenario: &Scenario, target: &Target) -> f64 {
    geometry::projected_solid_angle(target, scenario.spad.field_of_view_deg)
}

/// Returns the number of avalanches of one SPAD per joule on the lens: eq. 3.14 behind the filter [1/J].
fn avalanches_per_joule(scenario: &Scenario) -> f64 {
    photons_per_joule(scenario) * scenario.spad.detection_efficiency()
}

/// Returns the number of photons on one SPAD per joule on the lens. The factor 2 / pi is the square array within the
/// lens's round image, of which a SPAD has one part of many. A pixel with a field of view of its own has all light
/// from there [1/J].
fn photons_per_joule(scenario: &Scenario) -> f64 {
    let photon_j = PLANCK_J_S * LIGHT_M_S / (scenario.laser.wavelength_nm * 1e-9);
    let is_part = !scenario.array.is_rectangular();
    let share = if is_part { 2.0 / (PI * scenario.spad.count as f64) } else { 1.0 };
    scenario.lens.efficiency * share / photon_j
}
