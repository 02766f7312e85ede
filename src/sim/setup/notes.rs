//! Notes on a setup whose results are outside of the model's validity.

use crate::error::Result;
use crate::firmware::tof_top::{FirmwareEstimator, HistogramSource};
use crate::kernel::Time;
use crate::note::{Note, NoteCode, NoteValue};
use crate::optics::budget::LIGHT_M_S;
use crate::scenario::Shape;
use crate::scenario::effects::Effect;
use crate::sensor::light::Light;
use crate::sim::domain;

use super::{Setup, recalibration};

/// The part of a turn by which steps are spread best over turns (golden section) [1].
const GOLDEN: f64 = 0.618_033_988_75;
/// Laser photons that a frame has to expect, for a depth to be one [1].
const FAINTEST_FRAME: f64 = 1.0;

impl Setup {
    /// Returns the mean distance of what returns the laser's light, along the lines of sight; `None` if nothing does
    /// [m].
    pub fn mean_radial_m(&self) -> Option<f64> {
        self.budget.mean_radial_m()
    }

    /// Returns notes on depths outside of the model's validity: impossible ones, or else those outside of the
    /// network's training, and those of a TDC that was calibrated under other conditions.
    ///
    /// # Errors
    /// When the network's file has a domain that is none.
    pub fn notes(&self) -> Result<Vec<Note>> {
        if let Some(note) = &self.no_depth {
            return Ok([&self.renamed[..], std::slice::from_ref(note)].concat());
        }
        let mut notes = Vec::new();
        let is_network = self.params.estimator == FirmwareEstimator::Network;
        if is_network {
            notes = domain::notes(&self.network, &self.scenario, &[])?;
        }
        let drift = self.drift_for(is_network.then_some(&notes[..]));
        notes.extend(drift);
        notes.extend(self.ring_in_step());
        notes.extend(self.partly_past_the_end());
        notes.extend(self.renamed.iter().cloned());
        Ok(notes)
    }

    /// Returns a note if the ring's hits leave ages out.
    fn ring_in_step(&self) -> Option<Note> {
        let (p, keys) = (self.params.tdc_calibration.as_ref()?, &self.scenario.tdc);
        let (cycle, delays) = (self.cycle(), &self.params.tdc.delays);
        let lsb = Time::from_fs(delays.span().fs() / delays.taps() as u64);
        let empty = recalibration::ring(keys).in_step(cycle, p.hits(), lsb)?;
        let [cycle_ns, empty_ps] = [cycle.seconds() * 1e9, empty.seconds() * 1e12];
        let expected =
            format!("such as {:.3}", ((keys.ring_ns / cycle_ns).floor() + GOLDEN) * cycle_ns);
        let text = format!(
            "the ring keeps step with the clock: to {empty_ps:.0} ps in a row of ages no hit of a calibration comes"
        );
        Some(Note::new(NoteCode::RingInStep, "tdc.ring_ns", keys.ring_ns, expected, text))
    }

    /// Returns a note if the chain has drifted since the TDC was calibrated. For estimators that are all the network,
    /// `of_network` has the notes on its training: it has learnt the drift that it was trained with.
    pub fn drift_for(&self, of_network: Option<&[Note]>) -> Option<Note> {
        let is_of_drift = |note: &Note| domain::DRIFT_KEYS.contains(&note.key.as_str());
        let has_learnt = of_network
            .is_some_and(|notes| self.network.domain.is_some() && !notes.iter().any(is_of_drift));
        if has_learnt && self.course.is_none() { None } else { self.drift() }
    }

    /// Returns a note if the chain drifts within a run, or has drifted since the TDC was calibrated.
    fn drift(&self) -> Option<Note> {
        self.drift_in_run().or_else(|| self.drift_before())
    }

    /// An age of a whole period, of a chain whose delays are so many times as long as the TDC knows, is off by so
    /// much [ps].
    fn off_ps(&self, factor: f64) -> f64 {
        // Every delay has grown by the same part: an age that is a period looks like this.
        self.cycle().seconds() * 1e12 * (1.0 / factor - 1.0)
    }

    fn drift_in_run(&self) -> Option<Note> {
        let [least, most] = self.course.as_ref()?.range.map(|factor| self.off_ps(factor));
        let file = self.scenario.tdc.conditions.as_deref().unwrap_or_default();
        let since = match self.params.tdc_calibration {
            None => "it was calibrated",
            Some(_) => "power-up, but for what calibrations on the way make good",
        };
        let text = format!(
            "the chain drifts within the run: an age of a whole period of clk_sys is off by {most:+.1} to {least:+.1} ps \
             since {since}, others in proportion"
        );
        Some(Note::new(NoteCode::ChainDrifted, "tdc.conditions", file, "none", text))
    }

