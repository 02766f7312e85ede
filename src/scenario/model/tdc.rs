//! The time-to-digital converter.

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
        /// Ages in the decoder's ROM: `true` for those of the chain's own delays, `uniform` for those of equal
        /// taps, which is no calibration, or the path of a file as `tofsim tdc calibrate` writes it.
        #[schemars(extend("source" = "docs/model.md"))]
        pub calibration: TdcCalibration = TdcCalibration::True,
        /// What the decoder makes of the taps: `ones` counts them, `leading` finds the highest that is one,
        /// `reordered` does so once they are in the order in which a hit reaches them.
        #[schemars(extend("source" = "docs/decoders.md"))]
        pub decoder: Decoder = Decoder::Ones,
        /// Temperature of the die. The delays of the chain's file are those at 25 degrees and the nominal
        /// supply.
        #[schemars(range(min = 0.0, max = 85.0), extend("unit" = "degC", "source" = "DS182: junction of a commercial part, 0 to 85"))]
        pub temperature_c: f64 = 25.0,
        /// Supply of the fabric less its nominal voltage.
        #[schemars(range(min = -30.0, max = 30.0), extend("unit" = "mV", "source" = "DS182: VCCINT 0.97 to 1.03 V"))]
        pub supply_mv: f64 = 0.0,
        /// Temperature of the die as the ROM was calibrated; without it that of now.
        #[schemars(range(min = 0.0, max = 85.0), extend("unit" = "degC", "source" = "choice: calibrated now"))]
        pub calibrated_at_c: Option<f64> = None,
        /// Supply less its nominal voltage as the ROM was calibrated; without it that of now.
        #[schemars(range(min = -30.0, max = 30.0), extend("unit" = "mV", "source" = "choice: calibrated now"))]
        pub calibrated_at_mv: Option<f64> = None,
        /// Temperature and supply over the time from power-up, in place of `temperature_c` and `supply_mv`: a CSV
        /// file with columns `time_s`, `temperature_c` and `supply_mv`. Delays are linear between two rows.
        #[schemars(extend("source" = "choice: they stand still"))]
        pub conditions: Option<String> = None,
        /// By which part of itself every delay of the chain grows with each degree.
        #[schemars(range(min = -0.005, max = 0.005), extend("unit" = "1/degC", "source" = "ring oscillators on 7-series silicon: -0.097 and -0.101 % a degree, from 29 to 44 degC"))]
        pub delay_per_c: f64 = 0.001,
        /// By which part of itself every delay of the chain grows with each millivolt of supply.
        #[schemars(range(min = -0.005, max = 0.005), extend("unit" = "1/mV", "source" = "about -1 % for each 10 mV, a rule of thumb: not measured"))]
        pub delay_per_mv: f64 = -0.001,
        /// Time about an edge within which each tap's register samples, at any instant alike: set-up and hold, within
        /// which a register goes metastable. 0: all sample at the edge.
        #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "ps", "source" = "choice: none; docs/model.md"))]
        pub setup_window_ps: f64 = 0.0,
        /// Frames from one calibration in the firmware (`tdc_calibration`) to the next; the first is before the
        /// first frame. 0 for none: then the ROM holds what `calibration` says.
        #[schemars(range(max = 65_535), extend("unit" = "frames", "source" = "choice: none, as the thesis has none"))]
        pub recalibrate_frames: u64 = 0,
        /// Hits that such a calibration counts, as a power of two. By 2^17 the mean of random hits is known
        /// to 11 ps at most, about a tap.
        #[schemars(range(min = 10, max = 20), extend("unit" = "1", "source" = "docs/model.md"))]
        pub calibration_hits_log2: u32 = 17,
        /// Period of the ring oscillator that gives these hits. Half of it is longer than a clock period and
        /// than the chain.
        #[schemars(range(min = 5.0, max = 10_000.0), extend("unit" = "ns", "source" = "choice: no simple multiple of 8 ns"))]
        pub ring_ns: f64 = 61.8,
        /// Deviation of each half of its period; they add up.
        #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "ps", "source" = "choice: not measured"))]
        pub ring_jitter_ps: f64 = 5.0,
        /// Registers of the ones count. A code comes this and four cycles after the edge that samples its
        /// hit; with two, the second sums 50 numbers in a cycle.
        #[schemars(range(min = 2, max = 3), extend("unit" = "cycles", "source" = "docs/timing.md"))]
        pub count_stages: u64 = 3,
        /// Width of the coarse count: a shot's window has as many cycles as it can count, 8 with three bits.
        #[schemars(range(min = 1, max = 12), extend("unit" = "bit", "source" = "section 6.5"))]
        pub coarse_bits: u32 = DEFAULT_COARSE_BITS,
        /// Bins of the histogram, and so codes: a power of two.
        #[schemars(range(min = 16, max = 1024), extend("unit" = "bins", "source" = "section 6.6"))]
        pub bins: u64 = BINS as u64,
        /// Width of a bin: what a code counts.
        #[schemars(range(min = 5.0, max = 2000.0), extend("unit" = "ps", "source" = "section 6.5: 256 bins in 6.4 ns"))]
        pub bin_ps: f64 = 25.0,
        /// Time at which bin 0 begins, from the laser edge: a range gate, within the window.
        #[schemars(range(min = 0.0, max = 32_768_000.0), extend("unit" = "ps", "source" = "choice: at the laser edge"))]
        pub first_bin_ps: f64 = 0.0,
    }
}

/// What the decoder's ROM holds; a file has `true`, `"uniform"` or a path.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum TdcCalibration {
    /// The chain's own delays.
    #[default]
    True,
    /// Equal taps.
    Uniform,
    /// A file.
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
