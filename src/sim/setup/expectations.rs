//! Expected values of a setup's shots, and exposure of an eye, without a simulation.

use crate::note::{Note, NoteCode};
use crate::optics::Chances;
use crate::optics::eye_safety::{C4_NM, Exposure, LONGEST_S, PulseTrain};
use crate::sim::fast::histogram::independent_shots;

use super::Setup;

/// Full width at half maximum of a Gaussian [standard deviations].
const WIDTH_OF_A_GAUSSIAN: f64 = 2.354_820_045;

impl Setup {
    /// Chances of a shot of an undisturbed frame, the lit one of a pair.
    ///
    /// `None` where more than a shot's first avalanche decides what becomes of it: see
    /// [`independent_shots`].
    pub fn chances(&self) -> Option<Chances> {
        let (optics, outcomes) = independent_shots(self, "a chance").ok()?;
        let [end, _of_the_last_shot] = outcomes.ends();
        let hazard = optics.hazard(self.scenario.firmware.laser_en);
        Some(Chances::new(hazard, &self.bins(), end))
    }

    /// Period of the laser as the firmware drives it [s].
    pub fn laser_period_s(&self) -> f64 {
        self.laser_period() as f64 * self.cycle().seconds()
    }

    /// Laser pulses of a frame; of a pair they are all the lit one's [1].
    fn pulses(&self) -> f64 {
        f64::from(self.params.frame_ctrl.shots_per_frame)
    }

    /// An eye that sees the pulses of one frame: eq. 3.1 to 3.3, at the firmware's laser rate.
    pub fn exposure_to_a_frame(&self) -> Exposure {
        let period_s = self.laser_period_s();
        let average_w = self.budget.pulse_energy_j / period_s;
        Exposure::new(self.pulses() * period_s, average_w, self.scenario.laser.wavelength_nm)
    }

    /// An eye that sees frame after frame, as the firmware makes them, up to where Table 3.1 ends. Between
    /// frames, and in dark ones, the laser rests.
    ///
    /// With a preloaded histogram the firmware lets the laser rest for good; that is not counted on.
    pub fn exposure_to_frames(&self) -> Exposure {
        let frames_s = (self.frame_cycles(self.laser_period()) + 1) as f64 * self.cycle().seconds();
        let lit_s = self.pulses() * self.laser_period_s();
        let repeats_s = (self.frames_together() as f64 * frames_s).max(lit_s);
        let average_w = self.pulses() * self.budget.pulse_energy_j / repeats_s;
        Exposure::new(LONGEST_S, average_w, self.scenario.laser.wavelength_nm)
    }

    /// Exposure of an eye as eq. 3.3 has it, at the rate at which the laser's power is stated.
    pub fn exposure_at_the_optics_rate(&self) -> Exposure {
        let laser = &self.scenario.laser;
        let exposure_s = self.pulses() / laser.repetition_rate_hz;
        Exposure::new(exposure_s, laser.average_power_w, laser.wavelength_nm)
    }

    /// The pulses of an exposure at the firmware's laser rate, each by itself and as a train.
    pub fn pulse_train(&self, exposure: &Exposure) -> PulseTrain {
        let laser = &self.scenario.laser;
        let energy_j = self.budget.pulse_energy_j;
        let pulses = exposure.average_w * exposure.exposure_s / energy_j;
        let width_s = laser.pulse_sigma_ps * 1e-12 * WIDTH_OF_A_GAUSSIAN;
        let times =
            [if energy_j > 0.0 { pulses } else { 0.0 }, self.laser_period_s(), exposure.exposure_s];
        PulseTrain::new([energy_j, width_s], times, laser.wavelength_nm)
    }

