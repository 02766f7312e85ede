//! Light and sensor.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How ambient irradiance becomes a rate of avalanches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AmbientModel {
    /// Proportional to irradiance and reflectance, fitted to Table 4.3; other optics than the thesis's move
    /// it as they move `physical`.
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
        /// Illuminance of the target by halogen light (a black body of 2800 K, 14.92 lm/W), in place of
        /// `irradiance_w_m2_nm`, which it sets to the mean over the filter's passband: 14 klux are 0.58
        /// W/m^2/nm at 940 nm.
        #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "klux", "source" = "eq. 3.15 to 3.18; Table 3.2: 14"))]
        pub illuminance_klux: Option<f64> = None,
        /// Rate of the fitted model with the thesis's optics, at reflectance 1 and a detection efficiency of 0.003.
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
        /// Wavelength. Limits of eye safety are known from 700 to 1050 nm.
        #[schemars(range(min = 350.0, max = 1700.0), extend("unit" = "nm", "source" = "Table 3.2"))]
        pub wavelength_nm: f64 = 940.0,
        /// Standard deviation of the pulse as the detector times it, without its tail.
        #[schemars(range(min = 1.0, max = 2000.0), extend("unit" = "ps", "source" = "fitted to Table 5.2"))]
        pub pulse_sigma_ps: f64 = 137.0,
        /// Mean of an exponential time that comes on top, as of a laser that fades or of carriers that diffuse to a
        /// SPAD's junction; 0: the pulse is a Gaussian. The mean of the whole stays where it is.
        #[schemars(range(min = 0.0, max = 2000.0), extend("unit" = "ps", "source" = "choice: none, as in eq. 3.22"))]
        pub pulse_tail_ps: f64 = 0.0,
        /// A measured pulse, in place of the two above: a CSV file with columns `time_ps` (even steps) and `density`
        /// (to a constant factor). Its mean stands where the others' does.
        #[schemars(extend("source" = "a measured response, as `tofsim calibrate pulse` writes one"))]
        pub pulse_file: Option<String> = None,
        /// Delay of the light after the laser edge, that of the driver and of the VCSEL's turn-on: every echo comes so
        /// much later. Photons of a list have their own times.
        #[schemars(range(min = 0.0, max = 50_000.0), extend("unit" = "ps", "source" = "choice: none, as in eq. 3.23; laser drivers have a few ns"))]
        pub delay_ps: f64 = 0.0,
        /// Standard deviation of the time at which a pulse leaves the laser, from shot to shot; all photons of
        /// a shot are late together.
        #[schemars(range(min = 0.0, max = 2000.0), extend("unit" = "ps", "source" = "choice: none"))]
        pub timing_jitter_ps: f64 = 0.0,
        /// Standard deviation of a pulse's energy from shot to shot, as a part of the mean.
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

