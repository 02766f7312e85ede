//! The link budget of a scenario, what a shot can expect, and eye safety: a table and JSON.

use serde_json::{Value, json};

use tofsim::error::Result;
use tofsim::optics::eye_safety::{Exposure, PulseTrain, longest_exposure_s};
use tofsim::optics::{Budget, Chances};
use tofsim::{Note, NoteCode, Setup};

use super::writer::Findings;
use crate::text::table::{grouped, number_or_dash, plain};

/// A row: quantity, value and meaning.
type BudgetRow = [String; 3];

/// The link budget, with the verdicts on eye safety.
pub struct LinkBudget {
    pub setup: Setup,
    /// Probabilities of a shot; `None` where shots depend on each other.
    pub chances: Option<Chances>,
    /// Eq. 3.3, at the rate of the optics (Table 3.2).
    pub at_the_optics_rate: Exposure,
    /// One frame at the firmware's laser rate.
    pub a_frame: Exposure,
    /// Frame after frame, up to the end of Table 3.1.
    pub frames: Exposure,
    /// The pulses of the latter.
    pub pulses: PulseTrain,
}

impl LinkBudget {
    pub fn of(setup: Setup) -> Self {
        let frames = setup.exposure_to_frames();
        LinkBudget {
            chances: setup.chances(),
            at_the_optics_rate: setup.exposure_at_the_optics_rate(),
            a_frame: setup.exposure_to_a_frame(),
            frames,
            pulses: setup.pulse_train(&frames),
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
        let pulses = self.setup.pulse_note("frames that repeat", &self.pulses);
        exposures.into_iter().filter_map(note).chain(pulses)
    }

    /// Returns the condition of Class 1 that is met with the least to spare, or missed by the most.
    fn binding(&self) -> Option<&'static str> {
        let margins = [
            ("average power of a frame", self.a_frame.margin()),
            ("average power of frames", self.frames.margin()),
            ("pulses", self.pulses.margin()),
        ];
        let known = margins.into_iter().filter_map(|(name, margin)| Some((name, margin?)));
        known.min_by(|(_, one), (_, other)| one.total_cmp(other)).map(|(name, _)| name)
    }

    /// Longest stretch of frames within Class 1 [s].
    pub fn longest_s(&self) -> Option<f64> {
        longest_exposure_s(self.frames.average_w, self.setup.scenario.laser.wavelength_nm)
            .filter(|longest_s| *longest_s >= self.a_frame.exposure_s)
    }

    /// Rows of what is found: light, shot, laser, verdicts; what, how much, and what that means.
    pub fn rows(&self) -> Vec<BudgetRow> {
        let setup = &self.setup;
        let (budget, target) = (&setup.budget, &setup.scenario.target);
        let mut light = vec![
            row("distance", format!("{} m", target.distance_m), flight(self)),
            row("signal", format!("{:.4}", budget.signal_per_shot), "detected photons per shot"),
        ];
        light.extend(retro(budget));
        light.extend(second(setup));
        light.extend(air(budget));
        light.extend(cover(setup));
        light.push(row("ambient", format!("{:.4e} /s", budget.ambient_rate_hz), "avalanches"));
        if budget.second_rate_hz > 0.0 {
            let rate = format!("{:.4e} /s", budget.second_rate_hz);
            light.push(row(
                "second ambient",
                rate,
                "avalanches, of ambient light from the second surface",
            ));
        }
        if budget.airlight_rate_hz > 0.0 {
            let rate = format!("{:.4e} /s", budget.airlight_rate_hz);
            light.push(row("airlight", rate, "avalanches, of ambient light that the air scatters"));
        }
        light.push(row("dark", format!("{:.4e} /s", budget.dark_rate_hz), "avalanches"));
        let average = format!("{:.2} mW", self.a_frame.average_w * 1e3);
        let rate_mhz = 1e-6 / setup.laser_period_s();
        let laser = [
            row("pulse energy", format!("{:.1} pJ", budget.pulse_energy_j * 1e12), ""),
            row("average power", average, format!("at {rate_mhz:.3} MHz")),
        ];
        let light = light.into_iter().chain(shot(self));
        light.chain(laser).chain(eye_safety(self)).collect()
    }
}

impl Findings for LinkBudget {
    const SCHEMA: &'static str = "tofsim.budget/1";

