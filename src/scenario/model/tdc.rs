//! Keys of the time-to-digital converter.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::firmware::coarse_counter::DEFAULT_COARSE_BITS;
use crate::firmware::histogram_builder::BINS;
use crate::firmware::tdc_decoder::Decoder;

table! {
    /// The time-to-digital converter.
    pub struct Tdc {
        /// Carry chain: `uniform`, `table6_3`, `ideal`, `kintex7`, `ecp5`, or the path of a chain file.
        #[schemars(extend("source" = "docs/model.md"))]
        pub profile: String = "uniform".into(),
        /// Calibration ROM of the decoder: `true` holds the ages of the chain's actual delays, `uniform` those of
        /// nominal tap widths (uncalibrated); or the path of a file as written by `tofsim tdc calibrate`.
        #[schemars(extend("source" = "docs/model.md"))]
        pub calibration: TdcCalibration = TdcCalibration::True,
        /// Decoding of the taps: `ones` counts the ones, `leading` finds the highest one, `reordered` finds it after
        /// sorting the taps by the time at which a hit reaches them.
        #[schemars(extend("source" = "docs/decoders.md"))]
        pub decoder: Decoder = Decoder::Ones,
        /// Temperature of the die. The delays of a chain file apply at 25 degrees and nominal supply.
        #[schemars(range(min = 0.0, max = 85.0), extend("unit" = "degC", "source" = "DS182: junction of a commercial part, 0 to 85"))]
        pub temperature_c: f64 = 25.0,
        /// Deviation of the fabric's supply from its nominal voltage.
        #[schemars(range(min = -30.0, max = 30.0), extend("unit" = "mV", "source" = "DS182: VCCINT 0.97 to 1.03 V"))]
        pub supply_mv: f64 = 0.0,
        /// Temperature of the die during the calibration of the ROM; the present one by default.
        #[schemars(range(min = 0.0, max = 85.0), extend("unit" = "degC", "source" = "choice: calibrated now"))]
        pub calibrated_at_c: Option<f64> = None,
        /// Supply deviation during the calibration of the ROM; the present one by default.
        #[schemars(range(min = -30.0, max = 30.0), extend("unit" = "mV", "source" = "choice: calibrated now"))]
        pub calibrated_at_mv: Option<f64> = None,
        /// Temperature and supply as functions of the time since power-up, in place of `temperature_c` and
        /// `supply_mv`: a CSV file with columns `time_s`, `temperature_c` and `supply_mv`. Delays are interpolated
        /// linearly.
        #[schemars(extend("source" = "choice: they stand still"))]
        pub conditions: Option<String> = None,
        /// Relative change of all delays per degree.
        #[schemars(range(min = -0.005, max = 0.005), extend("unit" = "1/degC", "source" = "ring oscillators on 7-series silicon: -0.097 and -0.101 % a degree, from 29 to 44 degC"))]
        pub delay_per_c: f64 = 0.001,
        /// Relative change of all delays per millivolt of supply.
        #[schemars(range(min = -0.005, max = 0.005), extend("unit" = "1/mV", "source" = "about -1 % for each 10 mV, a rule of thumb: not measured"))]
        pub delay_per_mv: f64 = -0.001,
        /// Width of the window about an edge (set-up and hold) within which each tap's register samples at a random
        /// time, uniformly: metastability. 0: all registers sample at the edge.
        #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "ps", "source" = "choice: none; docs/model.md"))]
        pub setup_window_ps: f64 = 0.0,
        /// Number of frames between calibrations in the firmware (`tdc_calibration`), the first of which precedes the
        /// first frame; 0: no such calibration, the ROM is set by `calibration`.
        #[schemars(range(max = 65_535), extend("unit" = "frames", "source" = "choice: none, as the thesis has none"))]
        pub recalibrate_frames: u64 = 0,
        /// Number of hits per calibration in the firmware, as a power of two. With 2^17 the mean of random hits is
        /// accurate to 11 ps, about one tap.
        #[schemars(range(min = 10, max = 20), extend("unit" = "1", "source" = "docs/model.md"))]
        pub calibration_hits_log2: u32 = 17,
        /// Period of the ring oscillator that generates the calibration hits. Half of it exceeds the clock period and
        /// the chain's length.
        #[schemars(range(min = 5.0, max = 10_000.0), extend("unit" = "ns", "source" = "choice: no simple multiple of 8 ns"))]
        pub ring_ns: f64 = 61.8,
        /// Jitter of each half period of the ring, which accumulates.
        #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "ps", "source" = "choice: not measured"))]
        pub ring_jitter_ps: f64 = 5.0,
        /// Pipeline stages of the ones count. A code is valid this many plus four cycles after the edge that samples
        /// the hit; with two, the second stage adds 50 numbers in a cycle.
        #[schemars(range(min = 2, max = 3), extend("unit" = "cycles", "source" = "docs/timing.md"))]
        pub count_stages: u64 = 3,
        /// Width of the coarse count, which sets the length of a shot's window: 8 cycles for three bits.
        #[schemars(range(min = 1, max = 12), extend("unit" = "bit", "source" = "section 6.5"))]
        pub coarse_bits: u32 = DEFAULT_COARSE_BITS,
        /// Number of histogram bins and of TDC codes: a power of two.
        #[schemars(range(min = 16, max = 1024), extend("unit" = "bins", "source" = "section 6.6"))]
        pub bins: u64 = BINS as u64,
        /// Bin width, the unit of a TDC code.
        #[schemars(range(min = 5.0, max = 2000.0), extend("unit" = "ps", "source" = "section 6.5: 256 bins in 6.4 ns"))]
        pub bin_ps: f64 = 25.0,
        /// Start of bin 0, from the laser edge: a range gate within the window.
        #[schemars(range(min = 0.0, max = 32_768_000.0), extend("unit" = "ps", "source" = "choice: at the laser edge"))]
        pub first_bin_ps: f64 = 0.0,
    }
}

/// Contents of the calibration ROM. A file holds `true`, `"uniform"` or a path.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum TdcCalibration {
    /// Ages of the chain's actual delays.
    #[default]
    True,
    /// Ages of nominal tap widths.
    Uniform,
    /// Ages from the file at this path.
    File(String),
}

impl fmt::Display for TdcCalibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            TdcCalibration::True => "true",
            TdcCalibration::Uniform => "uniform",
            TdcCalibration::File(path) => path,
        })
    }
}

impl Serialize for TdcCalibration {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            TdcCalibration::True => serializer.serialize_bool(true),
            other => serializer.collect_str(other),
        }
    }
}

impl<'de> Deserialize<'de> for TdcCalibration {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Given {
            Flag(bool),
            Word(String),
        }
        let word = match Given::deserialize(deserializer)? {
            Given::Flag(flag) => flag.to_string(),
            Given::Word(word) => word,
        };
        Ok(match word.as_str() {
            "true" => TdcCalibration::True,
            "uniform" => TdcCalibration::Uniform,
            _ => TdcCalibration::File(word),
        })
    }
}

impl JsonSchema for TdcCalibration {
    fn schema_name() -> Cow<'static, str> {
        "TdcCalibration".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["string", "boolean"] })
    }
}
