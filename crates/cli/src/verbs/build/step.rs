//! The steps of a build, in their order.

use std::fmt;
use std::path::PathBuf;

use serde_json::Value;

use tofsim_rtl::verify::process::{IVERILOG, Tool, VVP, YOSYS};

use crate::choice::Choice;

/// A step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    Network,
    Verilog,
    Constraints,
    Vectors,
    Cycles,
    Verify,
    Frame,
    Accuracy,
    Cost,
    Report,
}

/// Outcome of a step.
pub struct Outcome {
    /// The files that it has made.
    pub outputs: Vec<PathBuf>,
    /// Results for the report.
    pub result: Value,
    /// Whether no fault was found.
    pub passed: bool,
    /// Summary in a line.
    pub summary: String,
}

impl Step {
    /// All, in their order.
    pub fn all() -> [Step; 10] {
        Step::CHOICES.map(|(_, step, _)| step)
    }

    /// Their words on the command line.
    pub const CHOICES: [Choice<Step>; 10] = [
        ("network", Step::Network, "Uses the network that the file names, or trains one"),
        ("verilog", Step::Verilog, "Writes the Verilog with its parameters set, and its ROMs"),
        ("constraints", Step::Constraints, "Writes clocks and pins for the part's tools"),
        ("vectors", Step::Vectors, "Writes golden vectors and a bench for each block"),
        ("cycles", Step::Cycles, "Proves the cycle counts (Icarus, Yosys)"),
        ("verify", Step::Verify, "Verifies the Verilog against the model (Icarus)"),
        ("frame", Step::Frame, "Simulates a frame, with a waveform and save files for its viewers"),
        (
            "accuracy",
            Step::Accuracy,
            "Measures the errors over the grid, compared with the Cramer-Rao bound",
        ),
        ("cost", Step::Cost, "Counts the resources in a Kintex-7 and an ECP5 (Yosys)"),
        ("report", Step::Report, "Writes report.html"),
    ];

    /// Its word.
    pub fn name(self) -> &'static str {
        Step::CHOICES[self as usize].0
    }

    /// Returns a description of the step.
    pub fn about(self) -> &'static str {
        Step::CHOICES[self as usize].2
    }

    /// Steps whose outputs it reads.
    pub fn needs(self) -> Vec<Step> {
        match self {
            Step::Network | Step::Constraints => Vec::new(),
            Step::Verilog | Step::Vectors | Step::Frame | Step::Accuracy => vec![Step::Network],
            Step::Cycles | Step::Cost => vec![Step::Verilog],
            Step::Verify => vec![Step::Network, Step::Verilog],
            Step::Report => Step::all().into_iter().filter(|step| *step != Step::Report).collect(),
        }
    }

    /// Programs that it calls.
    pub fn tools(self) -> &'static [Tool] {
        match self {
            Step::Cycles => &[IVERILOG, VVP, YOSYS],
            Step::Verify => &[IVERILOG, VVP],
            Step::Cost => &[YOSYS],
            _ => &[],
        }
    }
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
