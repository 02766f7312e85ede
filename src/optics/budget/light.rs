//! Computes a budget: the light of surfaces, air, cover window and surroundings on the SPADs.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::kernel::Time;
use crate::kernel::pulse::Pulse;
use crate::optics::cover::{self, Delays};
use crate::optics::dark::DarkRates;
use crate::optics::photometry::{
    AmbientRate, AmbientRates, LIGHT_M_S, seen_sr, signal_per_shot, white_per_shot,
};
use crate::optics::pixels::Pixels;
use crate::optics::returned::{Light, Returned};
use crate::optics::scene::{Ambient, Scene};
use crate::optics::spread::{self, Spread};
use crate::optics::variation::Variation;
use crate::scenario::mesh::Mesh;
use crate::scenario::{Scenario, Target};

use super::{Budget, PixelPath};

impl Budget {
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

    /// Computes the part of a budget that does not depend on the laser's light.
    pub(super) fn of_background(
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
    pub(super) fn with_light(
        self,
        returned: &Returned,
        cover_per_shot: f64,
        scenario: &Scenario,
    ) -> Self {
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
