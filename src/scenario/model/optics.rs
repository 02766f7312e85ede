//! Keys of the illumination, the optics and the sensor.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Model that converts ambient irradiance to a rate of avalanches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AmbientModel {
    /// Proportional to irradiance and reflectance, fitted to Table 4.3, and scaled with the optics in the same way as
    /// `physical`.
    #[default]
    Fitted,
    /// Computed from the optics (eq. 3.19 and 3.20 with their missing factors); larger by a factor of pi.
    Physical,
}

/// Spectrum of the ambient light, which decides what a klux is at the laser's wavelength.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AmbientSpectrum {
    /// Halogen light: a black body of 2800 K, 14.92 lm/W.
    #[default]
    Halogen,
    /// Sunlight: ASTM G173-03, global tilt at air mass 1.5, 109.5 klux.
    Sun,
}

table! {
    /// Ambient light, reflected by the target.
    pub struct Ambient {
        /// Model that converts irradiance to a rate of avalanches: `fitted` or `physical`.
        pub model: AmbientModel = AmbientModel::Fitted,
        /// Spectral irradiance of the target at the laser's wavelength; 0 switches it off.
        #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "W/m^2/nm", "source" = "section 4.2: 0 .. 0.4"))]
        pub irradiance_w_m2_nm: f64 = 0.2,
        /// Illuminance of the target by light of `ambient.spectrum`. It replaces `irradiance_w_m2_nm`, which it sets to
        /// the mean over the filter's passband: at 940 nm, 14 klux of halogen light are 0.58 W/m^2/nm, and of sunlight
        /// 0.047.
        #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "klux", "source" = "eq. 3.15 to 3.18; Table 3.2: 14"))]
        pub illuminance_klux: Option<f64> = None,
        /// Spectrum of `illuminance_klux`: `halogen` (a black body of 2800 K, 14.92 lm/W) or `sun` (ASTM G173-03, global
        /// tilt at air mass 1.5, from 600 to 1200 nm).
        #[schemars(extend("source" = "section 3.2.2: halogen light"))]
        pub spectrum: AmbientSpectrum = AmbientSpectrum::Halogen,
        /// Rate of the fitted model with the thesis's optics, at reflectance 1 and a detection efficiency of 0.003.
        #[schemars(range(min = 0.0, max = 1e12), extend("unit" = "1/s per W/m^2/nm", "source" = "fitted to Table 4.3"))]
        pub fitted_rate_hz_per_w_m2_nm: f64 = 3.968e9,
    }
}

