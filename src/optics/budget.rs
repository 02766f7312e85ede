//! The link budget: photons and avalanches that a shot can expect.

use std::f64::consts::PI;

use crate::kernel::Time;
use crate::scenario::{AmbientModel, Scenario};

use super::geometry;

/// Planck constant, exact in the SI [J s].
pub const PLANCK_J_S: f64 = 6.626_070_15e-34;
/// Speed of light, exact in the SI [m/s].
pub const LIGHT_M_S: f64 = 299_792_458.0;
/// Detection efficiency at which the fitted ambient rate is stated [1].
const FITTED_EFFICIENCY: f64 = 0.003;

/// What one SPAD can expect of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Budget {
    /// Mean number of detected laser photons per shot, S_p of eq. 3.14 [1].
    pub signal_per_shot: f64,
    /// Rate of avalanches from ambient light, N_r of eq. 3.20 [1/s].
    pub ambient_rate_hz: f64,
    /// Rate of avalanches in the dark [1/s].
    pub dark_rate_hz: f64,
    /// Energy of a laser pulse [J].
    pub pulse_energy_j: f64,
    /// Mean time of flight from the laser edge, eq. 3.23.
    pub mean_arrival: Time,
    /// Standard deviation of the pulse as the detector times it [ps].
    pub pulse_sigma_ps: f64,
}

impl Budget {
    /// Of a scene.
    pub fn new(scenario: &Scenario) -> Self {
        Budget {
            signal_per_shot: signal_per_shot(scenario),
            ambient_rate_hz: match scenario.ambient.model {
                AmbientModel::Fitted => fitted_ambient_rate_hz(scenario),
                AmbientModel::Physical => physical_ambient_rate_hz(scenario),
            },
            dark_rate_hz: scenario.spad.dark_rate_hz,
            pulse_energy_j: scenario.laser.pulse_energy_j(),
            mean_arrival: Time::from_ps_f64(2e12 * scenario.target.distance_m / LIGHT_M_S),
            pulse_sigma_ps: scenario.laser.pulse_sigma_ps,
        }
    }

    /// Rate of avalanches that no laser photon causes [1/s].
    pub fn background_rate_hz(&self) -> f64 {
        self.ambient_rate_hz + self.dark_rate_hz
    }
}

/// S_p: eq. 3.13 into eq. 3.14, with P_s / f as the energy of the pulse.
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

/// N_r proportional to irradiance and reflectance, with the constant fitted to Table 4.3.
fn fitted_ambient_rate_hz(scenario: &Scenario) -> f64 {
    let ambient = &scenario.ambient;
    ambient.fitted_rate_hz_per_w_m2_nm * ambient.irradiance_w_m2_nm * scenario.target.reflectance
        / FITTED_EFFICIENCY
        * scenario.spad.detection_efficiency()
}

/// N_r of eq. 3.20, with what eq. 3.19 lacks: the factor pi of a diffuse reflector and the solid angle.
fn physical_ambient_rate_hz(scenario: &Scenario) -> f64 {
    let (target, filter) = (&scenario.target, &scenario.filter);
    let passband_nm = filter.efficiency * (2.0 * PI).sqrt() * filter.sigma_nm;
    let radiance_w_m2_sr =
        scenario.ambient.irradiance_w_m2_nm * passband_nm * target.reflectance / PI;
    let seen_sr = geometry::projected_solid_angle(target, scenario.spad.field_of_view_deg);
    radiance_w_m2_sr * scenario.lens.area_m2 * seen_sr * avalanches_per_joule(scenario)
}

/// Avalanches of one SPAD per joule on the lens: eq. 3.14 after the filter. The factor 2 / pi is the
/// square array inside the lens's round image [1/J].
fn avalanches_per_joule(scenario: &Scenario) -> f64 {
    let photon_j = PLANCK_J_S * LIGHT_M_S / (scenario.laser.wavelength_nm * 1e-9);
    let share = 2.0 / (PI * scenario.spad.count as f64);
    scenario.lens.efficiency * share / photon_j * scenario.spad.detection_efficiency()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_pulse_has_184_pj_and_returns_after_3_3_ns() {
        let budget = Budget::new(&Scenario::default());
        assert!((budget.pulse_energy_j - 184e-12).abs() < 1e-18);
        assert_eq!(budget.mean_arrival.fs(), 3_335_641);
        assert_eq!(budget.background_rate_hz() - budget.ambient_rate_hz, 100.0);
    }

    #[test]
    fn a_black_target_returns_nothing() {
        let mut scenario = Scenario::default();
        scenario.target.reflectance = 0.0;
        for model in [AmbientModel::Fitted, AmbientModel::Physical] {
            scenario.ambient.model = model;
            let budget = Budget::new(&scenario);
            assert_eq!((budget.signal_per_shot, budget.ambient_rate_hz), (0.0, 0.0));
        }
    }

    #[test]
    fn light_outside_the_field_of_view_is_not_seen() {
        let mut scenario = Scenario::default();
        let whole = Budget::new(&scenario).signal_per_shot;
        scenario.spad.field_of_view_deg = 10.5;
        let half = Budget::new(&scenario).signal_per_shot / whole;
        let cos4 = |deg: f64| deg.to_radians().cos().powi(4);
        let expected = (1.0 - cos4(5.25)) / (1.0 - cos4(10.5));
        assert!((half / expected - 1.0).abs() < 2e-4, "{half} {expected}");
    }
}