    fn drift_before(&self) -> Option<Note> {
        let known = self.calibrated.as_ref()?;
        let tdc = &self.scenario.tdc;
        let [then_c, then_mv] = [
            tdc.calibrated_at_c.unwrap_or(tdc.temperature_c),
            tdc.calibrated_at_mv.unwrap_or(tdc.supply_mv),
        ];
        let by_c = tdc.delay_per_c * (tdc.temperature_c - then_c);
        let by_mv = tdc.delay_per_mv * (tdc.supply_mv - then_mv);
        let (key, value, then) = if by_mv.abs() > by_c.abs() {
            ("tdc.supply_mv", tdc.supply_mv, then_mv)
        } else {
            ("tdc.temperature_c", tdc.temperature_c, then_c)
        };
        let [known, now] =
            [known, &self.params.tdc.delays].map(|delays| delays.longest().seconds());
        let off_ps = self.off_ps(now / known);
        let text = format!(
            "the TDC was calibrated at {then}: an age of a whole period of clk_sys is off by {off_ps:+.1} ps, \
             others in proportion"
        );
        Some(Note::new(NoteCode::ChainDrifted, key, value, then.to_string(), text))
    }

    /// Returns a note if no depth can be that of the target.
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
            (Light::Optics(_) | Light::Row(_), _) => return None,
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
        let target = self.budget.signal_per_shot + self.budget.retro_per_shot;
        if target * shots >= FAINTEST_FRAME {
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
        let cause = cause.map(|(key, factor)| (key, factor.into()));
        let second = || Effect::SecondTarget.occurrence(scenario);
        let of_scene =
            || scenario.extended_scene().or_else(second).map(|effect| (effect.key, effect.value));
        let usual = ("target.reflectance", scenario.target.reflectance.into());
        let (key, value) = cause.or_else(of_scene).unwrap_or(usual);
        note(key, value, "a photon a frame at least")
    }

    /// When the last bin ends, from the laser edge.
    fn last_bin_ends(&self) -> Time {
        self.bins().spans().last().map_or(Time::ZERO, |span| span.until)
    }

    /// Returns a note if only a part of the target's light comes before the end of the last bin.
    fn partly_past_the_end(&self) -> Option<Note> {
        let (end, [first, last]) = (self.last_bin_ends(), self.budget.target_ends());
        if last < end || first >= end {
            return None;
        }
        let target = &self.scenario.target;
        let (key, distance_m) = match target.shape {
            Shape::Step if target.second_distance_m > target.distance_m => {
                ("target.second_distance_m", target.second_distance_m)
            }
            _ => ("target.distance_m", target.distance_m),
        };
        let too_far_m = (last - end).seconds() * LIGHT_M_S / 2.0;
        let expected = format!("{:.3} m less at least", too_far_m);
        let text =
            "a part of the target's light comes after the last bin, and is not in the histogram";
        Some(Note::new(NoteCode::EchoPastHistogram, key, distance_m, expected, text))
    }

    /// An echo that comes after the last bin, which is before the next pulse.
    fn past_the_end(&self) -> Option<Note> {
        let end = self.last_bin_ends();
        let [arrival, _] = self.budget.target_ends();
        if arrival < end {
            return None;
        }
        let delay = self.budget.delay;
        let (key, value, expected) = match delay < end {
            true => {
                let below_m = (end - delay).seconds() * LIGHT_M_S / 2.0;
                (
                    "target.distance_m",
                    self.scenario.target.distance_m,
                    format!("below {below_m:.3}"),
                )
            }
            // No distance is near enough.
            false => {
                let below_ps = end.fs() as f64 * 1e-3;
                ("laser.delay_ps", self.scenario.laser.delay_ps, format!("below {below_ps}"))
            }
        };
        let text = if arrival.seconds() < self.laser_period_s() {
            "the echo comes after the last bin, so the depth is not the target's"
        } else {
            "the echo comes after the next pulse and is not simulated, so the depth is not the target's"
        };
        Some(Note::new(NoteCode::EchoPastHistogram, key, value, expected, text))
    }
}

#[cfg(test)]
mod tests;
