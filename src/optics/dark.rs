//! Avalanches in the dark: how many at a temperature, and how diodes differ.

use crate::kernel::pulse::normal_quantile;
use crate::scenario::Spad;

/// The temperature at which `spad.dark_rate_hz` is stated [deg C].
pub const STATED_AT_C: f64 = 20.0;

/// Dark rate of a diode in the middle of all at the scenario's temperature: it doubles with every
/// `spad.dark_doubling_c` degrees [1/s].
pub fn dark_rate_hz(spad: &Spad) -> f64 {
    spad.dark_rate_hz * libm::exp2((spad.temperature_c - STATED_AT_C) / spad.dark_doubling_c)
}

/// Dark rates of the diodes on the TDC against that, if they differ: the quantiles (k + 1/2) / n of a log-normal
/// distribution, quiet and hot ones side by side in turn, so that no chance decides which there are [1].
pub fn dark_spread(spad: &Spad) -> Vec<f64> {
    let count = spad.on_tdc as usize;
    if spad.dark_spread == 0.0 || count == 1 {
        return Vec::new();
    }
    let quantile = |k: usize| {
        let part = (k as f64 + 0.5) / count as f64;
        libm::exp(spad.dark_spread * normal_quantile(part))
    };
    let place = |k: usize| if k.is_multiple_of(2) { k / 2 } else { count - 1 - k / 2 };
    (0..count).map(|k| quantile(place(k))).collect()
}

/// Dark rate of all diodes on the TDC [1/s].
pub fn dark_rate_on_tdc_hz(spad: &Spad) -> f64 {
    let spread = dark_spread(spad);
    let diodes = match spread.is_empty() {
        true => f64::from(spad.on_tdc),
        false => spread.iter().sum(),
    };
    diodes * dark_rate_hz(spad)
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
        assert!(dark_spread(&spad(1, 1.0)).is_empty());
        assert!(dark_spread(&spad(40, 0.0)).is_empty());
        let mut rates = dark_spread(&spad(39, 0.8));
        assert!(rates[0] < 0.2 && rates[1] > 5.0, "{rates:?}");
        rates.sort_by(f64::total_cmp);
        assert!((rates[19] - 1.0).abs() < 1e-12);
        // The quantile 0.5 / 39 lies 2.2319 deviations below the middle.
        assert!((rates[0] - (-0.8f64 * 2.2319).exp()).abs() < 1e-4, "{}", rates[0]);
        let mean = dark_rate_on_tdc_hz(&spad(40, 0.8)) / 4000.0;
        assert!((mean / (0.32f64).exp() - 1.0).abs() < 0.03, "{mean}");
        assert_eq!(dark_rate_on_tdc_hz(&spad(40, 0.0)), 4000.0);
    }
}
