//! What temperature and supply make of a chain: every delay of it grows by the same part.
//!
//! A die heats up in seconds, and a frame takes milliseconds: within a run both stand still. The ROM knows the
//! delays as they were when it was calibrated, and a drift since then is an error of all ages.

use std::ops::RangeInclusive;

use crate::error::{Input, Result};
use crate::firmware::carry_chain::Delays;
use crate::kernel::Time;

use super::chain::{too_long, too_short};
use super::model::Tdc;

/// Temperatures that a commercial part is made for (DS182), as the keys have it [degC].
pub const DIE_C: RangeInclusive<f64> = 0.0..=85.0;
/// What the supply may be off its nominal voltage by (DS182), as the keys have it [mV].
pub const SUPPLY_MV: RangeInclusive<f64> = -30.0..=30.0;
/// Temperature at which the delays of a chain's file hold [degC].
pub const REFERENCE_C: f64 = 25.0;

/// A chain now, and as the ROM was calibrated.
#[derive(Clone, Debug, PartialEq)]
pub struct Drifted {
    /// Its delays in the run.
    pub now: Delays,
    /// Those that the calibration knows, if they are others.
    pub calibrated: Option<Delays>,
}

impl Drifted {
    /// The delays that the calibration knows.
    pub fn known(&self) -> &Delays {
        self.calibrated.as_ref().unwrap_or(&self.now)
    }

    /// A chain whose file has these delays, sampled with a clock of the period `cycle`.
    ///
    /// # Errors
    /// When it is too short or too long for the clock at that temperature and supply.
    pub fn new(own: Delays, tdc: &Tdc, cycle: Time) -> Result<Self> {
        let (celsius, millivolts) = (tdc.temperature_c, tdc.supply_mv);
        let at_c = tdc.calibrated_at_c.unwrap_or(celsius);
        let at_mv = tdc.calibrated_at_mv.unwrap_or(millivolts);
        let by = |conditions: [(&'static str, f64); 2]| {
            let [(_, celsius), (_, millivolts)] = conditions;
            let by_c = tdc.delay_per_c * (celsius - REFERENCE_C);
            let by_mv = tdc.delay_per_mv * millivolts;
            let [of_c, of_mv] = conditions;
            let cause = if by_mv.abs() > by_c.abs() { of_mv } else { of_c };
            ((1.0 + by_c) * (1.0 + by_mv), cause)
        };
        let (now, cause) = by([("tdc.temperature_c", celsius), ("tdc.supply_mv", millivolts)]);
        let (then, cause_then) =
            by([("tdc.calibrated_at_c", at_c), ("tdc.calibrated_at_mv", at_mv)]);
        let calibrated = (then != now).then(|| stretched(&own, then, cycle, cause_then));
        let calibrated = calibrated.transpose()?;
        Ok(Drifted { now: stretched(&own, now, cycle, cause)?, calibrated })
    }
}

/// The delays times `factor`, mostly because of what stands at `key`.
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
        let drifted = Drifted::new(own(), &Tdc::default(), CYCLE).unwrap();
        assert_eq!(drifted, Drifted { now: own(), calibrated: None });
        // Calibrated anew at each temperature.
        let warm = Tdc { temperature_c: 65.0, ..Tdc::default() };
        assert_eq!(Drifted::new(own(), &warm, CYCLE).unwrap().calibrated, None);
    }

    #[test]
    fn forty_degrees_are_four_percent_of_every_delay() {
        let warm = Tdc { temperature_c: 65.0, calibrated_at_c: Some(25.0), ..Tdc::default() };
        let drifted = Drifted::new(own(), &warm, CYCLE).unwrap();
        assert_eq!(drifted.known(), &own());
        for n in [0, 1, 400, 800] {
            let [now, own] = [&drifted.now, &own()].map(|delays| delays.boundary(n).fs() as f64);
            assert!((now / own - 1.04).abs() < 1e-9, "{n}");
        }
        let low = Tdc { supply_mv: -10.0, ..Tdc::default() };
        let slow = Drifted::new(own(), &low, CYCLE).unwrap().now;
        assert_eq!(slow.tap_0().fs(), 2_020_000);
    }

    #[test]
    fn a_chain_that_the_cold_makes_too_short_is_refused_by_key() {
        let scant = Delays::new(Time::from_ns(2), &[10_050; TAPS]).unwrap();
        let cold = Tdc { temperature_c: 5.0, ..Tdc::default() };
        let error = Drifted::new(scant.clone(), &cold, CYCLE).unwrap_err().to_string();
        assert!(error.contains("tdc.temperature_c = 5: with delays 0.9800 times those"), "{error}");
        let then = Tdc { calibrated_at_c: Some(5.0), ..Tdc::default() };
        let error = Drifted::new(scant.clone(), &then, CYCLE).unwrap_err().to_string();
        assert!(error.contains("tdc.calibrated_at_c = 5"), "{error}");
        let high = Tdc { temperature_c: 20.0, supply_mv: 20.0, ..Tdc::default() };
        let error = Drifted::new(scant, &high, CYCLE).unwrap_err().to_string();
        assert!(error.contains("tdc.supply_mv = 20"), "{error}");
    }
}
