//! The link budget of a scenario, what a shot can expect, and eye safety.

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::optics::Chances;
use tofsim::optics::eye_safety::{Exposure, longest_exposure_s};
use tofsim::{Note, NoteCode, Setup};

/// The link budget, with the verdicts on eye safety.
pub struct Findings {
    pub setup: Setup,
    /// Probabilities of a shot; `None` where shots depend on each other.
    pub chances: Option<Chances>,
    /// Eq. 3.3, at the rate of the optics (Table 3.2).
    pub at_the_optics_rate: Exposure,
    /// One frame at the firmware's laser rate.
    pub a_frame: Exposure,
    /// Frame after frame, up to the end of Table 3.1.
    pub frames: Exposure,
}

impl Findings {
    pub fn of(setup: Setup) -> Self {
        Findings {
            chances: setup.chances(),
            at_the_optics_rate: setup.exposure_at_the_optics_rate(),
            a_frame: setup.exposure_to_a_frame(),
            frames: setup.exposure_to_frames(),
            setup,
        }
    }

    /// Why a depth cannot be that of the target, or what its times are off by, which limits the laser is above, and
    /// where there is none to tell.
    ///
    /// # Errors
    /// When the network's file has a domain that is none.
    pub fn notes(&self) -> Result<Vec<Note>> {
        // What the network was trained for matters to its depths, which are not asked for.
        let mut notes = self.setup.notes()?;
        notes.retain(|note| note.code != NoteCode::OutsideTraining);
        notes.extend(self.eye_safety_notes());
        Ok(notes)
    }

    /// Returns the notes on the limits that the laser exceeds, and on those that are not known.
    pub fn eye_safety_notes(&self) -> impl Iterator<Item = Note> {
        // The laser does not run at the optics' rate, so only that there is no limit is worth a note.
        let design = Some(&self.at_the_optics_rate).filter(|design| design.limit_w.is_none());
        let exposures = [
            ("eq. 3.3", design),
            ("a frame", Some(&self.a_frame)),
            ("frames that repeat", Some(&self.frames)),
        ];
        let note = |(what, exposure): (&str, Option<&Exposure>)| {
            exposure.and_then(|exposure| self.setup.eye_safety_note(what, exposure))
        };
        exposures.into_iter().filter_map(note)
    }

    /// Longest stretch of frames within Class 1 [s].
    pub fn longest_s(&self) -> Option<f64> {
        longest_exposure_s(self.frames.average_w, self.setup.scenario.laser.wavelength_nm)
            .filter(|longest_s| *longest_s >= self.a_frame.exposure_s)
    }

    /// The object that `--json` prints.
    pub fn json(&self) -> Value {
        let (setup, budget) = (&self.setup, &self.setup.budget);
        let mut eye_safety = verdict(&self.a_frame);
        eye_safety["at_optics_rate"] = verdict(&self.at_the_optics_rate);
        eye_safety["repeated"] = verdict(&self.frames);
        eye_safety["repeated"]["longest_s"] = json!(self.longest_s());
        let chance = |of: fn(&Chances) -> f64| self.chances.as_ref().map(of);
        let mut object = json!({
            "schema": "tofsim.budget/1",
            "scenario": setup.name,
            "distance_m": setup.scenario.target.distance_m,
            "reflectance": setup.scenario.target.reflectance,
            "time_of_flight_ps": budget.flight().fs() as f64 / 1e3,
            "laser_delay_ps": setup.scenario.laser.delay_ps,
            "signal_per_shot": budget.signal_per_shot,
            "noise_rate_hz": budget.ambient_rate_hz,
            "dark_rate_hz": budget.dark_rate_hz,
            "hit_probability": chance(|chances| chances.hit),
            "signal_first_probability": chance(|chances| chances.signal_first),
            "counted_hits_per_shot": chance(|chances| chances.counted),
            "counted_signal_per_shot": chance(|chances| chances.counted_signal),
            "signal_to_noise": self.chances.and_then(|chances| chances.signal_to_noise()),
            "pulse_energy_j": budget.pulse_energy_j,
            "average_power_w": self.a_frame.average_w,
            "laser_rate_hz": 1.0 / setup.laser_period_s(),
            "eye_safety": eye_safety,
            "eye_safety_limit_w": self.at_the_optics_rate.limit_w,
            "eye_safety_exposure_s": self.at_the_optics_rate.exposure_s,
            "eye_safety_limit_at_laser_rate_w": self.a_frame.limit_w,
            "eye_safety_exposure_at_laser_rate_s": self.a_frame.exposure_s,
        });
        // What a plain rectangle in clear air has not.
        if budget.spread.is_some() {
            object["retro_per_shot"] = json!(budget.retro_per_shot);
            object["backscatter_per_shot"] = json!(budget.backscatter_per_shot);
            object["transmission"] = json!(budget.transmission);
            object["airlight_rate_hz"] = json!(budget.airlight_rate_hz);
        }
        object
    }
}

fn verdict(exposure: &Exposure) -> Value {
    let &Exposure { exposure_s, average_w, limit_w } = exposure;
    let within = exposure.is_within();
    json!({ "exposure_s": exposure_s, "limit_w": limit_w, "average_w": average_w, "within": within })
}
