//! Keys of the board's clocks and of the acquisition computer's control signals.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::firmware::frame_ctrl::DRAIN_CYCLES;
use crate::firmware::histogram_builder::COUNT_BITS;
use crate::firmware::likelihood_estimator::targets::Order;
use crate::firmware::pll;
use crate::firmware::tof_top::FirmwareEstimator;
use crate::firmware::vcsel_driver::PERIODS;
use crate::kernel::Time;

/// FPGA family, which determines the limits of the PLL.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// A Kintex-7 of speed grade -2 (PLLE2).
    #[default]
    Kintex7,
    /// An ECP5 (EHXPLLL).
    Ecp5,
}

table! {
    /// The clock generator. Its oscillator (VCO) runs at `input_hz * multiply / divide`, `clk_sys` at that frequency
    /// divided by `output_divide`, and `clk_laser` twice as fast as `clk_sys`.
    pub struct Pll {
        /// FPGA family: `kintex7` or `ecp5`.
        #[schemars(extend("source" = "KC705; docs/model.md"))]
        pub part: Part = Part::Kintex7,
        /// Frequency of the board's oscillator.
        #[schemars(range(min = 8_000_000, max = 800_000_000), extend("unit" = "Hz", "source" = "KC705: SiT9102"))]
        pub input_hz: u64 = pll::INPUT_HZ,
        /// Feedback divider M: of the VCO on a Kintex-7. An ECP5 closes its loop over `clk_laser`, and its dividers
        /// follow from these.
        #[schemars(range(min = 1, max = 128), extend("unit" = "1", "source" = "PLLE2: VCO 1000 MHz"))]
        pub multiply: u64 = pll::MULTIPLY,
        /// Input divider D.
        #[schemars(range(min = 1, max = 128), extend("unit" = "1", "source" = "PLLE2"))]
        pub divide: u64 = pll::DIVIDE,
        /// Output divider O of `clk_sys`, an even number; `clk_laser` uses half of it. The period of `clk_sys` is
        /// rounded to a multiple of 4 fs.
        #[schemars(range(min = 2, max = 128), extend("unit" = "1", "source" = "PLLE2"))]
        pub output_divide: u64 = pll::OUTPUT_DIVIDE,
        /// Time from power-up to lock; the part's limit is 100 us.
        #[schemars(range(min = 0.0, max = 1e6), extend("unit" = "us", "source" = "choice: short, to keep runs short"))]
        pub lock_time_us: f64 = 1.0,
        /// Jitter of each edge of the outputs, Gaussian; 0 switches it off (7.7 is the wizard's 107 ps peak to peak).
        #[schemars(range(min = 0.0, max = 100.0), extend("unit" = "ps rms", "source" = "choice: off"))]
        pub jitter_rms_ps: f64 = 0.0,
    }
}

impl Pll {
    /// Returns the frequency of `clk_sys`, not rounded to whole femtoseconds [MHz].
    pub fn clk_sys_mhz(&self) -> f64 {
        let hz = (self.input_hz * self.multiply) as f64;
        hz / (1_000_000 * self.divide * self.output_divide) as f64
    }

    /// Returns the PLL's parameters for elaboration.
    pub fn params(&self) -> pll::Params {
        pll::Params {
            input_hz: self.input_hz,
            multiply: self.multiply,
            divide: self.divide,
            output_divide: self.output_divide,
            lock_time: Time::from_ps_f64(self.lock_time_us * 1e6),
        }
    }
}

/// Quench mode of the SPAD (Table 6.2). A file holds the code of the pin `mode`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "u64", into = "u64")]
pub enum QuenchMode {
    /// MODE 0: a reset arms the SPAD before each shot.
    #[default]
    EachShot,
    /// MODE 1: the SPAD rearms itself after the dead time.
    FreeRunning,
}

impl TryFrom<u64> for QuenchMode {
    type Error = String;

