//! The words that the command line has for values of the library's types.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use tofsim_captures::compare::Unknowns;
use tofsim_captures::ila::Radix;
use tofsim_captures::ila::export::Format as CaptureFormat;
use tofsim_learn::dataset::files::DatasetFormat;
use tofsim_learn::estimation::EstimatorKind;
use tofsim_rtl::verify::Simulator;

/// A word, what it stands for, and what the help says of it.
type Choice<T> = (&'static str, T, &'static str);

/// A parser that takes those words.
fn words<T: Copy + Send + Sync + 'static>(
    choices: &'static [Choice<T>],
) -> impl TypedValueParser<Value = T> {
    let values = choices.iter().map(|(word, _, help)| PossibleValue::new(*word).help(*help));
    PossibleValuesParser::new(values).try_map(|given| {
        let choice = choices.iter().find(|(word, ..)| *word == given);
        choice.map(|(_, value, _)| *value).ok_or("expected one of the words that the help lists")
    })
}

/// How the digits of a value are written.
pub fn radix() -> impl TypedValueParser<Value = Radix> {
    words(&[
        ("hex", Radix::Hex, "Hexadecimal, lower case, all digits"),
        ("signed", Radix::Signed, "Two's complement, decimal"),
        ("unsigned", Radix::Unsigned, "Decimal"),
        ("binary", Radix::Binary, "Bit by bit, all digits"),
        ("octal", Radix::Octal, "Three bits to a digit, all digits"),
    ])
}

/// What a capture is written as.
pub fn capture_format() -> impl TypedValueParser<Value = CaptureFormat> {
    words(&[
        ("csv", CaptureFormat::Csv, "A row for each sample"),
        ("vcd", CaptureFormat::Vcd, "Value change dump, its time the number of the sample"),
        ("ila", CaptureFormat::Ila, "Vivado's own archive"),
    ])
}

/// What an unknown bit is the same as.
pub fn unknowns() -> impl TypedValueParser<Value = Unknowns> {
    words(&[
        ("exact", Unknowns::Exact, "x only is x"),
        ("any", Unknowns::Any, "x is anything"),
        ("none", Unknowns::None, "x is nothing, not even x"),
    ])
}

/// Which simulator runs the Verilog.
pub fn simulator() -> impl TypedValueParser<Value = Simulator> {
    words(&[
        ("icarus", Simulator::Icarus, "Icarus Verilog: compiles at once"),
        ("verilator", Simulator::Verilator, "Verilator: compiles for seconds, then runs fast"),
    ])
}

/// What a data set is written as.
pub fn dataset_format() -> impl TypedValueParser<Value = DatasetFormat> {
    words(&[
        ("parquet", DatasetFormat::Parquet, "One table, dataset.parquet"),
        ("npy", DatasetFormat::Npy, "Arrays: histograms.npy, truth.npy and rows.npy"),
    ])
}

/// An estimator.
pub fn estimator() -> impl TypedValueParser<Value = EstimatorKind> {
    words(&EstimatorKind::ALL)
}
