//! Ambient light given as an illuminance in klux, of halogen light (thesis eq. 3.15 to 3.18) or of sunlight.
//!
//! Loading a scenario converts it to the spectral irradiance that the rest of the program uses.

mod sun;

use std::f64::consts::PI;

use toml_edit::{Item, Table};

use crate::error::{Input, Result};
use crate::files::toml::Checked;

use super::model::{AmbientSpectrum, Filter, Laser, Scenario};

/// Temperature of the black body that models halogen light (section 3.2.2) [K].
const HALOGEN_K: f64 = 2800.0;
/// Luminous efficacy of that black body, K_0 of eq. 3.15, which the thesis does not state: 683 lm/W weighted with the
/// CIE's V(lambda) of 1924 [lm/W].
const EFFICACY_LM_W: f64 = 14.92;
/// Second radiation constant, h c / k, exact in the SI [m K].
const RADIATION_M_K: f64 = 1.438_776_877e-2;
/// Half width of the integration range over the filter's passband [sigma].
const REACH: f64 = 6.0;
/// Number of integration steps of the black body [1].
const STEPS: u32 = 240;
/// Number of integration steps of sunlight, whose lines are narrow [1].
const SUN_STEPS: u32 = 4800;

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
    let share_per_nm = passband_mean([wavelength_nm, sigma_nm], STEPS, halogen_share_per_nm);
    illuminance_klux * 1e3 / EFFICACY_LM_W * share_per_nm
}

/// Computes the same under sunlight: that of ASTM G173, by the ratio of the illuminances [W/m^2/nm].
pub fn of_sun_w_m2_nm(illuminance_klux: f64, wavelength_nm: f64, sigma_nm: f64) -> f64 {
    let passband = [wavelength_nm, sigma_nm];
    let whole = passband_mean(passband, SUN_STEPS, sun::irradiance_w_m2_nm);
    illuminance_klux * 1e3 / sun::ILLUMINANCE_LX * whole
}

/// Averages a function of the wavelength over a Gaussian passband of that centre and standard deviation [nm].
fn passband_mean([wavelength_nm, sigma_nm]: [f64; 2], steps: u32, of: impl Fn(f64) -> f64) -> f64 {
    let step = 2.0 * REACH / f64::from(steps);
    let (mut sum, mut weights) = (0.0, 0.0);
    for k in 0..=steps {
        let sigmas = f64::from(k) * step - REACH;
        let weight = libm::exp(-0.5 * sigmas * sigmas);
        sum += weight * of(wavelength_nm + sigmas * sigma_nm);
        weights += weight;
    }
    sum / weights
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
///
/// # Errors
/// If the table of sunlight does not reach over the filter's passband.
pub fn settle(scenario: &mut Scenario, checked: &Checked) -> Result<()> {
    let ambient = &mut scenario.ambient;
    let Some(klux) = ambient.illuminance_klux.take() else { return Ok(()) };
    let (Laser { wavelength_nm, .. }, Filter { sigma_nm, .. }) =
        (&scenario.laser, &scenario.filter);
    ambient.irradiance_w_m2_nm = match ambient.spectrum {
        AmbientSpectrum::Halogen => spectral_irradiance_w_m2_nm(klux, *wavelength_nm, *sigma_nm),
        AmbientSpectrum::Sun => {
            check_reach(*wavelength_nm, *sigma_nm, checked)?;
            of_sun_w_m2_nm(klux, *wavelength_nm, *sigma_nm)
        }
    };
    Ok(())
}

/// Checks that the table of sunlight reaches over a passband.
fn check_reach(wavelength_nm: f64, sigma_nm: f64, checked: &Checked) -> Result<()> {
    let (half_nm, [first_nm, last_nm]) =
        (REACH * sigma_nm, [sun::KNOWN_NM.start(), sun::KNOWN_NM.end()]);
    if wavelength_nm - half_nm >= *first_nm && wavelength_nm + half_nm <= *last_nm {
        return Ok(());
    }
    let expected = format!(
        "expected {REACH} filter.sigma_nm ({half_nm} nm) around it within {first_nm} to {last_nm} nm, where sunlight is \
         known (ambient.spectrum)"
    );
    Err(checked.fault("laser.wavelength_nm", expected).value(wavelength_nm).into())
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

    /// Sunlight of ASTM G173 in the visible, every 5 nm from 380 nm [W/m^2/nm].
    const VISIBLE: [f64; 80] = [
        0.70077, 0.67355, 0.79699, 0.80772, 1.1141, 1.1511, 1.0485, 1.2258, 1.1232, 1.2488,
        0.87462, 1.2452, 1.3499, 1.4619, 1.5595, 1.5224, 1.5291, 1.535, 1.5077, 1.6185, 1.6181,
        1.5683, 1.6224, 1.6485, 1.5451, 1.5635, 1.5481, 1.5314, 1.5236, 1.5781, 1.5446, 1.5535,
        1.4825, 1.5435, 1.5399, 1.5634, 1.474, 1.5201, 1.4816, 1.4777, 1.502, 1.5324, 1.3709,
        1.4308, 1.4753, 1.4895, 1.4686, 1.4697, 1.4739, 1.4026, 1.3924, 1.4458, 1.434, 1.4567,
        1.3594, 1.3499, 1.3992, 1.4214, 1.4196, 1.3958, 1.3969, 1.3748, 1.1821, 1.2714, 1.2823,
        1.3214, 1.3175, 1.2587, 0.9855, 1.038, 1.1285, 1.2178, 1.2195, 1.2497, 1.2341, 1.2383,
        0.26604, 0.68601, 1.1608, 1.1771,
    ];

    #[test]
    fn the_suns_illuminance_is_its_spectrum_as_the_eye_sees_it() {
        let v = |k: usize| 0.5 * (V[k / 2] + V[k.div_ceil(2).min(V.len() - 1)]);
        let seen: f64 = VISIBLE.iter().enumerate().map(|(k, e)| 5.0 * e * v(k)).sum();
        // So coarse a sum differs by what falls into or beside Fraunhofer's lines.
        assert!((683.0 * seen / sun::ILLUMINANCE_LX - 1.0).abs() < 5e-3, "{}", 683.0 * seen);
        for (k, e) in VISIBLE.iter().enumerate().skip(44) {
            assert_eq!(sun::irradiance_w_m2_nm(380.0 + 5.0 * k as f64), *e);
        }
    }

    #[test]
    fn the_water_in_the_air_takes_most_of_the_suns_light_about_940_nm() {
        let of_a_klux = |wavelength_nm, sigma_nm| of_sun_w_m2_nm(1.0, wavelength_nm, sigma_nm);
        // Means of the standard's 1 nm values with the weights of the passbands, by another program.
        for (wavelength_nm, sigma_nm, expected) in [
            (940.0, 10.0, 3.383_93e-3),
            (905.0, 10.0, 6.591_55e-3),
            (850.0, 10.0, 8.875_06e-3),
            (940.0, 30.0, 4.989_25e-3),
        ] {
            let found = of_a_klux(wavelength_nm, sigma_nm);
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} for {expected}");
        }
        let halogen = spectral_irradiance_w_m2_nm(1.0, 940.0, 10.0);
        assert!((halogen / of_a_klux(940.0, 10.0) - 12.29).abs() < 0.01, "{halogen}");
        // Within the band and beside it.
        assert!((of_a_klux(935.0, 0.01) * sun::ILLUMINANCE_LX / 1e3 - 0.25084).abs() < 1e-3);
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