    fn try_from(code: u64) -> Result<Self, String> {
        match code {
            0 => Ok(QuenchMode::EachShot),
            1 => Ok(QuenchMode::FreeRunning),
            _ => Err(format!("expected 0 or 1, not {code}")),
        }
    }
}

impl From<QuenchMode> for u64 {
    fn from(mode: QuenchMode) -> u64 {
        mode as u64
    }
}

table! {
    /// Control signals at power-up, and frame parameters.
    pub struct Firmware {
        /// Laser repetition rate: index into `laser_periods`, from 0; by default 0 to 3 select 5, 9.615, 15.625 and
        /// 20.833 MHz.
        #[schemars(range(min = 0, max = 7), extend("unit" = "code", "source" = "Table 6.1"))]
        pub laser_freq: u64 = 3,
        /// Laser period for each `laser_freq`.
        #[schemars(length(min = 1, max = 8), inner(range(min = 4, max = 65_535)))]
        #[schemars(extend("unit" = "cycles of clk_sys", "source" = "Table 6.1"))]
        pub laser_periods: Vec<u64> = PERIODS.to_vec(),
        /// Length of the laser pulse.
        #[schemars(range(min = 1, max = 8))]
        #[schemars(extend("unit" = "half cycles of clk_laser", "source" = "section 6.3: 2 ns"))]
        pub pulse_half_cycles: u32 = 1,
        /// Length of the state Drain, in which the last photons of a frame reach the histogram.
        #[schemars(range(min = 8, max = 65_536))]
        #[schemars(extend("unit" = "cycles of clk_sys", "source" = "choice: twice the window; docs/model.md"))]
        pub drain_cycles: u64 = DRAIN_CYCLES,
        /// SPAD quench mode: 0 resets before each shot, 1 recovers after the dead time.
        #[schemars(range(min = 0, max = 1), extend("unit" = "code", "source" = "Table 6.2"))]
        #[schemars(with = "u64")]
        pub mode: QuenchMode = QuenchMode::EachShot,
        /// Enable the laser.
        #[schemars(extend("source" = "section 2.4, Laser_control"))]
        pub laser_en: bool = true,
        /// Enable the estimator.
        #[schemars(extend("source" = "section 2.4"))]
        pub dsp_en: bool = true,
        /// Abandon the frame.
        #[schemars(extend("source" = "section 2.4"))]
        pub dsp_rst: bool = false,
        /// Reset button of the board.
        #[schemars(extend("source" = "section 6.2"))]
        pub rst: bool = false,
        /// Width of a histogram bin's count.
        #[schemars(range(min = 8, max = 24), extend("unit" = "bit", "source" = "section 6.6"))]
        pub count_bits: u32 = COUNT_BITS,
        /// Shots per frame, at most what a bin can count (`count_bits`). With `dark_frames`, the shots of a dark and
        /// a lit frame together.
        #[schemars(range(min = 1, max = 16_777_215), extend("unit" = "shots", "source" = "eq. 3.3"))]
        pub shots_per_frame: u64 = 30_000,
        /// Alternate dark and lit frames, each with half of the shots, a dark one first: the acquisition computer
        /// toggles `laser_en` each time it has received a depth.
        #[schemars(extend("source" = "section 5.2"))]
        pub dark_frames: bool = false,
        /// With `dark_frames`: delay from a depth to the acquisition computer's change of `laser_en`, within the
        /// Clear state of the next frame.
        #[schemars(range(min = 1.0, max = 2000.0), extend("unit" = "ns", "source" = "choice: at no edge of a clock"))]
        pub response_ns: f64 = 101.0,
    }
}

impl Firmware {
    /// Returns the number of shots in one frame of the firmware: with dark frames, half of those of a pair.
    pub fn shots_of_a_frame(&self) -> u64 {
        if self.dark_frames { self.shots_per_frame / 2 } else { self.shots_per_frame }
    }
}

