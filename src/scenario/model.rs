//! The scenario's keys: type, default, unit, range, meaning and source of each.
//!
//! The attributes are the checker: [`super::check`] walks a TOML document by the JSON Schema that
//! they make.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Declares one table of the scenario, with the defaults beside the keys.
macro_rules! table {
    ($(#[$meta:meta])* pub struct $name:ident {
        $($(#[$field_meta:meta])* pub $field:ident: $ty:ty = $default:expr,)*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(default, deny_unknown_fields)]
        pub struct $name { $($(#[$field_meta])* pub $field: $ty,)* }

        impl Default for $name {
            fn default() -> Self {
                $name { $($field: $default,)* }
            }
        }
    };
}

table! {
    /// One experiment: target, light, sensor, firmware and what is recorded of it.
    pub struct Scenario {
        /// What the scenario shows.
        pub description: String = String::new(),
        /// Seed of every random stream.
        pub seed: u64 = 1,
        /// What is measured.
        pub target: Target = Target::default(),
        /// Light that is not ours.
        pub ambient: Ambient = Ambient::default(),
        /// The VCSEL.
        pub laser: Laser = Laser::default(),
        /// The receiving optics.
        pub lens: Lens = Lens::default(),
        /// The bandpass filter before the sensor.
        pub filter: Filter = Filter::default(),
        /// The detector.
        pub spad: Spad = Spad::default(),
        /// The clock generator.
        pub pll: Pll = Pll::default(),
        /// The time-to-digital converter.
        pub tdc: Tdc = Tdc::default(),
        /// Control signals at power-up, and the frame.
        pub firmware: Firmware = Firmware::default(),
        /// The depth estimator.
        pub estimator: Estimator = Estimator::default(),
        /// What stands in for parts of the chain.
        pub stimulus: Stimulus = Stimulus::default(),
        /// What the run reports beside depths.
        pub report: Report = Report::default(),
        /// Changes of the control signals during the run, in order of time.
        pub control: Vec<Control> = Vec::new(),
    }
}

table! {
    /// What is measured: a rectangle, perpendicular to the axis, centred on it.
    pub struct Target {
        /// Distance from the sensor. An echo must arrive within the shortest laser period.
        #[schemars(range(min = 0.001, max = 6.9), extend("unit" = "m", "source" = "Table 3.2: 0.1 .. 0.6"))]
        pub distance_m: f64 = 0.5,
        /// Fraction of light that is diffused back.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "Table 3.2: 0.08 .. 0.60"))]
        pub reflectance: f64 = 0.34,
        /// Length of the target.
        #[schemars(range(min = 0.0001, max = 1000.0), extend("unit" = "m", "source" = "Table 3.2"))]
        pub length_m: f64 = 0.26,
        /// Width of the target.
        #[schemars(range(min = 0.0001, max = 1000.0), extend("unit" = "m", "source" = "Table 3.2"))]
        pub width_m: f64 = 0.20,
        /// Sub-elements of the lit part of a quadrant, along each side (eq. 3.6).
        #[schemars(range(min = 8, max = 4096), extend("unit" = "1", "source" = "choice: below 0.05 % of error"))]
        pub cells: u32 = 128,
    }
}

/// How ambient irradiance becomes a rate of avalanches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AmbientModel {
    /// Proportional to irradiance and reflectance, fitted to Table 4.3.
    #[default]
    Fitted,
    /// From the optics (eq. 3.19 and 3.20 with their missing factors); pi times more.
    Physical,
}

table! {
    /// Light that is not ours, reflected by the target.
    pub struct Ambient {
        /// How irradiance becomes a rate of avalanches: `fitted` or `physical`.
        pub model: AmbientModel = AmbientModel::Fitted,
        /// Spectral irradiance of the target at the laser's wavelength; 0 switches it off.
        #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "W/m^2/nm", "source" = "section 4.2: 0 .. 0.4"))]
        pub irradiance_w_m2_nm: f64 = 0.2,
        /// Rate of the fitted model at reflectance 1 and a detection efficiency of 0.003.
        #[schemars(range(min = 0.0, max = 1e12), extend("unit" = "1/s per W/m^2/nm", "source" = "fitted to Table 4.3"))]
        pub fitted_rate_hz_per_w_m2_nm: f64 = 3.968e9,
    }
}

table! {
    /// The VCSEL.
    pub struct Laser {
        /// Average power at `repetition_rate_hz`; their ratio, the pulse energy, is what is held.
        #[schemars(range(min = 0.0, max = 10.0), extend("unit" = "W", "source" = "Table 3.2"))]
        pub average_power_w: f64 = 7.36e-3,
        /// Rate at which the average power is stated. The firmware's rate is `firmware.laser_freq`.
        #[schemars(range(min = 1.0, max = 1e9), extend("unit" = "Hz", "source" = "Table 3.2"))]
        pub repetition_rate_hz: f64 = 40e6,
        /// Wavelength.
        #[schemars(range(min = 700.0, max = 1050.0), extend("unit" = "nm", "source" = "Table 3.2"))]
        pub wavelength_nm: f64 = 940.0,
        /// Standard deviation of the pulse as the detector times it.
        #[schemars(range(min = 1.0, max = 2000.0), extend("unit" = "ps", "source" = "fitted to Table 5.2"))]
        pub pulse_sigma_ps: f64 = 137.0,
        /// Full angle of the illuminated cone (FOI).
        #[schemars(range(min = 0.1, max = 170.0), extend("unit" = "deg", "source" = "Table 3.2"))]
        pub field_of_illumination_deg: f64 = 21.0,
    }
}

table! {
    /// The receiving lens.
    pub struct Lens {
        /// Area.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "m^2", "source" = "Table 3.2"))]
        pub area_m2: f64 = 9.5e-5,
        /// Transmission.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "Table 3.2"))]
        pub efficiency: f64 = 0.8,
    }
}

table! {
    /// The bandpass filter before the sensor.
    pub struct Filter {
        /// Transmission at the laser's wavelength.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "Table 3.2"))]
        pub efficiency: f64 = 0.67,
        /// Standard deviation of the Gaussian passband.
        #[schemars(range(min = 0.01, max = 200.0), extend("unit" = "nm", "source" = "eq. 3.17"))]
        pub sigma_nm: f64 = 10.0,
    }
}

table! {
    /// The detector.
    pub struct Spad {
        /// Photon detection probability.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "section 4.2, after Table 3.2"))]
        pub pdp: f64 = 0.012,
        /// Fill factor.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "Table 3.2"))]
        pub fill_factor: f64 = 0.25,
        /// SPADs that share the light; one of them is connected.
        #[schemars(range(min = 1, max = 1_000_000), extend("unit" = "1", "source" = "Table 3.2"))]
        pub count: u32 = 40,
        /// Full angle of the field of view (FOV).
        #[schemars(range(min = 0.1, max = 170.0), extend("unit" = "deg", "source" = "Table 3.2"))]
        pub field_of_view_deg: f64 = 24.0,
        /// Time from an avalanche to the next possible one in MODE 1.
        #[schemars(range(min = 5.0, max = 1e6), extend("unit" = "ns", "source" = "Table 3.2"))]
        pub dead_time_ns: f64 = 20.0,
        /// Rate of avalanches in the dark; 0 switches them off.
        #[schemars(range(min = 0.0, max = 1e9), extend("unit" = "1/s", "source" = "choice: a quiet CMOS SPAD"))]
        pub dark_rate_hz: f64 = 100.0,
    }
}

table! {
    /// The clock generator. The outputs have to be 125 and 250 MHz.
    pub struct Pll {
        /// Oscillator of the board.
        #[schemars(range(min = 19_000_000, max = 800_000_000), extend("unit" = "Hz", "source" = "KC705: SiT9102"))]
        pub input_hz: u64 = 200_000_000,
        /// Feedback divider M.
        #[schemars(range(min = 2, max = 64), extend("unit" = "1", "source" = "PLLE2: VCO 1000 MHz"))]
        pub multiply: u64 = 5,
        /// Input divider D.
        #[schemars(range(min = 1, max = 56), extend("unit" = "1", "source" = "PLLE2"))]
        pub divide: u64 = 1,
        /// Output divider O of `clk_125`; `clk_250` has half of it.
        #[schemars(range(min = 2, max = 128), extend("unit" = "1", "source" = "PLLE2"))]
        pub output_divide: u64 = 8,
        /// From power-up to lock; the part's limit is 100 us.
        #[schemars(range(min = 0.0, max = 1e6), extend("unit" = "us", "source" = "choice: short, to keep runs short"))]
        pub lock_time_us: f64 = 1.0,
        /// Jitter of each edge of the outputs, Gaussian; 0 switches it off (7.7 is the wizard's 107 ps peak to peak).
        #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "ps rms", "source" = "choice: off"))]
        pub jitter_rms_ps: f64 = 0.0,
    }
}

table! {
    /// The time-to-digital converter.
    pub struct Tdc {
        /// Carry chain: `uniform`, `table6_3`, `ideal`, or the path of a chain file.
        #[schemars(extend("source" = "docs/model.md"))]
        pub profile: String = "uniform".into(),
    }
}

table! {
    /// Control signals at power-up, and the frame.
    pub struct Firmware {
        /// Laser repetition rate: 0 .. 3 for 5, 9.615, 15.625, 20.833 MHz.
        #[schemars(range(min = 0, max = 3), extend("unit" = "code", "source" = "Table 6.1"))]
        pub laser_freq: u64 = 3,
        /// SPAD quench mode: 0 resets before each shot, 1 recovers after the dead time.
        #[schemars(range(min = 0, max = 1), extend("unit" = "code", "source" = "Table 6.2"))]
        pub mode: u64 = 0,
        /// Lets the laser fire.
        #[schemars(extend("source" = "section 2.4, Laser_control"))]
        pub laser_en: bool = true,
        /// Lets the estimator start.
        #[schemars(extend("source" = "section 2.4"))]
        pub dsp_en: bool = true,
        /// Abandons the frame.
        #[schemars(extend("source" = "section 2.4"))]
        pub dsp_rst: bool = false,
        /// Reset button of the board.
        #[schemars(extend("source" = "section 6.2"))]
        pub rst: bool = false,
        /// Shots in a frame; a bin of 16 bits must hold them all. With `dark_frames`, those of a dark
        /// and a lit frame together.
        #[schemars(range(min = 1, max = 65_535), extend("unit" = "shots", "source" = "eq. 3.3"))]
        pub shots_per_frame: u64 = 30_000,
        /// Frames come in pairs of half the shots each, the first one dark: the acquisition computer
        /// changes `laser_en` whenever it has taken a depth.
        #[schemars(extend("source" = "section 5.2"))]
        pub dark_frames: bool = false,
    }
}

/// What is in the estimator's socket.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EstimatorKind {
    /// The neural network (`depth_estimator`).
    #[default]
    Network,
    /// Argmax with centroid correction (`centroid_estimator`).
    Centroid,
}

table! {
    /// The depth estimator.
    pub struct Estimator {
        /// What is in the estimator's socket: `network` or `centroid`.
        #[schemars(extend("source" = "thesis ch. 6; docs/model.md"))]
        pub kind: EstimatorKind = EstimatorKind::Network,
        /// Network: `uniform`, `uniform-16`, `ideal`, or the path of a network file.
        #[schemars(extend("source" = "docs/model.md"))]
        pub network: String = "uniform".into(),
        /// Words of the centroid's window to either side of its centre.
        #[schemars(range(min = 1, max = 31), extend("unit" = "bins", "source" = "choice: 23 bins are 50 taps of 11.5 ps; 4 sigma of the pulse"))]
        pub centroid_half_width: u64 = 23,
        /// Whether the centroid's maximum is of the height above the window's first word, and not above zero.
        #[schemars(extend("source" = "choice: ambient light piles up in the first bins"))]
        pub centroid_background: bool = true,
        /// Distance of a bin for the centroid; c/2 for 25 ps.
        #[schemars(range(min = 0.0001, max = 0.0078), extend("unit" = "m", "source" = "eq. 3.23"))]
        pub centroid_slope_m: f64 = 0.003_747_405_725,
        /// Distance that is added to the centroid's.
        #[schemars(range(min = -0.99, max = 0.99), extend("unit" = "m", "source" = "choice: none, so that pile-up shows"))]
        pub centroid_offset_m: f64 = 0.0,
    }
}

table! {
    /// What stands in for parts of the chain. At most one; without any, light drives the sensor.
    pub struct Stimulus {
        /// Photon list: a CSV file with columns `shot` (since power-up, from 0) and
        /// `arrival_ps` (from the laser edge). Replaces the light.
        #[schemars(extend("source" = "thesis 6.5.2"))]
        pub photons: Option<String> = None,
        /// Preloaded TDC codes: a CSV file with column `code`, one a shot. Replaces the TDC.
        #[schemars(extend("source" = "thesis 6.6.1"))]
        pub codes: Option<String> = None,
        /// Preloaded histogram: a CSV file with columns `bin` and `count`. Replaces the histogram.
        #[schemars(extend("source" = "thesis 6.7.4"))]
        pub histogram: Option<String> = None,
    }
}

table! {
    /// What the run reports beside depths.
    pub struct Report {
        /// A row for each shot's TDC result (thesis Table 6.3).
        #[schemars(extend("source" = "Table 6.3"))]
        pub tdc: bool = false,
        /// Parts of the run that go into the waveform where `--window` is not given; an empty list
        /// stands for `shot:0..16` and `estimation`.
        #[schemars(extend("source" = "choice: a first look under 5 MB"))]
        pub windows: Vec<String> = Vec::new(),
    }
}

/// A change of the acquisition computer's signals, asynchronous to the clocks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Control {
    /// When, from power-up.
    #[schemars(range(min = 0.0, max = 1e9), extend("unit" = "us", "source" = "choice"))]
    pub at_us: f64,
    /// Laser repetition rate, 0 .. 3.
    #[schemars(range(min = 0, max = 3), extend("unit" = "code", "source" = "Table 6.1"))]
    pub laser_freq: Option<u64>,
    /// SPAD quench mode, 0 or 1.
    #[schemars(range(min = 0, max = 1), extend("unit" = "code", "source" = "Table 6.2"))]
    pub mode: Option<u64>,
    /// Lets the laser fire.
    pub laser_en: Option<bool>,
    /// Lets the estimator start.
    pub dsp_en: Option<bool>,
    /// Abandons the frame.
    pub dsp_rst: Option<bool>,
    /// Reset button of the board.
    pub rst: Option<bool>,
}

impl Spad {
    /// Photon detection efficiency, PDE = PDP FF (section 3.2.1).
    pub fn detection_efficiency(&self) -> f64 {
        self.pdp * self.fill_factor
    }
}

impl Laser {
    /// Energy of a pulse [J].
    pub fn pulse_energy_j(&self) -> f64 {
        self.average_power_w / self.repetition_rate_hz
    }
}
