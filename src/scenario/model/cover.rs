//! Keys of the cover window.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Temperature at which the fraction of a window is stated [degC].
const STATED_AT_C: f64 = 20.0;

table! {
    /// The cover window in front of laser and lens, which sends a part of each pulse back to the detector. By default
    /// there is none.
    pub struct Cover {
        /// Fraction of the pulse energy that the clean window sends to the lens's aperture from within the field of view,
        /// at 20 deg C. In an array, each pixel has the part of its solid angle; 0: no window.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "choice: none, as in the thesis"))]
        pub fraction: f64 = 0.0,
        /// Fraction for each pixel of an array, in place of `cover.fraction`: a CSV file with the columns `row`, `column`
        /// and `fraction`, and a line for each pixel.
        #[schemars(extend("source" = "choice: none"))]
        pub fraction_file: Option<String> = None,
        /// Time of flight of that light: its delay after light that leaves the laser, so that `laser.delay_ps` comes on
        /// top.
        #[schemars(range(min = 0.0, max = 1e6), extend("unit" = "ps", "source" = "choice: a window 1.5 cm in front"))]
        pub delay_ps: f64 = 100.0,
        /// Standard deviation of the delay, which is normal: the light comes with the laser's pulse, convolved with it.
        #[schemars(range(min = 0.0, max = 2000.0), extend("unit" = "ps", "source" = "choice: none"))]
        pub width_ps: f64 = 0.0,
        /// Fraction of the window's light that has an additional, exponential delay: multiple reflections and scattering
        /// by dirt.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "choice: none"))]
        pub smear_fraction: f64 = 0.0,
        /// Mean of that additional delay.
        #[schemars(range(min = 1.0, max = 20_000.0), extend("unit" = "ps", "source" = "choice: a few reflections over some centimetres"))]
        pub smear_ps: f64 = 300.0,
        /// Relative change of the fraction per kelvin of `spad.temperature_c`.
        #[schemars(range(min = -0.1, max = 0.1), extend("unit" = "1/K", "source" = "choice: none"))]
        pub temperature_coefficient_per_k: f64 = 0.0,
        /// Growth of the fraction by dirt, over the whole field of view.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1/h", "source" = "choice: none"))]
        pub dirt_per_h: f64 = 0.0,
        /// Time since the window was clean. A run is so short that its dirt does not change.
        #[schemars(range(min = 0.0, max = 1e6), extend("unit" = "h", "source" = "choice: just cleaned"))]
        pub age_h: f64 = 0.0,
    }
}

impl Cover {
    /// Returns the factor of the fraction at a temperature of the sensor [degC].
    pub fn temperature_factor(&self, temperature_c: f64) -> f64 {
        1.0 + self.temperature_coefficient_per_k * (temperature_c - STATED_AT_C)
    }

    /// Returns the fraction by dirt, of the whole field of view [1].
    pub fn dirt(&self) -> f64 {
        self.dirt_per_h * self.age_h
    }

    /// Returns whether it sends any light back.
    pub fn is_there(&self) -> bool {
        self.fraction > 0.0 || self.fraction_file.is_some() || self.dirt() > 0.0
    }
}