table! {
    /// The depth estimator.
    pub struct Estimator {
        /// Estimator in the estimator slot: `network`, `centroid` or `likelihood`.
        #[schemars(extend("source" = "thesis ch. 6; docs/model.md"))]
        pub kind: FirmwareEstimator = FirmwareEstimator::Network,
        /// Network: `uniform`, `uniform-16`, `ideal`, or the path of a network file.
        #[schemars(extend("source" = "docs/model.md"))]
        pub network: String = "uniform".into(),
        /// Half width of the centroid's window, without its centre bin.
        #[schemars(range(min = 1, max = 31), extend("unit" = "bins", "source" = "choice: 23 bins are 50 taps of 11.5 ps; 4 sigma of the pulse"))]
        pub centroid_half_width: u64 = 23,
        /// Locate the centroid's maximum above the first bin of its window rather than above zero.
        #[schemars(extend("source" = "choice: ambient light piles up in the first bins"))]
        pub centroid_background: bool = true,
        /// Distance per bin for the centroid; c/2 for 25 ps.
        #[schemars(range(min = 0.0001, max = 0.0078), extend("unit" = "m", "source" = "eq. 3.23"))]
        pub centroid_slope_m: f64 = 0.003_747_405_725,
        /// Offset added to the centroid's distance.
        #[schemars(range(min = -0.99, max = 0.99), extend("unit" = "m", "source" = "choice: none, so that pile-up shows"))]
        pub centroid_offset_m: f64 = 0.0,
        /// Standard deviation of the Gaussian pulse that the likelihood estimator assumes; 0: the laser's actual
        /// pulse.
        #[schemars(range(min = 0.0, max = 1e6), extend("unit" = "ps", "source" = "choice: the actual pulse", "formerly" = "told_sigma_ps"))]
        pub assumed_sigma_ps: f64 = 0.0,
        /// Shots per histogram that the likelihood estimator assumes; 0: the shots of a frame.
        #[schemars(range(min = 0, max = 16_777_215), extend("unit" = "shots", "source" = "choice: the actual number", "formerly" = "told_shots"))]
        pub assumed_shots: u64 = 0,
        /// Template of the cover window's light: the `glass.csv` of `tofsim calibrate glass`, for `likelihood`,
        /// `two-echoes`, `matched`, and `likelihood_estimator` in the firmware. They fit its amplitude along with the echo.
        #[schemars(extend("source" = "choice: none"))]
        pub glass_file: Option<String> = None,
        /// Targets that `likelihood_estimator` finds in the firmware: one, or up to two.
        #[schemars(range(min = 1, max = 2), extend("unit" = "targets", "source" = "choice: one"))]
        pub targets: u32 = 1,
        /// Target that it reports first, of two: `nearest` or `strongest`.
        #[schemars(extend("source" = "choice: the nearest"))]
        pub order: Order = Order::Nearest,
    }
}

/// A change of the acquisition computer's signals, asynchronous to the clocks.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Control {
    /// Time of the change, from power-up.
    #[schemars(range(min = 0.0, max = 1e9), extend("unit" = "us", "source" = "choice"))]
    pub at_us: f64,
    /// Laser repetition rate: index into `firmware.laser_periods`.
    #[schemars(range(min = 0, max = 7), extend("unit" = "code", "source" = "Table 6.1"))]
    pub laser_freq: Option<u64>,
    /// SPAD quench mode, 0 or 1.
    #[schemars(range(min = 0, max = 1), extend("unit" = "code", "source" = "Table 6.2"))]
    #[schemars(with = "Option<u64>")]
    pub mode: Option<QuenchMode>,
    /// Enable the laser.
    pub laser_en: Option<bool>,
    /// Enable the estimator.
    pub dsp_en: Option<bool>,
    /// Abandon the frame.
    pub dsp_rst: Option<bool>,
    /// Reset button of the board.
    pub rst: Option<bool>,
}