table! {
    /// The VCSEL.
    pub struct Laser {
        /// Average power at `repetition_rate_hz`. Their ratio, the pulse energy, applies at every repetition rate.
        #[schemars(range(min = 0.0, max = 10.0), extend("unit" = "W", "source" = "Table 3.2"))]
        pub average_power_w: f64 = 7.36e-3,
        /// Repetition rate at which the average power is stated. The firmware's rate is `firmware.laser_freq`.
        #[schemars(range(min = 1.0, max = 1e9), extend("unit" = "Hz", "source" = "Table 3.2"))]
        pub repetition_rate_hz: f64 = 40e6,
        /// Wavelength. Eye-safety limits are known from 700 to 1050 nm.
        #[schemars(range(min = 350.0, max = 1700.0), extend("unit" = "nm", "source" = "Table 3.2"))]
        pub wavelength_nm: f64 = 940.0,
        /// Standard deviation of the pulse as timed by the detector, without its tail.
        #[schemars(range(min = 1.0, max = 2000.0), extend("unit" = "ps", "source" = "fitted to Table 5.2"))]
        pub pulse_sigma_ps: f64 = 137.0,
        /// Mean of an additional exponential delay, such as a laser's decay or the diffusion of carriers to a SPAD's
        /// junction; 0: the pulse is a Gaussian. The mean of the whole pulse does not move.
        #[schemars(range(min = 0.0, max = 2000.0), extend("unit" = "ps", "source" = "choice: none, as in eq. 3.22"))]
        pub pulse_tail_ps: f64 = 0.0,
        /// Measured pulse, in place of the two keys above: a CSV file with columns `time_ps` (even steps) and
        /// `density` (arbitrary scale). Its mean coincides with that of the Gaussian.
        #[schemars(extend("source" = "a measured response, as `tofsim calibrate pulse` writes one"))]
        pub pulse_file: Option<String> = None,
        /// Delay from the laser edge to the light (driver and VCSEL turn-on), which shifts every echo. It does not
        /// apply to photon lists.
        #[schemars(range(min = 0.0, max = 50_000.0), extend("unit" = "ps", "source" = "choice: none, as in eq. 3.23; laser drivers have a few ns"))]
        pub delay_ps: f64 = 0.0,
        /// Standard deviation of the time at which a pulse leaves the laser, from shot to shot; it shifts all photons
        /// of a shot together.
        #[schemars(range(min = 0.0, max = 2000.0), extend("unit" = "ps", "source" = "choice: none"))]
        pub timing_jitter_ps: f64 = 0.0,
        /// Relative standard deviation of the pulse energy, from shot to shot.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "choice: none"))]
        pub energy_jitter: f64 = 0.0,
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
    /// The bandpass filter in front of the sensor.
    pub struct Filter {
        /// Transmission at the laser's wavelength.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "Table 3.2"))]
        pub efficiency: f64 = 0.67,
        /// Standard deviation of the Gaussian passband.
        #[schemars(range(min = 0.01, max = 200.0), extend("unit" = "nm", "source" = "eq. 3.17"))]
        pub sigma_nm: f64 = 10.0,
    }
}

/// Effect of a photon within the dead time of MODE 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DeadTimeKind {
    /// The photon has no effect: active recharge.
    #[default]
    Fixed,
    /// The photon restarts the dead time, and the output stays high: passive recharge.
    Paralysable,
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
        /// Number of SPADs that share the light.
        #[schemars(range(min = 1, max = 1_000_000), extend("unit" = "1", "source" = "Table 3.2"))]
        pub count: u32 = 40,
        /// Number of SPADs of the row that are connected to the TDC: the OR of their outputs is `tdc_stop`.
        #[schemars(range(min = 1, max = 40), extend("unit" = "1", "source" = "Fig. 4.3"))]
        pub on_tdc: u32 = 1,
        /// Number of outputs of the selected row that are simulated, connected or not, from `spad_out_0` on: 16 or
        /// more, so that output 15 is included; 0: only the connected ones.
        #[schemars(range(min = 0, max = 64), extend("unit" = "outputs", "source" = "choice: none; the thesis's row has 30 (Fig. 4.3)"))]
        pub row_outputs: u32 = 0,
        /// Full angle of the field of view (FOV).
        #[schemars(range(min = 0.1, max = 170.0), extend("unit" = "deg", "source" = "Table 3.2"))]
        pub field_of_view_deg: f64 = 24.0,
        /// Time from an avalanche to the next possible one in MODE 1.
        #[schemars(range(min = 5.0, max = 1e6), extend("unit" = "ns", "source" = "Table 3.2"))]
        pub dead_time_ns: f64 = 20.0,
        /// Effect of a photon within the dead time of MODE 1: none (`fixed`), or the dead time restarts and the
        /// output stays high (`paralysable`, passive recharge).
        #[schemars(extend("source" = "choice: as the thesis's; both in Knoll, Radiation Detection and Measurement, chapter 4"))]
        pub dead_time_kind: DeadTimeKind = DeadTimeKind::Fixed,
        /// Width of the `tdc_stop` pulse that a rising edge of the OR triggers (a non-retriggerable monostable); 0:
        /// `tdc_stop` follows the OR.
        #[schemars(range(min = 0.0, max = 1e5), extend("unit" = "ns", "source" = "choice: no monostable, as in the thesis"))]
        pub pulse_ns: f64 = 0.0,
        /// Time after a pulse during which `tdc_stop` cannot rise again; edges within it are lost.
        #[schemars(range(min = 0.0, max = 1e5), extend("unit" = "ns", "source" = "choice: none, as in the thesis"))]
        pub pulse_gap_ns: f64 = 0.0,
        /// Dark count rate; 0 switches it off.
        #[schemars(range(min = 0.0, max = 1e9), extend("unit" = "1/s", "source" = "choice: a quiet CMOS SPAD"))]
        pub dark_rate_hz: f64 = 100.0,
        /// Temperature of the SPAD; `dark_rate_hz` is stated at 20.
        #[schemars(range(min = -55.0, max = 125.0), extend("unit" = "deg C", "source" = "choice: a laboratory"))]
        pub temperature_c: f64 = 20.0,
        /// Temperature step that doubles the dark rate.
        #[schemars(range(min = 1.0, max = 100.0), extend("unit" = "K", "source" = "choice: 0.64 eV at 20 deg C; half of silicon's gap, 0.56 eV, would be 9.2"))]
        pub dark_doubling_c: f64 = 8.0,
        /// Measured dark count rates of the array at 20 deg C: a CSV file with columns `row` (0 to 39; row 0 is
        /// selected), `output` (0 to 29) and `rate_hz`. Outputs that are not listed have `dark_rate_hz`.
        #[schemars(extend("source" = "choice: none"))]
        pub dark_file: Option<String> = None,
        /// Standard deviation of the logarithm of the simulated SPADs' dark rates, whose median is `dark_rate_hz`;
        /// the rates are evenly spaced quantiles of a log-normal distribution.
        #[schemars(range(min = 0.0, max = 5.0), extend("unit" = "1", "source" = "choice: all alike"))]
        pub dark_spread: f64 = 0.0,
        /// Probability that an avalanche leaves a carrier in a trap, whose release fires the SPAD again if it is
        /// armed by then.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "choice: none, as in the thesis"))]
        pub afterpulse_probability: f64 = 0.0,
        /// Mean lifetime of the trapped carrier, which is exponential.
        #[schemars(range(min = 0.1, max = 1e5), extend("unit" = "ns", "source" = "choice: tens of ns; trap levels differ from process to process"))]
        pub afterpulse_ns: f64 = 50.0,
        /// Mean lifetime in a second kind of trap, which is exponential too.
        #[schemars(range(min = 0.1, max = 1e5), extend("unit" = "ns", "source" = "choice: ten times the first; a deep level beside a shallow one"))]
        pub afterpulse_second_ns: f64 = 500.0,
        /// Fraction of the trapped carriers that are in traps of the second kind; 0: there is one kind.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "choice: none"))]
        pub afterpulse_second_share: f64 = 0.0,
        /// Probability that an avalanche fires a neighbour in the row at once, if both are simulated (connected, with
        /// `row_outputs`, or pixels of an array) and the neighbour is armed.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "choice: none, as in the thesis"))]
        pub crosstalk_probability: f64 = 0.0,
    }
}

impl Spad {
    /// Returns the photon detection efficiency, PDE = PDP FF (section 3.2.1).
    pub fn detection_efficiency(&self) -> f64 {
        self.pdp * self.fill_factor
    }
}

impl Laser {
    /// Returns the pulse energy [J].
    pub fn pulse_energy_j(&self) -> f64 {
        self.average_power_w / self.repetition_rate_hz
    }
}
