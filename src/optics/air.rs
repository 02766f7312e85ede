//! Attenuation and scattering of light by the air, with published coefficients of fog and rain.

use std::f64::consts::LN_10;

use crate::scenario::{Atmosphere, Scenario, VisibilityModel};

/// Wavelength at which visibility is defined [nm].
const STATED_NM: f64 = 550.0;

/// The air between sensor and target, which is homogeneous.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Air {
    /// Extinction coefficient [1/m].
    pub extinction_per_m: f64,
    /// Backscatter coefficient [1/(m sr)].
    pub backscatter_per_m_sr: f64,
    /// Distance below which the air returns no light to the sensor [m].
    pub from_m: f64,
    /// Ambient light scattered by an infinite depth of air, relative to a white target [1].
    pub airlight: f64,
}

impl Air {
    /// Returns the air of a scenario.
    pub fn of(scenario: &Scenario) -> Self {
        let keys = &scenario.atmosphere;
        let extinction_per_m = fog_per_m(keys, scenario.laser.wavelength_nm) + rain_per_m(keys);
        Air {
            extinction_per_m,
            backscatter_per_m_sr: extinction_per_m / keys.lidar_ratio_sr,
            from_m: keys.overlap_m,
            airlight: keys.airlight,
        }
    }

    /// Returns the transmission over a path [m] by the Beer-Lambert law [1].
    pub fn passes(&self, way_m: f64) -> f64 {
        libm::exp(-self.extinction_per_m * way_m)
    }

    /// Returns the backscatter from distances `near_m` to `far_m`, per steradian of the beam, by the lidar equation.
    /// The section must be so short that the extinction at its middle represents all of it [1/(m^2 sr)].
    pub fn sends_back(&self, near_m: f64, far_m: f64) -> f64 {
        let way_m = near_m + far_m;
        self.backscatter_per_m_sr * (1.0 / near_m - 1.0 / far_m) * self.passes(way_m)
    }
}

/// Returns the extinction by fog or haze: Koschmieder's law at 550 nm, scaled by a power of the wavelength [1/m].
fn fog_per_m(keys: &Atmosphere, wavelength_nm: f64) -> f64 {
    if keys.visibility_m == 0.0 {
        return 0.0;
    }
    let exponent = exponent(keys.visibility_model, keys.visibility_m / 1000.0);
    let stated = -libm::log(keys.visibility_contrast) / keys.visibility_m;
    stated * libm::pow(wavelength_nm / STATED_NM, -exponent)
}

/// Returns the wavelength exponent of extinction for a visibility [km]: Kruse et al. 1962, or Kim et al., Proc. SPIE
/// 4214 (2001), which differs below 6 km [1].
fn exponent(model: VisibilityModel, visibility_km: f64) -> f64 {
    match (model, visibility_km) {
        (VisibilityModel::Flat, _) => 0.0,
        (_, 50.0..) => 1.6,
        (_, 6.0..) => 1.3,
        (VisibilityModel::Kruse, _) => 0.585 * libm::cbrt(visibility_km),
        (_, 1.0..) => 0.16 * visibility_km + 0.34,
        (_, 0.5..) => visibility_km - 0.5,
        _ => 0.0,
    }
}

/// Returns the extinction by rain, which does not depend on the wavelength because drops are much larger [1/m].
fn rain_per_m(keys: &Atmosphere) -> f64 {
    if keys.rain_mm_h == 0.0 {
        return 0.0;
    }
    let db_per_km = keys.rain_db_km * libm::pow(keys.rain_mm_h, keys.rain_exponent);
    db_per_km * LN_10 / 10.0 / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn air(change: impl FnOnce(&mut Scenario)) -> Air {
        let mut scenario = Scenario::default();
        change(&mut scenario);
        Air::of(&scenario)
    }

    fn assert_close(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} for {expected}");
    }

    #[test]
    fn clear_air_does_nothing() {
        let clear = air(|_| ());
        assert_eq!((clear.extinction_per_m, clear.backscatter_per_m_sr), (0.0, 0.0));
        assert_eq!(clear.passes(1000.0), 1.0);
    }

    #[test]
    fn fog_leaves_a_fiftieth_of_the_light_at_its_visibility() {
        let fog = air(|s| s.atmosphere.visibility_m = 100.0);
        assert_close(fog.extinction_per_m, 3.912 / 100.0);
        assert_close(fog.passes(100.0), 0.02);
        assert_close(fog.extinction_per_m / fog.backscatter_per_m_sr, 18.8);
        let of_wmo = air(|s| {
            s.atmosphere.visibility_m = 100.0;
            s.atmosphere.visibility_contrast = 0.05;
        });
        assert_close(of_wmo.extinction_per_m, 2.996 / 100.0);
    }

    #[test]
    fn haze_goes_with_the_wavelength_by_the_exponents_of_kim_and_kruse() {
        use VisibilityModel::{Flat, Kim, Kruse};
        let exponents = |model| [0.3, 0.8, 3.0, 10.0, 60.0].map(|km| exponent(model, km));
        for (model, expected) in [
            (Kim, [0.0, 0.3, 0.82, 1.3, 1.6]),
            (Kruse, [0.3916, 0.5431, 0.8437, 1.3, 1.6]),
            (Flat, [0.0; 5]),
        ] {
            for (found, expected) in exponents(model).into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-4, "{model:?}: {found} for {expected}");
            }
        }
        let haze = air(|s| s.atmosphere.visibility_m = 10_000.0);
        assert_close(haze.extinction_per_m, 3.912e-4 * (550.0f64 / 940.0).powf(1.3));
    }

    #[test]
    fn rain_takes_the_published_decibels() {
        let rain = air(|s| s.atmosphere.rain_mm_h = 25.0);
        let db = -10.0 * rain.passes(1000.0).log10();
        assert_close(db, 1.076 * 25f64.powf(0.67));
        let both = air(|s| (s.atmosphere.rain_mm_h, s.atmosphere.visibility_m) = (25.0, 50.0));
        assert_close(both.extinction_per_m, rain.extinction_per_m + 3.912 / 50.0);
    }

    #[test]
    fn what_air_sends_back_falls_with_the_square_of_its_distance() {
        let fog = air(|s| s.atmosphere.visibility_m = 1e6);
        let (near, far) = (fog.sends_back(1.0, 1.0001), fog.sends_back(2.0, 2.0001));
        assert_close(near / far, 4.0);
        assert_close(near, fog.backscatter_per_m_sr * 0.0001);
    }
}
