//! The link budget: expected photons and avalanches per shot.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::kernel::Time;
use crate::kernel::pulse::Pulse;
use crate::scenario::Scenario;
use crate::scenario::mesh::Mesh;
use crate::scenario::wiring::Wiring;

use super::dark::DarkRates;
use super::photometry::{AmbientRate, seen_sr, signal_per_shot, white_per_shot};
use super::pixels::Pixels;
use super::returned::Returned;
use super::scene::{Ambient, PixelLight, Scene};
use super::spread::{self, Spread};
use super::variation::Variation;

pub use super::photometry::LIGHT_M_S;

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
        let ambient = AmbientRate::of(scenario);
        if let (Some(scene), Some(pixels)) = (&scene, Pixels::of(scenario)) {
            let light = scene.of_pixels(&pixels);
            return Budget::of_light(scenario, pulse, &ambient, &light[0], 0.0);
        }
        let background = |seen: &Ambient| {
            Budget::of_background(scenario, pulse, &ambient, seen, scenario.laser.delay_ps)
        };
        let Some(scene) = scene else {
            let seen = Ambient { target_sr: seen_sr(scenario), air_sr: 0.0 };
            let signal_per_shot = f64::from(scenario.spad.on_tdc) * signal_per_shot(scenario);
            return Budget { signal_per_shot, ..background(&seen) };
        };
        background(&scene.ambient()).with_light(&scene.returned(), scenario)
    }

    /// Computes the budget of a pixel that sees such light and whose signal path has an additional delay, for the
    /// given laser pulse and without measured dark rates [ps].
    pub(super) fn of_light(
        scenario: &Scenario,
        pulse: Pulse,
        ambient: &AmbientRate,
        light: &PixelLight,
        offset_ps: f64,
    ) -> Self {
        let delay_ps = scenario.laser.delay_ps + offset_ps;
        Budget::of_background(scenario, pulse, ambient, &light.ambient, delay_ps)
            .with_light(&light.returned, scenario)
    }

    /// Computes the part of a budget that does not depend on the laser's light.
    fn of_background(
        scenario: &Scenario,
        pulse: Pulse,
        ambient: &AmbientRate,
        seen: &Ambient,
        delay_ps: f64,
    ) -> Self {
        let on_tdc = f64::from(scenario.spad.on_tdc);
        let rate_hz = |reflectance, seen_sr| ambient.hz(scenario, reflectance, seen_sr);
        let delay = Time::from_ps_f64(delay_ps);
        let flight = Time::from_ps_f64(2e12 * scenario.target.distance_m / LIGHT_M_S);
        Budget {
            ambient_rate_hz: on_tdc * rate_hz(scenario.target.reflectance, seen.target_sr),
            airlight_rate_hz: on_tdc * rate_hz(1.0, seen.air_sr),
            dark_rate_hz: DarkRates::new(&scenario.spad, None).on_tdc_hz(),
            pulse_energy_j: scenario.laser.pulse_energy_j(),
            mean_arrival: delay + flight,
            delay,
            pulse,
            variation: Variation::of(&scenario.laser),
            ..Budget::default()
        }
    }

    /// Replaces the laser light by that returned from a scene, distributed in time.
    fn with_light(self, returned: &Returned, scenario: &Scenario) -> Self {
        let horizon_m = longest_period_s(scenario) * LIGHT_M_S / 2.0;
        let is_one_of_many = scenario.array.count() > 1 && returned.air.is_some();
        let steps = if is_one_of_many { spread::COARSE } else { spread::FINE };
        let (spread, air) = Spread::new(returned, &self.pulse, self.delay, horizon_m, steps);
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

    /// Returns the mean distance of what returns the laser's light, along the lines of sight; `None` if nothing does
    /// [m].
    pub fn mean_radial_m(&self) -> Option<f64> {
        let returns = self.signal_per_shot + self.retro_per_shot > 0.0;
        returns.then(|| self.flight().seconds() * LIGHT_M_S / 2.0)
    }

    /// Returns the rate of avalanches from ambient light and dark counts [1/s].
    pub fn background_rate_hz(&self) -> f64 {
        self.ambient_light_hz() + self.dark_rate_hz
    }
}

/// Returns the longest laser period that the run may use [s].
fn longest_period_s(scenario: &Scenario) -> f64 {
    let firmware = &scenario.firmware;
    let changes = scenario.control.iter().filter_map(|change| change.laser_freq);
    let codes = [firmware.laser_freq].into_iter().chain(changes);
    let cycles = codes.filter_map(|code| firmware.laser_periods.get(code as usize)).max();
    cycles.map_or(0.0, |cycles| *cycles as f64) * scenario.pll.params().cycle().seconds()
}

#[cfg(test)]
mod tests;
