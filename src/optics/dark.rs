//! Dark count rates: their dependence on temperature and their spread over SPADs.

use std::ops::Range;

use crate::kernel::pulse::normal_quantile;
use crate::scenario::Spad;
use crate::scenario::wiring::{ON_TDC, Wiring};

/// Temperature at which `spad.dark_rate_hz` is stated [deg C].
pub const STATED_AT_C: f64 = 20.0;

/// The part of a turn by which successive steps are spread best over turns (golden section) [1].
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// Returns the median dark count rate at the scenario's temperature, which doubles every `spad.dark_doubling_c`
/// degrees [1/s].
pub fn dark_rate_hz(spad: &Spad) -> f64 {
    spad.dark_rate_hz * growth(spad)
}

/// Returns the factor on dark count rates from 20 deg C to the scenario's temperature [1].
fn growth(spad: &Spad) -> f64 {
    libm::exp2((spad.temperature_c - STATED_AT_C) / spad.dark_doubling_c)
}

/// Dark count rates of the simulated outputs of the row.
#[derive(Clone, Debug, PartialEq)]
pub struct DarkRates {
    /// Rate of each output, in units of `unit_hz`; empty if all are 1 [1].
    parts: Vec<f64>,
    /// Unit of the relative rates [1/s].
    unit_hz: f64,
    wiring: Wiring,
    /// Rate of output 15 alone [1/s].
    one_hz: f64,
}

impl DarkRates {
    /// Computes the rates of a detector: equal, spread, or measured for each output of the row [1/s].
    pub fn new(spad: &Spad, measured: Option<&[Option<f64>]>) -> Self {
        let (wiring, middle_hz) = (Wiring::of(spad), dark_rate_hz(spad));
        let count = wiring.simulated.len();
        let Some(measured) = measured else {
            let parts = if count == 1 { Vec::new() } else { quantiles(spad.dark_spread, count) };
            return DarkRates { parts, unit_hz: middle_hz, wiring, one_hz: middle_hz };
        };
        let rate = |output| measured.get(output).copied().flatten().unwrap_or(spad.dark_rate_hz);
        let (parts, unit_hz) = (wiring.simulated.clone().map(rate).collect(), growth(spad));
        DarkRates { parts, unit_hz, wiring, one_hz: rate(ON_TDC) * unit_hz }
    }

    /// Computes the rate of the pixel with such a number: measured, or one of a log-normal distribution whose
    /// quantiles lie scattered over the numbers, so that the rates are not random [1/s].
    pub fn of_pixel(spad: &Spad, measured: Option<f64>, number: usize) -> Self {
        let spread = || {
            let part = ((number as f64 + 0.5) * GOLDEN).fract();
            let factor = if spad.dark_spread == 0.0 { 1.0 } else { spread(spad.dark_spread, part) };
            spad.dark_rate_hz * factor
        };
        let one_hz = measured.unwrap_or_else(spread) * growth(spad);
        DarkRates { parts: Vec::new(), unit_hz: one_hz, wiring: Wiring::of(spad), one_hz }
    }

    /// Returns the total rate of the outputs connected to the TDC [1/s].
    pub fn on_tdc_hz(&self) -> f64 {
        self.sum_hz(self.wiring.places())
    }

    /// Returns the total rate of all simulated outputs [1/s].
    pub fn of_row_hz(&self) -> f64 {
        self.sum_hz(0..self.wiring.simulated.len())
    }

    /// Returns the rate of a single SPAD: output 15 if measured, otherwise the median [1/s].
    pub fn one_hz(&self) -> f64 {
        self.one_hz
    }

    /// Returns the relative rates of all outputs, if several outputs differ [1].
    pub fn parts(&self) -> &[f64] {
        if self.parts.len() > 1 { &self.parts } else { &[] }
    }

    fn sum_hz(&self, places: Range<usize>) -> f64 {
        let parts = if self.parts.is_empty() {
            places.len() as f64
        } else {
            self.parts.iter().skip(places.start).take(places.len()).sum()
        };
        parts * self.unit_hz
    }
}

/// Returns the quantiles (k + 1/2) / n of a log-normal distribution, with low and high ones alternating, so that the
/// rates are not random; empty if all are equal [1].
fn quantiles(spread: f64, count: usize) -> Vec<f64> {
    if spread == 0.0 {
        return Vec::new();
    }
    let quantile = |k: usize| self::spread(spread, (k as f64 + 0.5) / count as f64);
    let place = |k: usize| if k.is_multiple_of(2) { k / 2 } else { count - 1 - k / 2 };
    (0..count).map(|k| quantile(place(k))).collect()
}

