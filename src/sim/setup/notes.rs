//! What the results of a setup lie outside of.

use crate::error::Result;
use crate::firmware::tof_top::{Estimator, HistogramSource};
use crate::kernel::Time;
use crate::note::{Note, NoteCode, NoteValue};
use crate::optics::budget::LIGHT_M_S;
use crate::sensor::light::Light;
use crate::sim::domain;

use super::Setup;

/// Laser photons that a frame has to expect, for a depth to be one [1].
const FAINTEST_FRAME: f64 = 1.0;

impl Setup {
    /// Distance of the target, where a depth can be that of the target: where light and not a list or
    /// a ROM decides it, the laser's light comes back, and the histogram holds the echo [m].
    pub fn true_depth_m(&self) -> Option<f64> {
        self.no_depth.is_none().then_some(self.scenario.target.distance_m)
    }

    /// What the depths of a run lie outside of: what the scenario makes impossible, or else what the
    /// network was trained for.
    ///
    /// # Errors
    /// When the network's file has a domain that is none.
    pub fn notes(&self) -> Result<Vec<Note>> {
        match &self.no_depth {
            Some(note) => Ok(vec![note.clone()]),
            None if self.params.estimator == Estimator::Network => {
                domain::notes(&self.network, &self.scenario, &[])
            }
            None => Ok(Vec::new()),
        }
    }

    /// What makes it impossible that a depth is that of the target, if something does.
    pub fn no_depth(&self) -> Option<&Note> {
        self.no_depth.as_ref()
    }

    /// Why no depth of a run can be that of the target.
    pub(super) fn why_no_depth(&self) -> Option<Note> {
        self.without_light().or_else(|| self.without_echo()).or_else(|| self.past_the_end())
    }

    fn without_light(&self) -> Option<Note> {
        let stimulus = &self.scenario.stimulus;
        let (key, file) = match (&self.light, &self.params.histogram_source) {
            (Light::Optics(_), _) => return None,
            (Light::List(_), _) => ("stimulus.photons", &stimulus.photons),
            (Light::None, HistogramSource::Preload(_)) => {
                ("stimulus.histogram", &stimulus.histogram)
            }
            (Light::None, _) => ("stimulus.codes", &stimulus.codes),
        };
        let file = file.as_deref().unwrap_or_default();
        let text = "no light is simulated, so there is no true depth";
        Some(Note::new(NoteCode::NoLight, key, file, "none", text))
    }

    fn without_echo(&self) -> Option<Note> {
        let scenario = &self.scenario;
        let note = |key, value: NoteValue, expected: &str| {
            let text =
                "hardly any of the laser's light is detected, so the depth is not the target's";
            Some(Note::new(NoteCode::NoLight, key, value, expected, text))
        };
        let comes_on = scenario.control.iter().any(|change| change.laser_en == Some(true));
        if !scenario.firmware.laser_en && !comes_on {
            return note("firmware.laser_en", false.into(), "true");
        }
        let shots = scenario.firmware.shots_of_a_frame() as f64;
        if self.budget.signal_per_shot * shots >= FAINTEST_FRAME {
            return None;
        }
        let factors = [
            ("laser.average_power_w", scenario.laser.average_power_w),
            ("lens.area_m2", scenario.lens.area_m2),
            ("lens.efficiency", scenario.lens.efficiency),
            ("filter.efficiency", scenario.filter.efficiency),
            ("spad.pdp", scenario.spad.pdp),
            ("spad.fill_factor", scenario.spad.fill_factor),
            ("target.reflectance", scenario.target.reflectance),
        ];
        let cause = factors.into_iter().find(|(_, factor)| *factor == 0.0);
        let (key, value) = cause.unwrap_or(("target.reflectance", scenario.target.reflectance));
        note(key, value.into(), "a photon a frame at least")
    }

    /// An echo that comes after the last bin, which is before the next pulse.
    fn past_the_end(&self) -> Option<Note> {
        let bins = self.bins();
        let end = bins.spans().last().map_or(Time::ZERO, |span| span.until);
        let arrival = self.budget.mean_arrival;
        if arrival < end {
            return None;
        }
        let (key, distance_m) = ("target.distance_m", self.scenario.target.distance_m);
        let expected = format!("below {:.3}", end.seconds() * LIGHT_M_S / 2.0);
        let text = match arrival.seconds() < self.laser_period_s() {
            true => "the echo comes after the last bin, so the depth is not the target's",
            false => {
                "the echo comes after the next pulse and is not simulated, so the depth is not the target's"
            }
        };
        Some(Note::new(NoteCode::EchoPastHistogram, key, distance_m, expected, text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_echo_after_the_next_pulse_is_said_not_to_be_simulated() {
        let text = |distance_m: &str| {
            let wall = ["target.length_m=10", "target.width_m=10", distance_m];
            let setup = Setup::load("kc705", &wall).unwrap();
            setup.no_depth().map(|note| (note.code, note.text.contains("after the next pulse")))
        };
        // The laser's period is 48 ns, 7.19 m.
        assert_eq!(text("target.distance_m=0.9"), None);
        assert_eq!(text("target.distance_m=7.1"), Some((NoteCode::EchoPastHistogram, false)));
        assert_eq!(text("target.distance_m=7.3"), Some((NoteCode::EchoPastHistogram, true)));
    }
}