    /// Returns a note if the pulses of `what` are above their limit.
    pub fn pulse_note(&self, what: &str, train: &PulseTrain) -> Option<Note> {
        let margin = train.margin().filter(|margin| *margin < 1.0)?;
        let power_w = self.scenario.laser.average_power_w;
        let [energy, limit] = [train.energy_j, train.limit_j()?].map(|joule| joule * 1e9);
        let text = if train.energy_j == train.pulse_j && train.c5 == 1.0 {
            format!("{what}: a pulse has {energy:.2} nJ, above the {limit:.2} nJ of Class 1")
        } else {
            format!(
                "{what}: pulses of {energy:.2} nJ within 5 us, above the {limit:.2} nJ of Class 1 for {:.0} of them",
                train.count
            )
        };
        let expected = format!("{:e} or less", rounded_down(power_w * margin));
        Some(Note::new(NoteCode::EyeSafety, "laser.average_power_w", power_w, expected, text))
    }

    /// Returns a note if an exposure to `what` is above its limit, or has no known limit; `None` if it is within.
    pub fn eye_safety_note(&self, what: &str, exposure: &Exposure) -> Option<Note> {
        let laser = &self.scenario.laser;
        let &Exposure { exposure_s, average_w, limit_w } = exposure;
        let length = if exposure_s < 1.0 {
            format!("{:.3} ms", exposure_s * 1e3)
        } else {
            format!("{exposure_s} s")
        };
        if !C4_NM.contains(&laser.wavelength_nm) {
            let expected = format!("{} to {}", C4_NM.start(), C4_NM.end());
            let text = format!(
                "{what}: no Class 1 limit is known, because Table 3.1 has none for such light"
            );
            let (key, value) = ("laser.wavelength_nm", laser.wavelength_nm);
            return Some(Note::new(NoteCode::EyeSafety, key, value, expected, text));
        }
        let Some(limit_w) = limit_w else {
            let (key, value) = ("laser.repetition_rate_hz", laser.repetition_rate_hz);
            let expected = format!("{} or more", (self.pulses() / LONGEST_S).ceil());
            let text = format!(
                "{what}: no Class 1 limit is known, because an exposure of {length} is outside Table 3.1"
            );
            return Some(Note::new(NoteCode::EyeSafety, key, value, expected, text));
        };
        if average_w <= limit_w {
            return None;
        }
        let largest = laser.average_power_w * limit_w / average_w;
        let text = format!(
            "{what}: {:.2} mW on average, above the {:.2} mW of Class 1 for an exposure of {length} (Table 3.1)",
            average_w * 1e3,
            limit_w * 1e3,
        );
        let (key, expected) =
            ("laser.average_power_w", format!("{:e} or less", rounded_down(largest)));
        Some(Note::new(NoteCode::EyeSafety, key, laser.average_power_w, expected, text))
    }
}

