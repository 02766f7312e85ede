//! Effect of temperature and supply voltage on a chain: all delays scale by the same factor.
//!
//! A die heats up in seconds and a frame takes milliseconds, so both are constant within a run unless a profile is
//! given (`tdc.conditions`). The calibration ROM holds the ages at the conditions of the calibration; any drift since
//! then is an error in all ages.

mod pace;
mod profile;

use crate::error::{Input, Result};
use crate::firmware::carry_chain::Delays;
use crate::kernel::Time;

use super::builtin::Source;
use super::chain::{too_long, too_short};
use super::model::Tdc;

pub use pace::Pace;
pub use profile::{DIE_C, Moment, Profile, SUPPLY_MV};

/// Latest time of a profile that is simulated, beyond the end of any run [s].
const LATEST_S: f64 = 10_000.0;
/// Temperature at which the delays in a chain file apply [degC].
pub const REFERENCE_C: f64 = 25.0;

/// The delays of a chain at power-up, at calibration and during the run.
#[derive(Clone, Debug, PartialEq)]
pub struct Drifted {
    /// Delays at power-up.
    pub now: Delays,
    /// Delays that the calibration assumes, if they differ from those at power-up.
    pub calibrated: Option<Delays>,
    /// Drift during the run, if there is any.
    pub course: Option<Course>,
}

/// Drift of the delays during a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// Scale factor of the delays over time.
    pub pace: Pace,
    /// Smallest and largest scale factor, relative to the calibrated delays [1].
    pub range: [f64; 2],
    /// Largest scale factor, relative to the delays at power-up [1].
    pub slowest: f64,
}

/// Loads the profile of temperature and supply, if the TDC names one. Its path is relative to `base`.
///
/// # Errors
/// If the file cannot be read, or a row is invalid.
pub fn conditions(tdc: &Tdc, base: &Source) -> Result<Option<Profile>> {
    let Some(name) = &tdc.conditions else { return Ok(None) };
    let (source, text) = base.read(name)?;
    let profile = Profile::parse(&source, &text)?;
    let last_s = profile.moments().last().map_or(0.0, |moment| moment.time_s);
    if last_s > LATEST_S {
        let expected = format!("expected times of a run, {LATEST_S} s at most");
        return Err(Input::new(source, expected).field("time_s").value(last_s).into());
    }
    Ok(Some(profile))
}

impl Drifted {
    /// Returns the delays that the calibration assumes.
    pub fn known(&self) -> &Delays {
        self.calibrated.as_ref().unwrap_or(&self.now)
    }

    /// Computes the delays of a chain from those in its file (`own`), under the conditions of the keys or of a
    /// profile. The chain is sampled with the clock period `cycle`.
    ///
    /// # Errors
    /// If the chain is too short or too long for the clock under any of the conditions.
    pub fn new(own: Delays, tdc: &Tdc, profile: Option<&Profile>, cycle: Time) -> Result<Self> {
        let given = Conditions {
            celsius: ("tdc.temperature_c", tdc.temperature_c),
            millivolts: ("tdc.supply_mv", tdc.supply_mv),
        };
        let of_profile: Vec<_> = profile.into_iter().flat_map(Profile::moments).collect();
        let now = of_profile.first().map_or(given, |moment| Conditions::of(moment));
        let then = Conditions {
            celsius: ("tdc.calibrated_at_c", tdc.calibrated_at_c.unwrap_or(now.celsius.1)),
            millivolts: ("tdc.calibrated_at_mv", tdc.calibrated_at_mv.unwrap_or(now.millivolts.1)),
        };
        let [factor, factor_then] = [now, then].map(|conditions| conditions.factor(tdc));
        let calibrated =
            (factor_then != factor).then(|| stretched(&own, factor_then, cycle, then.cause(tdc)));
        let calibrated = calibrated.transpose()?;
        let mut range = [factor; 2];
        for conditions in of_profile.iter().map(|moment| Conditions::of(moment)) {
            let factor = conditions.factor(tdc);
            if factor < range[0] || factor > range[1] {
                stretched(&own, factor, cycle, conditions.cause(tdc))?;
            }
            range = [range[0].min(factor), range[1].max(factor)];
        }
        let point = |moment: &&Moment| {
            let at = Time::from_ps_f64(moment.time_s * 1e12);
            (at, Conditions::of(moment).factor(tdc) / factor)
        };
        let course = (range[0] < range[1]).then(|| Course {
            pace: Pace::new(of_profile.iter().map(point).collect()),
            range: range.map(|factor| factor / factor_then),
            slowest: range[1] / factor,
        });
        Ok(Drifted { now: stretched(&own, factor, cycle, now.cause(tdc))?, calibrated, course })
    }
}

