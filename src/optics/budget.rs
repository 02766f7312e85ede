//! The link budget: expected photons and avalanches per shot.

use std::sync::Arc;

use crate::kernel::Time;
use crate::kernel::pulse::Pulse;
use crate::scenario::Scenario;
use crate::scenario::wiring::Wiring;

use super::cover;
use super::dark::DarkRates;
use super::photometry::AmbientRates;
use super::scene::PixelLight;
use super::spread::{ORIGINS, Spread};
use super::variation::Variation;

mod light;

pub use super::photometry::LIGHT_M_S;

/// Expected light on the SPADs connected to the TDC, all together.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// Mean number of detected laser photons per shot from the target's diffuse reflection, S_p of eq. 3.14 [1].
    pub signal_per_shot: f64,
    /// Mean number of detected laser photons per shot from a retroreflective patch [1].
    pub retro_per_shot: f64,
    /// Mean number of detected laser photons per shot from the second surface [1].
    pub second_per_shot: f64,
    /// Mean number of detected laser photons per shot scattered back by the air [1].
    pub backscatter_per_shot: f64,
    /// Mean number of detected laser photons per shot sent back by the cover window [1].
    pub cover_per_shot: f64,
    /// Transmission of the air to the target and back [1].
    pub transmission: f64,
    /// Rate of avalanches from ambient light reflected by the target, N_r of eq. 3.20 [1/s].
    pub ambient_rate_hz: f64,
    /// Rate of avalanches from ambient light reflected by the second surface [1/s].
    pub second_rate_hz: f64,
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
            second_per_shot: 0.0,
            backscatter_per_shot: 0.0,
            cover_per_shot: 0.0,
            transmission: 1.0,
            ambient_rate_hz: 0.0,
            second_rate_hz: 0.0,
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

    /// Computes the budget of a pixel that sees such light and has such a path, for the given laser pulse and without
    /// measured dark rates.
    pub(super) fn of_light(
        scenario: &Scenario,
        pulse: Pulse,
        ambient: &AmbientRates,
        light: &PixelLight,
        path: &PixelPath,
    ) -> Self {
        let delay_ps = scenario.laser.delay_ps + path.offset_ps;
        let cover_per_shot = cover::per_shot(scenario, light.share, path.cover_fraction);
        Budget::of_background(scenario, pulse, ambient, &light.ambient, delay_ps).with_light(
            &light.returned,
            cover_per_shot,
            scenario,
        )
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
            second_per_shot: self.second_per_shot * part,
            backscatter_per_shot: self.backscatter_per_shot * part,
            cover_per_shot: self.cover_per_shot * part,
            ambient_rate_hz: self.ambient_rate_hz * part,
            second_rate_hz: self.second_rate_hz * part,
            airlight_rate_hz: self.airlight_rate_hz * part,
            dark_rate_hz: self.dark_rate_hz * part,
            ..self.clone()
        }
    }

    /// Scales the budget of a white target in 1 W/m^2/nm to another reflectance and irradiance [W/m^2/nm], by eq. 3.13,
    /// 3.19 and 3.20. Light from a retroreflective patch, a second surface, the air and a cover window does not depend on
    /// the reflectance.
    pub fn of_white(&self, reflectance: f64, irradiance_w_m2_nm: f64) -> Self {
        Budget {
            signal_per_shot: self.signal_per_shot * reflectance,
            ambient_rate_hz: self.ambient_rate_hz * reflectance * irradiance_w_m2_nm,
            second_rate_hz: self.second_rate_hz * irradiance_w_m2_nm,
            airlight_rate_hz: self.airlight_rate_hz * irradiance_w_m2_nm,
            ..self.clone()
        }
    }

    /// Returns the mean number of detected laser photons per shot, from all origins [1].
    pub fn laser_per_shot(&self) -> f64 {
        self.by_origin().iter().sum()
    }

    /// Returns the mean number of detected laser photons per shot from each origin: diffuse reflection, patch, second
    /// surface, air and cover window [1].
    pub(super) fn by_origin(&self) -> [f64; ORIGINS] {
        let &Budget { signal_per_shot, retro_per_shot, second_per_shot, .. } = self;
        let &Budget { backscatter_per_shot, cover_per_shot, .. } = self;
        [signal_per_shot, retro_per_shot, second_per_shot, backscatter_per_shot, cover_per_shot]
    }

    /// Returns the arrival times of light from the nearest and the farthest part of the target.
    pub fn target_ends(&self) -> [Time; 2] {
        self.spread.as_ref().map_or([self.mean_arrival; 2], |spread| spread.ends)
    }

    /// Returns the rate of avalanches from ambient light [1/s].
    pub fn ambient_light_hz(&self) -> f64 {
        self.ambient_rate_hz + self.second_rate_hz + self.airlight_rate_hz
    }

    /// Returns the mean time of flight, eq. 3.23.
    pub fn flight(&self) -> Time {
        self.mean_arrival - self.delay
    }

    /// Returns the mean distance of the parts of the target that return the laser's light, along the lines of sight;
    /// `None` if none does [m].
    pub fn mean_radial_m(&self) -> Option<f64> {
        let returns = self.signal_per_shot + self.retro_per_shot > 0.0;
        returns.then(|| self.flight().seconds() * LIGHT_M_S / 2.0)
    }

    /// Returns the rate of avalanches from ambient light and dark counts [1/s].
    pub fn background_rate_hz(&self) -> f64 {
        self.ambient_light_hz() + self.dark_rate_hz
    }
}

/// What a pixel's path has of its own.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelPath {
    /// Additional delay of its signal path [ps].
    pub offset_ps: f64,
    /// Fraction of the pulse energy that the cover window sends to it, if it is not by its solid angle [1].
    pub cover_fraction: Option<f64>,
}

#[cfg(test)]
mod tests;
