//! The words that the command line has for values of the library's types.

use clap::builder::{
    PossibleValue, PossibleValuesParser, RangedI64ValueParser, RangedU64ValueParser,
    TypedValueParser,
};

use tofsim::scenario::MOST_SEED;
use tofsim::sim::Stepping;
use tofsim::sim::image::ImageFidelity;
use tofsim::waves::WaveFormat;
use tofsim_captures::compare::Unknowns;
use tofsim_captures::ila::Radix;
use tofsim_captures::ila::export::CaptureFormat;
use tofsim_captures::replay::ReplayKind;
use tofsim_learn::calibration::candidates::Kind;
use tofsim_learn::dataset::files::DatasetFormat;
use tofsim_rtl::golden::bench::Language;
use tofsim_rtl::timing::Part;
use tofsim_rtl::verify::Simulator;

/// Most threads that may be asked for.
pub const MOST_THREADS: i64 = 1024;

/// A word, what it stands for, and what the help says of it.
pub type Choice<T> = (&'static str, T, &'static str);

/// A parser that takes those words.
pub fn words<T: Copy + Send + Sync + 'static>(
    choices: &'static [Choice<T>],
) -> impl TypedValueParser<Value = T> {
    let values = choices.iter().map(|(word, _, help)| PossibleValue::new(*word).help(*help));
    PossibleValuesParser::new(values).try_map(|given| {
        let choice = choices.iter().find(|(word, ..)| *word == given);
        choice.map(|(_, value, _)| *value).ok_or("expected one of the words that the help lists")
    })
}

/// Parses a seed, which a scenario can have too.
pub fn seed() -> RangedU64ValueParser {
    RangedU64ValueParser::new().range(..=MOST_SEED)
}

/// Parses a number of threads.
pub fn threads() -> RangedI64ValueParser<u16> {
    RangedI64ValueParser::new().range(1..=MOST_THREADS)
}

/// A length above zero [mm].
pub fn millimetres(given: &str) -> Result<f64, &'static str> {
    let length: Option<f64> = given.parse().ok().filter(|mm: &f64| mm.is_finite() && *mm > 0.0);
    length.ok_or("expected a number above 0, in mm")
}

/// Radices of a value.
pub const RADIX: &[Choice<Radix>] = &[
    ("hex", Radix::Hex, "Hexadecimal, lower case, all digits"),
    ("signed", Radix::Signed, "Two's complement, decimal"),
    ("unsigned", Radix::Unsigned, "Decimal"),
    ("binary", Radix::Binary, "Bit by bit, all digits"),
    ("octal", Radix::Octal, "Three bits to a digit, all digits"),
];

/// Formats of a capture.
pub const CAPTURE_FORMAT: &[Choice<CaptureFormat>] = &[
    ("csv", CaptureFormat::Csv, "A row for each sample"),
    ("vcd", CaptureFormat::Vcd, "Value change dump, its time the number of the sample"),
    ("ila", CaptureFormat::Ila, "Vivado's own archive"),
];

/// Parts of a capture that a replay takes.
pub const REPLAY: &[Choice<ReplayKind>] = &[
    ("photons", ReplayKind::Photons, "Arrival time of the photon in each shot"),
    ("codes", ReplayKind::Codes, "Code of each shot, from a ROM in place of the TDC"),
    ("histogram", ReplayKind::Histogram, "Histogram that the estimator read"),
];

/// Shapes of the pulse.
pub const CALIBRATED: &[Choice<Kind>] = &[
    ("gaussian", Kind::Gaussian, "A Gaussian: laser.pulse_sigma_ps"),
    ("tail", Kind::Tail, "A Gaussian with an exponential tail: laser.pulse_tail_ps too"),
    ("samples", Kind::Samples, "Samples of any pulse: laser.pulse_file"),
];

/// Parts to time a design for.
pub const PART: &[Choice<Part>] = &[
    ("ecp5", Part::Ecp5, "Lattice ECP5, placed, routed and measured"),
    ("kintex7", Part::Kintex7, "Xilinx Kintex-7, estimated from the netlist"),
];

/// Treatments of unknown bits.
pub const UNKNOWNS: &[Choice<Unknowns>] = &[
    ("exact", Unknowns::Exact, "x only is x"),
    ("any", Unknowns::Any, "x is anything"),
    ("none", Unknowns::None, "x is nothing, not even x"),
];

/// Languages of a bench.
pub const LANGUAGE: &[Choice<Language>] =
    &[("verilog", Language::Verilog, "Verilog-2005"), ("vhdl", Language::Vhdl, "VHDL-2008")];

/// Which simulator runs the Verilog.
pub const SIMULATOR: &[Choice<Simulator>] = &[
    ("icarus", Simulator::Icarus, "Icarus Verilog: compiles at once"),
    ("verilator", Simulator::Verilator, "Verilator: compiles for seconds, then runs fast"),
];

/// Formats of a dataset.
pub const DATASET_FORMAT: &[Choice<DatasetFormat>] = &[
    ("parquet", DatasetFormat::Parquet, "One table, dataset.parquet"),
    ("npy", DatasetFormat::Npy, "Arrays: histograms.npy, truth.npy and rows.npy"),
];

/// Simulation fidelities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fidelity {
    Cycle,
    Shot,
    Histogram,
}

impl Fidelity {
    pub const ALL: [Choice<Fidelity>; 3] = [
        ("cycle", Fidelity::Cycle, "Simulate every register"),
        ("shot", Fidelity::Shot, "Draw each shot; no waveforms"),
        (
            "histogram",
            Fidelity::Histogram,
            "Draw each frame's histogram; MODE 0 only, without control changes",
        ),
    ];

    /// Its word.
    pub fn name(self) -> &'static str {
        Fidelity::ALL[self as usize].0
    }

    /// How shots are simulated, if they are.
    pub fn stepping(self) -> Stepping {
        match self {
            Fidelity::Shot => Stepping::LeapShots,
            Fidelity::Cycle | Fidelity::Histogram => Stepping::SkipIdle,
        }
    }

    /// How images are simulated.
    pub fn of_images(self) -> ImageFidelity {
        match self {
            Fidelity::Histogram => ImageFidelity::Histograms,
            Fidelity::Cycle | Fidelity::Shot => ImageFidelity::Shots(self.stepping()),
        }
    }
}

/// The format of a waveform, if there is to be one.
pub type WaveformChoice = Option<WaveFormat>;

/// Formats of a waveform.
pub const WAVEFORM: &[Choice<WaveformChoice>] = &[
    ("vcd", Some(WaveFormat::Vcd), "Value change dump"),
    ("fst", Some(WaveFormat::Fst), "GTKWave's compressed format"),
    ("none", None, "No waveform"),
];