/// Temperature and supply, with the scenario keys that set them.
#[derive(Clone, Copy, Debug)]
struct Conditions {
    celsius: (&'static str, f64),
    millivolts: (&'static str, f64),
}

impl Conditions {
    fn of(moment: &Moment) -> Self {
        let key = "tdc.conditions";
        Conditions { celsius: (key, moment.temperature_c), millivolts: (key, moment.supply_mv) }
    }

    /// Returns the relative change of delay due to temperature and due to supply [1].
    fn parts(&self, tdc: &Tdc) -> [f64; 2] {
        [tdc.delay_per_c * (self.celsius.1 - REFERENCE_C), tdc.delay_per_mv * self.millivolts.1]
    }

    /// Returns the scale factor of the delays, relative to the reference conditions [1].
    fn factor(&self, tdc: &Tdc) -> f64 {
        let [by_c, by_mv] = self.parts(tdc);
        (1.0 + by_c) * (1.0 + by_mv)
    }

    /// Returns the key that contributes most to the scale factor, and its value.
    fn cause(&self, tdc: &Tdc) -> (&'static str, f64) {
        let [by_c, by_mv] = self.parts(tdc);
        if by_mv.abs() > by_c.abs() { self.millivolts } else { self.celsius }
    }
}

/// Scales the delays by `factor`. Errors name the given key and value as the cause.
fn stretched(own: &Delays, factor: f64, cycle: Time, (key, value): (&str, f64)) -> Result<Delays> {
    if factor == 1.0 {
        return Ok(own.clone());
    }
    let fault = |expected: String| Input::new("scenario", expected).field(key).value(value);
    let Some(delays) = own.stretched(factor) else {
        let expected = format!("expected delays above 0, they are {factor} times those at 25 degC");
        return Err(fault(expected).into());
    };
    match too_long(&delays, cycle).or_else(|| too_short(&delays, cycle)) {
        Some(expected) => {
            Err(fault(format!("with delays {factor:.4} times those at 25 degC {expected}")).into())
        }
        None => Ok(delays),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::carry_chain::TAPS;

    const CYCLE: Time = Time::from_ns(8);

    fn own() -> Delays {
        Delays::new(Time::from_ns(2), &[11_000; TAPS]).unwrap()
    }

    #[test]
    fn at_the_reference_the_chain_is_its_file_s() {
        let drifted = Drifted::new(own(), &Tdc::default(), None, CYCLE).unwrap();
        assert_eq!(drifted, Drifted { now: own(), calibrated: None, course: None });
        // Calibrated anew at each temperature.
        let warm = Tdc { temperature_c: 65.0, ..Tdc::default() };
        assert_eq!(Drifted::new(own(), &warm, None, CYCLE).unwrap().calibrated, None);
    }

    #[test]
    fn forty_degrees_are_four_percent_of_every_delay() {
        let warm = Tdc { temperature_c: 65.0, calibrated_at_c: Some(25.0), ..Tdc::default() };
        let drifted = Drifted::new(own(), &warm, None, CYCLE).unwrap();
        assert_eq!(drifted.known(), &own());
        for n in [0, 1, 400, 800] {
            let [now, own] = [&drifted.now, &own()].map(|delays| delays.boundary(n).fs() as f64);
            assert!((now / own - 1.04).abs() < 1e-9, "{n}");
        }
        let low = Tdc { supply_mv: -10.0, ..Tdc::default() };
        let slow = Drifted::new(own(), &low, None, CYCLE).unwrap().now;
        assert_eq!(slow.tap_0().fs(), 2_020_000);
    }

    #[test]
    fn a_chain_that_the_cold_makes_too_short_is_refused_by_key() {
        let scant = Delays::new(Time::from_ns(2), &[10_050; TAPS]).unwrap();
        let cold = Tdc { temperature_c: 5.0, ..Tdc::default() };
        let error = Drifted::new(scant.clone(), &cold, None, CYCLE).unwrap_err().to_string();
        assert!(error.contains("tdc.temperature_c = 5: with delays 0.9800 times those"), "{error}");
        let then = Tdc { calibrated_at_c: Some(5.0), ..Tdc::default() };
        let error = Drifted::new(scant.clone(), &then, None, CYCLE).unwrap_err().to_string();
        assert!(error.contains("tdc.calibrated_at_c = 5"), "{error}");
        let high = Tdc { temperature_c: 20.0, supply_mv: 20.0, ..Tdc::default() };
        let error = Drifted::new(scant, &high, None, CYCLE).unwrap_err().to_string();
        assert!(error.contains("tdc.supply_mv = 20"), "{error}");
    }
}