    fn json(&self) -> Value {
        let (setup, budget) = (&self.setup, &self.setup.budget);
        let mut eye_safety = verdict(&self.a_frame);
        eye_safety["at_optics_rate"] = verdict(&self.at_the_optics_rate);
        eye_safety["repeated"] = verdict(&self.frames);
        eye_safety["repeated"]["longest_s"] = json!(self.longest_s());
        eye_safety["pulses"] = pulses(&self.pulses);
        eye_safety["binding"] = json!(self.binding());
        let chance = |of: fn(&Chances) -> f64| self.chances.as_ref().map(of);
        let mut object = json!({
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
        for (key, value) in [
            ("second_per_shot", budget.second_per_shot),
            ("second_rate_hz", budget.second_rate_hz),
            ("cover_per_shot", budget.cover_per_shot),
        ] {
            if value > 0.0 {
                object[key] = json!(value);
            }
        }
        object
    }

    fn text(&self) -> String {
        format!("{}\n", plain(self.rows()))
    }
}

fn verdict(exposure: &Exposure) -> Value {
    let &Exposure { exposure_s, average_w, limit_w } = exposure;
    let within = exposure.is_within();
    json!({ "exposure_s": exposure_s, "limit_w": limit_w, "average_w": average_w, "within": within })
}

fn pulses(train: &PulseTrain) -> Value {
    json!({
        "pulse_j": train.pulse_j,
        "single_limit_j": train.single_limit_j,
        "energy_j": train.energy_j,
        "count": train.count,
        "c5": train.c5,
        "limit_j": train.limit_j(),
        "within": train.margin().map(|margin| margin >= 1.0),
    })
}

fn row(name: &str, value: impl Into<String>, meaning: impl Into<String>) -> BudgetRow {
    [name.to_owned(), value.into(), meaning.into()]
}

/// Returns the row of a retroreflecting patch, if there is one.
fn retro(budget: &Budget) -> Option<BudgetRow> {
    let photons = budget.retro_per_shot;
    (photons > 0.0).then(|| row("patch", format!("{photons:.4}"), "the same of the patch"))
}

/// Returns the row of a second surface, if there is one.
fn second(setup: &Setup) -> Option<BudgetRow> {
    let (photons, distance_m) =
        (setup.budget.second_per_shot, setup.scenario.target.second_distance_m);
    let meaning = format!("the same of the second surface, at {distance_m} m");
    (photons > 0.0).then(|| row("second surface", format!("{photons:.4}"), meaning))
}

/// Returns the row of a cover window, if there is one.
fn cover(setup: &Setup) -> Option<BudgetRow> {
    let (photons, delay_ps) = (setup.budget.cover_per_shot, setup.scenario.cover.delay_ps);
    let meaning = format!("the same of the cover window, after {delay_ps} ps");
    (photons > 0.0).then(|| row("cover", format!("{photons:.4}"), meaning))
}

/// Returns the rows of the air, if it scatters.
fn air(budget: &Budget) -> Vec<BudgetRow> {
    if budget.backscatter_per_shot == 0.0 && budget.transmission == 1.0 {
        return vec![];
    }
    let scattered = format!("{:.4}", budget.backscatter_per_shot);
    let passes = format!("{:.4}", budget.transmission);
    vec![
        row("backscatter", scattered, "the same of the air"),
        row("transmission", passes, "of the target's light, on both ways together"),
    ]
}

fn flight(findings: &LinkBudget) -> String {
    let budget = &findings.setup.budget;
    let flight = format!("{:.1} ps of flight", budget.flight().fs() as f64 / 1e3);
    match findings.setup.scenario.laser.delay_ps {
        0.0 => flight,
        delay_ps => format!("{flight}, {delay_ps:.1} ps after the laser edge"),
    }
}

/// Returns the probabilities of a shot.
fn shot(findings: &LinkBudget) -> Vec<BudgetRow> {
    let Some(chances) = &findings.chances else {
        return vec![row("any hit", "-", "known only where the first avalanche of a shot decides")];
    };
    let shots = f64::from(findings.setup.params.frame_ctrl.shots_per_frame);
    let counted = grouped((chances.counted * shots).round() as u64);
    let ratio = number_or_dash(chances.signal_to_noise(), 4);
    let four = |chance: f64| format!("{chance:.4}");
    vec![
        row("any hit", four(chances.hit), "probability that the TDC keeps one in a shot"),
        row("signal first", four(chances.signal_first), "probability that it is a laser photon's"),
        row(
            "counted",
            four(chances.counted),
            format!("hits per shot with a code, {counted} a frame"),
        ),
        row("signal-to-background", ratio, "counted laser hits per background hit"),
    ]
}

/// The verdict for one frame, for frames that repeat, and by eq. 3.3.
fn eye_safety(findings: &LinkBudget) -> Vec<BudgetRow> {
    let word = |margin: Option<f64>| match margin {
        Some(margin) if margin >= 1.0 => "within",
        Some(_) => "above",
        None => "no limit",
    };
    let verdict = |name: &str, exposure: &Exposure, what: String| {
        let verdict = word(exposure.margin());
        let (average, limit) =
            (exposure.average_w * 1e3, exposure.limit_w.map(|limit| limit * 1e3));
        let limit = number_or_dash(limit, 2);
        row(name, verdict, format!("{average:.2} of {limit} mW, Class 1 {what}"))
    };
    let (design, a_frame, frames) =
        (&findings.at_the_optics_rate, &findings.a_frame, &findings.frames);
    let ms = |seconds: f64| format!("{:.3} ms", seconds * 1e3);
    let mut rows = vec![
        verdict("eye safety", a_frame, format!("for one frame, {}", ms(a_frame.exposure_s))),
        verdict("", frames, format!("for {} s of frames", frames.exposure_s)),
    ];
    if let (Some(false), Some(longest_s)) = (frames.is_within(), findings.longest_s()) {
        rows.push(row("", "within", format!("for {} of frames", ms(longest_s))));
    }
    let by_the_thesis = format!("for {} (eq. 3.3)", ms(design.exposure_s));
    rows.push(verdict("", design, by_the_thesis));
    let train = &findings.pulses;
    let [pulse, single] = [Some(train.pulse_j), train.single_limit_j].map(|j| j.map(|j| j * 1e9));
    let [energy, limit] = [Some(train.energy_j), train.limit_j()].map(|j| j.map(|j| j * 1e9));
    let [pulse, single, energy, limit] =
        [pulse, single, energy, limit].map(|nj| number_or_dash(nj, 2));
    let one = train.single_limit_j.map(|limit_j| limit_j / train.pulse_j);
    rows.push(row("", word(one), format!("{pulse} of {single} nJ, Class 1 for a pulse")));
    let many =
        format!("{energy} of {limit} nJ, Class 1 for the pulses of 5 us (C5 = {:.2})", train.c5);
    rows.push(row("", word(train.margin()), many));
    if let Some(binding) = findings.binding() {
        rows.push(row("", "binding", binding));
    }
    rows
}
