//! The scenario's keys: type, default, unit, range, meaning and source of each.
//!
//! The attributes of the fields make a JSON Schema, by which [`crate::files::toml::Checked`] checks a TOML document.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::firmware::histogram_builder;

use super::window::Window;

/// Declares one table of the scenario, with the defaults beside the keys. Keys under `beside` do not affect a run and
/// are excluded from the scenario's hash.
macro_rules! table {
    ($(#[$meta:meta])* pub struct $name:ident {
        $($(#[$field_meta:meta])* pub $field:ident: $ty:ty = $default:expr,)*
    } $(beside {
        $($(#[$beside_meta:meta])* pub $beside:ident: $beside_ty:ty,)*
    })?) => {
        $(#[$meta])*
        #[derive(Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(default, deny_unknown_fields)]
        pub struct $name {
            $($(#[$field_meta])* pub $field: $ty,)*
            $($($(#[$beside_meta])* pub $beside: $beside_ty,)*)?
        }

        impl Default for $name {
            fn default() -> Self {
                $name { $($field: $default,)* $($($beside: Default::default(),)*)? }
            }
        }

        impl std::fmt::Debug for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                let mut shown = f.debug_struct(stringify!($name));
                $(shown.field(stringify!($field), &self.$field);)*
                shown.finish()
            }
        }
    };
}

mod array;
mod board;
mod cover;
mod optics;
mod scene;
mod tdc;
mod training;

pub use crate::firmware::tdc_decoder::Decoder;
pub use array::Array;
pub use board::{Control, Estimator, Firmware, Part, Pll, QuenchMode};
pub use cover::Cover;
pub use optics::{Ambient, AmbientModel, AmbientSpectrum, DeadTimeKind, Filter, Laser, Lens, Spad};
pub use scene::{Atmosphere, Shape, Target, VisibilityModel};
pub use tdc::{Tdc, TdcCalibration};
pub use training::{Training, WordFormats};

table! {
    /// One experiment: target, illumination, sensor, firmware and outputs.
    pub struct Scenario {
        /// Description of the scenario.
        pub description: String = String::new(),
        /// Seed of all random streams.
        pub seed: u64 = 1,
        /// The target.
        pub target: Target = Target::default(),
        /// The air between sensor and target.
        pub atmosphere: Atmosphere = Atmosphere::default(),
        /// The cover window in front of laser and lens.
        pub cover: Cover = Cover::default(),
        /// Ambient light.
        pub ambient: Ambient = Ambient::default(),
        /// The VCSEL.
        pub laser: Laser = Laser::default(),
        /// The receiving optics.
        pub lens: Lens = Lens::default(),
        /// The bandpass filter in front of the sensor.
        pub filter: Filter = Filter::default(),
        /// The detector.
        pub spad: Spad = Spad::default(),
        /// The array of pixels.
        pub array: Array = Array::default(),
        /// The clock generator.
        pub pll: Pll = Pll::default(),
        /// The time-to-digital converter.
        pub tdc: Tdc = Tdc::default(),
        /// Control signals at power-up, and frame parameters.
        pub firmware: Firmware = Firmware::default(),
        /// The depth estimator.
        pub estimator: Estimator = Estimator::default(),
        /// Files that replace parts of the signal chain.
        pub stimulus: Stimulus = Stimulus::default(),
        /// Additional outputs of a run.
        pub report: Report = Report::default(),
        /// Changes of the control signals during the run, in order of time.
        pub control: Vec<Control> = Vec::new(),
    } beside {
        /// Defaults of `train` and `build` for this instrument's network; options override them.
        #[serde(skip_serializing_if = "Training::is_default")]
        pub training: Training,
    }
}

impl Scenario {
    /// Returns the size of the histogram.
    pub fn histogram(&self) -> histogram_builder::Params {
        let (bins, count_bits) = (self.tdc.bins as usize, self.firmware.count_bits);
        histogram_builder::Params { bins, count_bits }
    }
}

table! {
    /// Files that replace parts of the signal chain. At most one may be given; without any, the sensor sees the
    /// simulated light.
    pub struct Stimulus {
        /// Photon list: a CSV file with columns `shot` (since power-up, from 0) and `arrival_ps` (from the laser
        /// edge). Replaces the light.
        #[schemars(extend("source" = "thesis 6.5.2"))]
        pub photons: Option<String> = None,
        /// Preloaded TDC codes: a CSV file with column `code`, one per shot. Replaces the TDC.
        #[schemars(extend("source" = "thesis 6.6.1"))]
        pub codes: Option<String> = None,
        /// Preloaded histogram: a CSV file with columns `bin` and `count`. Replaces the histogram.
        #[schemars(extend("source" = "thesis 6.7.4"))]
        pub histogram: Option<String> = None,
    }
}

table! {
    /// Additional outputs of a run.
    pub struct Report {
        /// Report the TDC result of each shot (thesis Table 6.3).
        #[schemars(extend("source" = "Table 6.3"))]
        pub tdc: bool = false,
        /// Parts of the run to write to the waveform if `--window` is not given; an empty list means `shot:0..16` and
        /// `estimation`.
        #[schemars(extend("source" = "choice: a first look under 5 MB"))]
        #[schemars(with = "Vec<String>")]
        pub windows: Vec<Window> = Vec::new(),
    }
}