/// A positive number with three digits, and no larger than it is.
fn rounded_down(number: f64) -> f64 {
    let unit = 10f64.powi(2 - number.log10().floor() as i32);
    // Through its decimals, so that it is the nearest number to what it shows as.
    let digits = format!("{}e{}", (number * unit).floor(), number.log10().floor() as i32 - 2);
    digits.parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setup(overrides: &[&str]) -> Setup {
        Setup::load("kc705", overrides).unwrap()
    }

    #[test]
    fn the_default_is_safe_for_a_frame_and_not_for_ten_seconds_of_them() {
        let setup = setup(&[]);
        let (frame, frames) = (setup.exposure_to_a_frame(), setup.exposure_to_frames());
        assert!((frame.limit_w.unwrap() - 10.85e-3).abs() < 1e-5);
        assert_eq!(setup.eye_safety_note("a frame", &frame), None);
        let cycles = 30_000.0 * 6.0;
        let expected_w = 184e-12 * 30_000.0 / ((cycles + 542.0) * 8e-9);
        assert!((frames.average_w / expected_w - 1.0).abs() < 1e-9, "{}", frames.average_w);
        assert!((frames.limit_w.unwrap() - 1.189e-3).abs() < 1e-6, "{frames:?}");
        let note = setup.eye_safety_note("ten seconds of frames", &frames).unwrap();
        assert_eq!((note.code, &*note.key), (NoteCode::EyeSafety, "laser.average_power_w"));
        assert_eq!(note.expected, "2.28e-3 or less");
    }

    #[test]
    fn with_the_power_that_a_note_expects_there_is_no_note() {
        let bright = setup(&["laser.average_power_w=0.1"]);
        for exposure in [Setup::exposure_to_a_frame, Setup::exposure_to_frames] {
            let note = bright.eye_safety_note("it", &exposure(&bright)).unwrap();
            let (largest, _) = note.expected.split_once(' ').unwrap();
            let power = |part: f64| {
                let watts = part * largest.parse::<f64>().unwrap();
                setup(&[&format!("laser.average_power_w={watts}")])
            };
            let (below, above) = (power(1.0), power(1.01));
            assert_eq!(below.eye_safety_note("it", &exposure(&below)), None);
            assert!(above.eye_safety_note("it", &exposure(&above)).is_some());
        }
    }

    #[test]
    fn of_light_that_table_3_1_does_not_know_it_is_said() {
        for (wavelength_nm, is_known) in
            [(699.0, false), (700.0, true), (1050.0, true), (1550.0, false)]
        {
            let setup = setup(&[&format!("laser.wavelength_nm={wavelength_nm}")]);
            let note = setup.eye_safety_note("a frame", &setup.exposure_to_a_frame());
            let is_of_wavelength = note.is_some_and(|note| note.key == "laser.wavelength_nm");
            assert_eq!(is_of_wavelength, !is_known, "{wavelength_nm} nm");
        }
    }

    #[test]
    fn a_pulse_can_be_too_bright_where_the_average_power_is_not() {
        let bright = setup(&[
            "firmware.laser_periods=[65535]",
            "firmware.laser_freq=0",
            "laser.average_power_w=5e-4",
            "laser.repetition_rate_hz=1000",
        ]);
        let frames = bright.exposure_to_frames();
        assert_eq!(frames.is_within(), Some(true));
        let train = bright.pulse_train(&frames);
        assert!((train.energy_j / 500e-9 - 1.0).abs() < 1e-9 && train.margin().unwrap() < 0.5);
        let note = bright.pulse_note("it", &train).unwrap();
        assert_eq!((note.code, &*note.key), (NoteCode::EyeSafety, "laser.average_power_w"));
        let usual = setup(&[]);
        assert_eq!(usual.pulse_note("it", &usual.pulse_train(&usual.exposure_to_frames())), None);
    }

    #[test]
    fn pauses_and_dark_frames_let_the_eye_rest() {
        let average_w = |overrides: &[&str]| setup(overrides).exposure_to_frames().average_w;
        let few = average_w(&["firmware.shots_per_frame=100"]);
        assert!((few / (184e-12 * 100.0 / (1142.0 * 8e-9)) - 1.0).abs() < 1e-9, "{few}");
        let pairs = average_w(&["firmware.dark_frames=true"]);
        assert!((pairs / average_w(&[]) - 0.5).abs() < 2e-3, "{pairs}");
        let pair = setup(&["firmware.dark_frames=true"]).exposure_to_a_frame();
        assert!((pair.exposure_s - 15_000.0 * 48e-9).abs() < 1e-12, "{pair:?}");
    }

    #[test]
    fn an_exposure_past_the_table_has_a_note_of_its_own() {
        let slow = setup(&["laser.repetition_rate_hz=1000"]);
        let note = slow.eye_safety_note("it", &slow.exposure_at_the_optics_rate()).unwrap();
        assert_eq!((&*note.key, &*note.expected), ("laser.repetition_rate_hz", "3000 or more"));
    }

    #[test]
    fn chances_are_those_of_shots_that_do_not_depend_on_each_other() {
        let near = setup(&["target.distance_m=0.1", "target.reflectance=0.6"]).chances().unwrap();
        assert!(near.hit > 0.999 && near.signal_first > 0.8, "{near:?}");
        let off = setup(&["firmware.laser_en=false"]).chances().unwrap();
        assert_eq!((off.signal_first, off.counted_signal), (0.0, 0.0));
        assert_eq!(setup(&["firmware.mode=1"]).chances(), None);
        assert_eq!(setup(&["pll.jitter_rms_ps=8"]).chances(), None);
    }
}
