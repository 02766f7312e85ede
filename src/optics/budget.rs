//! The link budget: photons and avalanches that a shot can expect.

use std::f64::consts::PI;

use crate::kernel::Time;
use crate::kernel::pulse::Pulse;
use crate::scenario::wiring::Wiring;
use crate::scenario::{AmbientModel, Filter, Scenario};

use super::dark::DarkRates;
use super::geometry;
use super::variation::Variation;

/// Planck constant, exact in the SI [J s].
pub const PLANCK_J_S: f64 = 6.626_070_15e-34;
/// Speed of light, exact in the SI [m/s].
pub const LIGHT_M_S: f64 = 299_792_458.0;
/// Detection efficiency at which the fitted ambient rate is stated [1].
const FITTED_EFFICIENCY: f64 = 0.003;
/// Largest distance of Table 4.3, to which the fitted ambient rate belongs [m].
const FARTHEST_FITTED_M: f64 = 0.6;

/// What the SPADs on the TDC can expect of the scene together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Budget {
    /// Mean number of detected laser photons per shot, S_p of eq. 3.14 [1].
    pub signal_per_shot: f64,
    /// Rate of avalanches from ambient light, N_r of eq. 3.20 [1/s].
    pub ambient_rate_hz: f64,
    /// Rate of avalanches in the dark [1/s].
    pub dark_rate_hz: f64,
    /// Energy of a laser pulse [J].
    pub pulse_energy_j: f64,
    /// Mean arrival of the echo, from the laser edge: eq. 3.23 after the laser's delay.
    pub mean_arrival: Time,
    /// How long after the laser edge the light leaves.
    pub delay: Time,
    /// The pulse as the detector times it.
    pub pulse: Pulse,
    /// How shots differ.
    pub variation: Variation,
}

impl Budget {
    /// Of a scene, with the pulse that its laser has, and without measured dark rates ([`Budget::with_dark_rates`]).
    pub fn new(scenario: &Scenario, pulse: Pulse) -> Self {
        let on_tdc = f64::from(scenario.spad.on_tdc);
        let ambient_rate_hz = match scenario.ambient.model {
            AmbientModel::Fitted => fitted_ambient_rate_hz(scenario),
            AmbientModel::Physical => physical_ambient_rate_hz(scenario),
        };
        let delay = Time::from_ps_f64(scenario.laser.delay_ps);
        let flight = Time::from_ps_f64(2e12 * scenario.target.distance_m / LIGHT_M_S);
        Budget {
            signal_per_shot: on_tdc * signal_per_shot(scenario),
            ambient_rate_hz: on_tdc * ambient_rate_hz,
            dark_rate_hz: DarkRates::new(&scenario.spad, None).on_tdc_hz(),
            pulse_energy_j: scenario.laser.pulse_energy_j(),
            mean_arrival: delay + flight,
            delay,
            pulse,
            variation: Variation {
                timing_ps: scenario.laser.timing_jitter_ps,
                energy: scenario.laser.energy_jitter,
            },
        }
    }

    /// The same with dark rates that may have been measured.
    pub fn with_dark_rates(self, dark: &DarkRates) -> Self {
        Budget { dark_rate_hz: dark.on_tdc_hz(), ..self }
    }

    /// That of all outputs that are simulated, where this is of those on the TDC: each has the same light.
    pub fn of_row(&self, wiring: &Wiring, dark: &DarkRates) -> Self {
        let share = wiring.simulated.len() as f64 / wiring.on_tdc.len() as f64;
        Budget {
            signal_per_shot: self.signal_per_shot * share,
            ambient_rate_hz: self.ambient_rate_hz * share,
            dark_rate_hz: dark.of_row_hz(),
            ..self.clone()
        }
    }

    /// Mean time of flight, eq. 3.23.
    pub fn flight(&self) -> Time {
        self.mean_arrival - self.delay
    }

    /// Rate of avalanches that no laser photon causes [1/s].
    pub fn background_rate_hz(&self) -> f64 {
        self.ambient_rate_hz + self.dark_rate_hz
    }
}

/// S_p of one SPAD: eq. 3.13 into eq. 3.14, with P_s / f as the energy of the pulse.
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

/// N_r of one SPAD, proportional to irradiance and reflectance, with the constant fitted to Table 4.3, and to what
/// the optics make of ambient light, against the optics that the constant is stated for.
fn fitted_ambient_rate_hz(scenario: &Scenario) -> f64 {
    let ambient = &scenario.ambient;
    let of_the_thesis_optics = ambient.fitted_rate_hz_per_w_m2_nm
        * ambient.irradiance_w_m2_nm
        * scenario.target.reflectance
        / FITTED_EFFICIENCY
        * scenario.spad.detection_efficiency();
    of_the_thesis_optics * against_the_thesis_optics(scenario)
}

/// Ambient photons of a scenario's optics against those of the thesis's: exactly 1 for its own, at its
/// own distances, because both sides are the same sum [1].
///
/// The thesis's optics look at their own target from the same distance, because Table 4.3 has one rate for
/// all of its distances, although that target does not fill the view from 0.47 m on. Beyond the last of
/// them nothing was fitted, and the reference stays there: the rate falls with the target's solid angle,
/// and a wall that fills the view has the same rate from everywhere.
fn against_the_thesis_optics(scenario: &Scenario) -> f64 {
    let mut thesis = Scenario::default();
    thesis.target.distance_m = scenario.target.distance_m.min(FARTHEST_FITTED_M);
    thesis.target.cells = scenario.target.cells;
    ambient_photons_hz(scenario) / ambient_photons_hz(&thesis)
}

/// Ambient photons on one SPAD, of a white target in an irradiance of 1 W/m^2/nm [1/s].
fn ambient_photons_hz(scenario: &Scenario) -> f64 {
    passband_nm(&scenario.filter) / PI
        * scenario.lens.area_m2
        * seen_sr(scenario)
        * photons_per_joule(scenario)
}

/// N_r of one SPAD by eq. 3.20, with what eq. 3.19 lacks: the factor pi of a diffuse reflector and the solid angle.
fn physical_ambient_rate_hz(scenario: &Scenario) -> f64 {
    let radiance_w_m2_sr = scenario.ambient.irradiance_w_m2_nm
        * passband_nm(&scenario.filter)
        * scenario.target.reflectance
        / PI;
    radiance_w_m2_sr * scenario.lens.area_m2 * seen_sr(scenario) * avalanches_per_joule(scenario)
}

/// Integral of the filter's transmission, eq. 3.17 [nm].
fn passband_nm(filter: &Filter) -> f64 {
    filter.efficiency * (2.0 * PI).sqrt() * filter.sigma_nm
}

/// Projected solid angle of the part of the target that is seen [sr].
fn seen_sr(scenario: &Scenario) -> f64 {
    geometry::projected_solid_angle(&scenario.target, scenario.spad.field_of_view_deg)
}

/// Avalanches of one SPAD per joule on the lens: eq. 3.14 after the filter [1/J].
fn avalanches_per_joule(scenario: &Scenario) -> f64 {
    photons_per_joule(scenario) * scenario.spad.detection_efficiency()
}

/// Photons on one SPAD per joule on the lens. The factor 2 / pi is the square array inside the lens's
/// round image [1/J].
fn photons_per_joule(scenario: &Scenario) -> f64 {
    let photon_j = PLANCK_J_S * LIGHT_M_S / (scenario.laser.wavelength_nm * 1e-9);
    let share = 2.0 / (PI * scenario.spad.count as f64);
    scenario.lens.efficiency * share / photon_j
}

#[cfg(test)]
mod tests;
