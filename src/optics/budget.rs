//! The link budget: expected photons and avalanches per shot.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::kernel::Time;
use crate::kernel::pulse::Pulse;
use crate::scenario::mesh::Mesh;
use crate::scenario::wiring::Wiring;
use crate::scenario::{Scenario, Target};

use super::cover::{self, Delays};
use super::dark::DarkRates;
use super::photometry::{AmbientRate, seen_sr, signal_per_shot, white_per_shot};
use super::pixels::Pixels;
use super::returned::{Light, Returned};
use super::scene::{Ambient, PixelLight, Scene};
use super::spread::{self, ORIGINS, Spread};
use super::variation::Variation;

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

    /// Computes the budget of a scene that may have a mesh, for the given laser pulse and without measured dark
    /// rates.
    pub fn of_scene(scenario: &Scenario, pulse: Pulse, mesh: Option<&Mesh>) -> Self {
        let ambient = AmbientRates::of(scenario);
        if scenario.extended_scene().is_none() {
            return Budget::of_plain(scenario, pulse, &ambient);
        }
        let scene = Scene::new(scenario, mesh);
        if let Some(pixels) = Pixels::of(scenario) {
            let [light, ..] = &scene.of_pixels(&pixels)[..] else { return Budget::default() };
            return Budget::of_light(scenario, pulse, &ambient, light, &PixelPath::default());
        }
        let (seen, delay_ps) = (scene.ambient(), scenario.laser.delay_ps);
        let cover_per_shot = cover::per_shot(scenario, 1.0, None);
        Budget::of_background(scenario, pulse, &ambient, &seen, delay_ps).with_light(
            &scene.returned(),
            cover_per_shot,
            scenario,
        )
    }

    /// Computes the budget of a plain target in clear air, by eq. 3.13: of all its light at the distance along the axis.
    fn of_plain(scenario: &Scenario, pulse: Pulse, ambient: &AmbientRates) -> Self {
        let target = &scenario.target;
        let (second, share) = (target.second(), target.second_share);
        let surface = |of: &Target, part: f64| {
            let signal = f64::from(scenario.spad.on_tdc) * signal_per_shot(scenario, of);
            [part * signal, part * seen_sr(scenario, of)]
        };
        let [signal_per_shot, target_sr] = surface(target, 1.0 - share);
        let [second_per_shot, second_sr] =
            second.as_ref().map_or([0.0; 2], |second| surface(second, share));
        let seen = Ambient { target_sr, second_sr, air_sr: 0.0 };
        let cover_per_shot = cover::per_shot(scenario, 1.0, None);
        let delay_ps = scenario.laser.delay_ps;
        let budget = Budget {
            signal_per_shot,
            second_per_shot,
            cover_per_shot,
            ..Budget::of_background(scenario, pulse, ambient, &seen, delay_ps)
        };
        let only = second.as_ref().filter(|_| share == 1.0).unwrap_or(target);
        if cover_per_shot == 0.0 && (share == 0.0 || share == 1.0) {
            return Budget { mean_arrival: budget.delay + flight(only.distance_m), ..budget };
        }
        let mut returned = Returned::default();
        returned.diffuse.add(target.distance_m, 0.0, signal_per_shot, signal_per_shot);
        if let Some(second) = &second {
            returned.second.add(second.distance_m, 0.0, second_per_shot, second_per_shot);
        }
        budget.over_time(&returned, scenario).0
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

    /// Computes the part of a budget that does not depend on the laser's light.
    fn of_background(
        scenario: &Scenario,
        pulse: Pulse,
        ambient: &AmbientRates,
        seen: &Ambient,
        delay_ps: f64,
    ) -> Self {
        let (on_tdc, target) = (f64::from(scenario.spad.on_tdc), &scenario.target);
        let rate_hz =
            |of: &AmbientRate, reflectance, seen_sr| on_tdc * of.hz(scenario, reflectance, seen_sr);
        let second = ambient.second.as_ref();
        let second_hz = |of| rate_hz(of, target.second_reflectance, seen.second_sr);
        let delay = Time::from_ps_f64(delay_ps);
        Budget {
            ambient_rate_hz: rate_hz(&ambient.target, target.reflectance, seen.target_sr),
            second_rate_hz: second.map_or(0.0, second_hz),
            airlight_rate_hz: rate_hz(&ambient.target, 1.0, seen.air_sr),
            dark_rate_hz: DarkRates::new(&scenario.spad, None).on_tdc_hz(),
            pulse_energy_j: scenario.laser.pulse_energy_j(),
            mean_arrival: delay + flight(target.distance_m),
            delay,
            pulse,
            variation: Variation::of(&scenario.laser),
            ..Budget::default()
        }
    }

    /// Replaces the laser light by that returned from a scene and a cover window, distributed in time.
    fn with_light(self, returned: &Returned, cover_per_shot: f64, scenario: &Scenario) -> Self {
        let white = f64::from(scenario.spad.on_tdc) * white_per_shot(scenario);
        let target = &scenario.target;
        let budget = Budget {
            signal_per_shot: white * target.reflectance * returned.diffuse.sum(),
            // Reflectance is per steradian of a hemisphere's pi.
            retro_per_shot: white * PI * target.retro_cd_lx_m2 * returned.retro.sum(),
            second_per_shot: white * target.second_reflectance * returned.second.sum(),
            cover_per_shot,
            transmission: returned.transmission(),
            ..self
        };
        let (budget, air) = budget.over_time(returned, scenario);
        Budget { backscatter_per_shot: white * PI * air, ..budget }
    }

    /// Distributes the laser light in time, and returns the total backscatter of the air too [1/m^2].
    fn over_time(self, returned: &Returned, scenario: &Scenario) -> (Self, f64) {
        let horizon_m = longest_period_s(scenario) * LIGHT_M_S / 2.0;
        let is_long = returned.air.is_some() || self.cover_per_shot > 0.0;
        let is_one_of_many = scenario.array.count() > 1 && is_long;
        let steps = if is_one_of_many { spread::COARSE } else { spread::FINE };
        let cover = Delays::of(&scenario.cover).filter(|_| self.cover_per_shot > 0.0);
        let (spread, air) =
            Spread::new(returned, cover.as_ref(), &self.pulse, self.delay, horizon_m, steps);
        let lights = [&returned.diffuse, &returned.retro, &returned.second];
        let mean_m = lights.into_iter().find_map(Light::mean_m);
        let mean_arrival = self.delay + flight(mean_m.unwrap_or(scenario.target.distance_m));
        (Budget { mean_arrival, spread: Some(Arc::new(spread)), ..self }, air)
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

/// Rates of ambient light from the target and from a second surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct AmbientRates {
    target: AmbientRate,
    second: Option<AmbientRate>,
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

/// What a pixel's path has of its own.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelPath {
    /// Additional delay of its signal path [ps].
    pub offset_ps: f64,
    /// Fraction of the pulse energy that the cover window sends to it, if it is not by its solid angle [1].
    pub cover_fraction: Option<f64>,
}

/// Returns the time of flight to a distance and back, eq. 3.23 [m].
fn flight(distance_m: f64) -> Time {
    Time::from_ps_f64(2e12 * distance_m / LIGHT_M_S)
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