/// Returns a quantile of the log-normal distribution with median 1.
fn spread(spread: f64, part: f64) -> f64 {
    libm::exp(spread * normal_quantile(part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dark_rate_doubles_with_its_degrees_and_is_as_stated_at_20() {
        let at = |temperature_c| {
            dark_rate_hz(&Spad { temperature_c, dark_doubling_c: 8.0, ..Spad::default() })
        };
        assert_eq!(at(20.0), 100.0);
        assert_eq!(at(28.0), 200.0);
        assert_eq!(at(36.0), 400.0);
        assert_eq!(at(-12.0), 6.25);
        // An Arrhenius law about 20 degrees, 0.69 (293 K)^2 k_B / 8 K = 0.64 eV, is near it.
        let arrhenius = |c: f64| {
            let inverse_k = 1.0 / (c + 273.15) - 1.0 / 293.15;
            100.0 * (-0.6415 / 8.617_333e-5 * inverse_k).exp()
        };
        assert!((at(25.0) / arrhenius(25.0) - 1.0).abs() < 0.01, "{}", arrhenius(25.0));
    }

    #[test]
    fn diodes_that_differ_have_the_median_and_the_mean_of_a_log_normal_distribution() {
        let spad = |on_tdc, dark_spread| Spad { on_tdc, dark_spread, ..Spad::default() };
        let rates = |on_tdc, dark_spread| DarkRates::new(&spad(on_tdc, dark_spread), None);
        assert!(rates(1, 1.0).parts().is_empty() && rates(40, 0.0).parts().is_empty());
        let (on_tdc, parts) = (rates(40, 0.8).on_tdc_hz(), rates(39, 0.8).parts().to_vec());
        let (alike_hz, mut rates) = (rates(40, 0.0).on_tdc_hz(), parts);
        assert!(rates[0] < 0.2 && rates[1] > 5.0, "{rates:?}");
        rates.sort_by(f64::total_cmp);
        assert!((rates[19] - 1.0).abs() < 1e-12);
        // The quantile 0.5 / 39 lies 2.2319 deviations below the middle.
        assert!((rates[0] - (-0.8f64 * 2.2319).exp()).abs() < 1e-4, "{}", rates[0]);
        let mean = on_tdc / 4000.0;
        assert!((mean / (0.32f64).exp() - 1.0).abs() < 0.03, "{mean}");
        assert_eq!(alike_hz, 4000.0);
    }

    #[test]
    fn of_a_row_those_on_the_tdc_have_their_own_share() {
        let spad = Spad { on_tdc: 3, row_outputs: 30, dark_spread: 0.8, ..Spad::default() };
        let rates = DarkRates::new(&spad, None);
        let whole = DarkRates::new(&Spad { on_tdc: 30, row_outputs: 0, ..spad }, None);
        assert_eq!(rates.parts(), whole.parts());
        assert_eq!(rates.of_row_hz(), whole.on_tdc_hz());
        assert_eq!(rates.on_tdc_hz(), 100.0 * whole.parts()[14..17].iter().sum::<f64>());
        assert_eq!(rates.one_hz(), 100.0);
    }

    #[test]
    fn pixels_have_rates_of_the_distribution_or_measured_ones() {
        let spad = Spad { dark_spread: 0.8, temperature_c: 28.0, ..Spad::default() };
        let of = |place| DarkRates::of_pixel(&spad, None, place).on_tdc_hz();
        let mut rates: Vec<_> = (0..1200).map(of).collect();
        let mean = rates.iter().sum::<f64>() / 1200.0;
        assert!((mean / (200.0 * (0.32f64).exp()) - 1.0).abs() < 0.01, "{mean}");
        // Neighbours in a row and in a column differ.
        assert!(rates.windows(31).all(|part| part[1] != part[0] && part[30] != part[0]));
        rates.sort_by(f64::total_cmp);
        assert!((rates[600] / 200.0 - 1.0).abs() < 0.01, "{}", rates[600]);
        let measured = DarkRates::of_pixel(&spad, Some(40.0), 7);
        assert_eq!(
            (measured.on_tdc_hz(), measured.of_row_hz(), measured.one_hz()),
            (80.0, 80.0, 80.0)
        );
    }

    #[test]
    fn measured_rates_are_those_of_the_outputs_and_grow_with_temperature_as_all_do() {
        let mut measured = [None; 30];
        (measured[15], measured[16], measured[2]) = (Some(500.0), Some(0.0), Some(9000.0));
        let rates = |on_tdc, row_outputs| {
            let spad = Spad { on_tdc, row_outputs, temperature_c: 28.0, ..Spad::default() };
            let rates = DarkRates::new(&spad, Some(&measured[..]));
            (rates.on_tdc_hz(), rates.of_row_hz(), rates.one_hz())
        };
        assert_eq!(rates(1, 0), (1000.0, 1000.0, 1000.0));
        assert_eq!(rates(3, 0), (1200.0, 1200.0, 1000.0), "14 is not named");
        assert_eq!(rates(3, 30), (1200.0, 2.0 * (500.0 + 9000.0 + 27.0 * 100.0), 1000.0));
        assert_eq!(
            rates(40, 0).0,
            2.0 * (500.0 + 9000.0 + 37.0 * 100.0),
            "the others are not measured"
        );
    }
}