/// What a photon does that comes within the dead time of MODE 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DeadTimeKind {
    /// Nothing: active recharge.
    #[default]
    Fixed,
    /// It starts the dead time again, and the output stays high: passive recharge.
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
        /// SPADs that share the light.
        #[schemars(range(min = 1, max = 1_000_000), extend("unit" = "1", "source" = "Table 3.2"))]
        pub count: u32 = 40,
        /// How many of them are connected: SPADs of a row whose outputs, joined by an OR, are `tdc_stop`.
        #[schemars(range(min = 1, max = 40), extend("unit" = "1", "source" = "Fig. 4.3"))]
        pub on_tdc: u32 = 1,
        /// Outputs of the selected row that are simulated, on the TDC or not, from `spad_out_0` on: 16 or more, so that
        /// output 15 is among them; 0: only those on the TDC.
        #[schemars(range(min = 0, max = 64), extend("unit" = "outputs", "source" = "choice: none; the thesis's row has 30 (Fig. 4.3)"))]
        pub row_outputs: u32 = 0,
        /// Full angle of the field of view (FOV).
        #[schemars(range(min = 0.1, max = 170.0), extend("unit" = "deg", "source" = "Table 3.2"))]
        pub field_of_view_deg: f64 = 24.0,
        /// Time from an avalanche to the next possible one in MODE 1.
        #[schemars(range(min = 5.0, max = 1e6), extend("unit" = "ns", "source" = "Table 3.2"))]
        pub dead_time_ns: f64 = 20.0,
        /// What a photon does that comes within the dead time of MODE 1: nothing (`fixed`), or the dead time
        /// starts again and the output stays high (`paralysable`, passive recharge).
        #[schemars(extend("source" = "choice: as the thesis's; both in Knoll, Radiation Detection and Measurement, chapter 4"))]
        pub dead_time_kind: DeadTimeKind = DeadTimeKind::Fixed,
        /// Width of the pulse that a rise of their output gives on `tdc_stop`, as of a monostable that cannot be triggered
        /// again; 0: the wire is high as long as the output is.
        #[schemars(range(min = 0.0, max = 1e5), extend("unit" = "ns", "source" = "choice: no monostable, as in the thesis"))]
        pub pulse_ns: f64 = 0.0,
        /// Time after a pulse within which `tdc_stop` cannot rise again: such a rise is lost.
        #[schemars(range(min = 0.0, max = 1e5), extend("unit" = "ns", "source" = "choice: none, as in the thesis"))]
        pub pulse_gap_ns: f64 = 0.0,
        /// Rate of avalanches in the dark; 0 switches them off.
        #[schemars(range(min = 0.0, max = 1e9), extend("unit" = "1/s", "source" = "choice: a quiet CMOS SPAD"))]
        pub dark_rate_hz: f64 = 100.0,
        /// Temperature of the diode; `dark_rate_hz` is stated at 20.
        #[schemars(range(min = -55.0, max = 125.0), extend("unit" = "deg C", "source" = "choice: a laboratory"))]
        pub temperature_c: f64 = 20.0,
        /// Degrees with which the dark rate doubles.
        #[schemars(range(min = 1.0, max = 100.0), extend("unit" = "K", "source" = "choice: 0.64 eV at 20 deg C; half of silicon's gap, 0.56 eV, would be 9.2"))]
        pub dark_doubling_c: f64 = 8.0,
        /// Measured dark rates of the array at 20 deg C: a CSV file with columns `row` (0 to 39; row 0 is selected), `output`
        /// (0 to 29) and `rate_hz`. Outputs that it does not name have `dark_rate_hz`.
        #[schemars(extend("source" = "choice: none"))]
        pub dark_file: Option<String> = None,
        /// Standard deviation of the logarithm of the dark rates of the SPADs that are simulated, whose median is
        /// `dark_rate_hz`; they are the even quantiles of a log-normal distribution.
        #[schemars(range(min = 0.0, max = 5.0), extend("unit" = "1", "source" = "choice: all alike"))]
        pub dark_spread: f64 = 0.0,
        /// Chance that an avalanche leaves a carrier in a trap, which fires the diode again when it is released, if
        /// that is armed by then.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "choice: none, as in the thesis"))]
        pub afterpulse_probability: f64 = 0.0,
        /// Mean time that the carrier is trapped, which is exponential.
        #[schemars(range(min = 0.1, max = 1e5), extend("unit" = "ns", "source" = "choice: tens of ns; trap levels differ from process to process"))]
        pub afterpulse_ns: f64 = 50.0,
        /// Mean time in a trap of a second kind, which is exponential too.
        #[schemars(range(min = 0.1, max = 1e5), extend("unit" = "ns", "source" = "choice: ten times the first; a deep level beside a shallow one"))]
        pub afterpulse_second_ns: f64 = 500.0,
        /// Part of the trapped carriers that are in traps of the second kind; 0: there is one kind.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "choice: none"))]
        pub afterpulse_second_share: f64 = 0.0,
        /// Chance that an avalanche sets off a neighbour in the row at once, if both are simulated (on the TDC,
        /// or with `row_outputs`) and that is armed.
        #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "1", "source" = "choice: none, as in the thesis"))]
        pub crosstalk_probability: f64 = 0.0,
    }
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
