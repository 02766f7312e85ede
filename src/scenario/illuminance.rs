//! Ambient light given as an illuminance in klux of halogen light (thesis eq. 3.15 to 3.18).
//!
//! Loading a scenario converts it to the spectral irradiance that the rest of the program uses.

use std::f64::consts::PI;

use toml_edit::{Item, Table};

use crate::error::{Input, Result};
use crate::files::toml::Checked;

use super::model::Scenario;

/// Temperature of the black body that models halogen light (section 3.2.2) [K].
const HALOGEN_K: f64 = 2800.0;
/// Luminous efficacy of that black body, K_0 of eq. 3.15, which the thesis does not state: 683 lm/W weighted with the
/// CIE's V(lambda) of 1924 [lm/W].
const EFFICACY_LM_W: f64 = 14.92;
/// Second radiation constant, h c / k, exact in the SI [m K].
const RADIATION_M_K: f64 = 1.438_776_877e-2;
/// Half width of the integration range over the filter's passband [sigma].
const REACH: f64 = 6.0;
/// Number of integration steps [1].
const STEPS: u32 = 240;

const TABLE: &str = "ambient";
const ILLUMINANCE: &str = "illuminance_klux";
const IRRADIANCE: &str = "irradiance_w_m2_nm";

/// Computes the mean spectral irradiance within a filter's passband under halogen light: E_v C_0 / K_0 by eq. 3.15
/// and 3.18, per nanometre of the passband of eq. 3.17 [W/m^2/nm].
///
/// The filter's peak efficiency is excluded, because the link budget applies it.
pub fn spectral_irradiance_w_m2_nm(
    illuminance_klux: f64,
    wavelength_nm: f64,
    sigma_nm: f64,
) -> f64 {
    let step = 2.0 * REACH / f64::from(STEPS);
    let (mut sum, mut weights) = (0.0, 0.0);
    for k in 0..=STEPS {
        let sigmas = f64::from(k) * step - REACH;
        let weight = libm::exp(-0.5 * sigmas * sigmas);
        sum += weight * halogen_share_per_nm(wavelength_nm + sigmas * sigma_nm);
        weights += weight;
    }
    illuminance_klux * 1e3 / EFFICACY_LM_W * (sum / weights)
}

/// Returns the fraction of the black body's power per wavelength: eq. 3.16 over its integral [1/nm].
fn halogen_share_per_nm(wavelength_nm: f64) -> f64 {
    if wavelength_nm < 1.0 {
        return 0.0;
    }
    let x = RADIATION_M_K / (wavelength_nm * 1e-9 * HALOGEN_K);
    let per_m = 15.0 / PI.powi(4) * x.powi(5) / libm::expm1(x) * HALOGEN_K / RADIATION_M_K;
    per_m * 1e-9
}

/// Converts the illuminance, if one is given, to a spectral irradiance.
pub fn settle(scenario: &mut Scenario) {
    let (laser, filter) = (&scenario.laser, &scenario.filter);
    let ambient = &mut scenario.ambient;
    if let Some(klux) = ambient.illuminance_klux.take() {
        ambient.irradiance_w_m2_nm =
            spectral_irradiance_w_m2_nm(klux, laser.wavelength_nm, filter.sigma_nm);
    }
}

/// Removes the file's ambient light from `table` if the overrides set it in the other unit.
///
/// # Errors
/// If the file or the overrides set both the illuminance and the irradiance.
pub fn settle_overrides(checked: &Checked, table: &mut Table, overrides: &Table) -> Result<()> {
    let expected = |option: &str| {
        format!(
            "expected one statement of the ambient light, {option}{TABLE}.{IRRADIANCE} is given too"
        )
    };
    let key = format!("{TABLE}.{ILLUMINANCE}");
    if says(table, ILLUMINANCE).is_some() && says(table, IRRADIANCE).is_some() {
        return Err(checked.fault(&key, expected("")).into());
    }
    let stale = match (says(overrides, ILLUMINANCE), says(overrides, IRRADIANCE)) {
        (Some(_), Some(_)) => {
            return Err(Input::new(format!("-s {key}"), expected("-s ")).into());
        }
        (Some(_), None) => IRRADIANCE,
        (None, Some(_)) => ILLUMINANCE,
        (None, None) => return Ok(()),
    };
    if let Some(ambient) = table.get_mut(TABLE).and_then(Item::as_table_like_mut) {
        ambient.remove(stale);
    }
    Ok(())
}

fn says<'a>(table: &'a Table, key: &str) -> Option<&'a Item> {
    table.get(TABLE)?.as_table_like()?.get(key)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The CIE's photopic luminosity function V(lambda) of 1924, every 10 nm from 380 nm [1].
    const V: [f64; 40] = [
        0.000039, 0.00012, 0.000396, 0.00121, 0.0040, 0.0116, 0.023, 0.038, 0.060, 0.09098,
        0.13902, 0.20802, 0.323, 0.503, 0.710, 0.862, 0.954, 0.99495, 0.995, 0.952, 0.870, 0.757,
        0.631, 0.503, 0.381, 0.265, 0.175, 0.107, 0.061, 0.032, 0.017, 0.00821, 0.004102, 0.002091,
        0.001047, 0.00052, 0.000249, 0.00012, 0.00006, 0.00003,
    ];

    #[test]
    fn the_black_bodys_shares_add_up_and_its_efficacy_is_that_of_the_eye() {
        let whole: f64 = (1..200_000).map(|nm| halogen_share_per_nm(f64::from(nm))).sum();
        assert!((whole - 1.0).abs() < 1e-4, "{whole}");
        let at = |k: usize| halogen_share_per_nm(380.0 + 10.0 * k as f64);
        let seen: f64 = V.iter().enumerate().map(|(k, v)| 10.0 * v * at(k)).sum();
        assert!((683.0 * seen / EFFICACY_LM_W - 1.0).abs() < 1e-3, "{}", 683.0 * seen);
    }

    #[test]
    fn the_thesis_14_klux_are_0_58_w_m2_nm_and_0_39_after_the_filters_67_percent() {
        let irradiance = spectral_irradiance_w_m2_nm(14.0, 940.0, 10.0);
        assert!((irradiance - 0.582).abs() < 1e-3, "{irradiance}");
        assert!((0.67 * irradiance - 0.39).abs() < 1e-3, "similar to 0.4 (section 4.2)");
        let filtered_w_m2 = irradiance * (2.0 * PI).sqrt() * 10.0;
        let c_0 = filtered_w_m2 / (14e3 / EFFICACY_LM_W);
        assert!((c_0 / 0.01556 - 1.0).abs() < 1e-3, "C_0 of eq. 3.18: {c_0}");
    }

    #[test]
    fn a_wide_filter_sees_the_mean_of_what_it_lets_through() {
        let (sigma, centre) = (80.0, 940.0);
        let weight = |nm: f64| (-0.5 * ((nm - centre) / sigma).powi(2)).exp();
        let wavelengths = || (100..3000).map(f64::from);
        let power: f64 = wavelengths().map(|nm| weight(nm) * halogen_share_per_nm(nm)).sum();
        let expected = power / wavelengths().map(weight).sum::<f64>() * 5e3 / EFFICACY_LM_W;
        let found = spectral_irradiance_w_m2_nm(5.0, centre, sigma);
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
        assert!(spectral_irradiance_w_m2_nm(5.0, 700.0, 200.0).is_finite());
    }
}
