//! Lockstep by the record, as long as it is of the same vectors and the same Verilog.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use rayon::prelude::*;

use tofsim_rtl::verify::Rtl;
use tofsim_rtl::verify::task::DEFAULT;

use crate::common;
use crate::record::{Inputs, Record};

/// Of the design as it comes, and of scenarios.
pub static LOCKSTEP: LazyLock<Record> = LazyLock::new(|| {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/lockstep/lockstep.record");
    Record::read(path, "cargo test -p tofsim-cli --test cli lockstep -- --include-ignored")
});

/// What compiles a bench, runs it and reads what it says.
pub const CHECKING: &str = concat!(
    include_str!("../../../rtl/src/verify/candidate.rs"),
    include_str!("../../../rtl/src/verify/check.rs"),
    include_str!("../../../rtl/src/verify/simulator.rs"),
    include_str!("../../../rtl/src/verify/simulator/arguments.rs"),
    include_str!("../../../rtl/src/verify/simulator/job.rs"),
    include_str!("../../../rtl/src/verify/verdict.rs"),
);

/// How a block is compared.
const STRICTLY: [&str; 2] = ["--registers", "--from-power-up"];

/// What is known of a block that passes.
#[derive(Debug)]
pub struct Passed {
    /// Lines of its vectors [clock cycles].
    pub cycles: u64,
    /// Goals of its stimulus that are met, and all of them.
    pub goals: (u64, u64),
}

/// Verifies those blocks in a simulator, with options of their vectors; all have to pass.
pub fn verified<Name: AsRef<str> + Sync>(
    simulator: &str,
    names: &[Name],
    options: &[&str],
) -> Vec<Passed> {
    verified_as(&LOCKSTEP, &options.join(" "), simulator, names, options)
}

/// Verifies them by that record, where `what` stands for the options: they may have paths of temporary files.
pub fn verified_as<Name: AsRef<str> + Sync>(
    record: &Record,
    what: &str,
    simulator: &str,
    names: &[Name],
    options: &[&str],
) -> Vec<Passed> {
    let of = |name: &Name| {
        let name = name.as_ref();
        let check = format!("{name} in {simulator} {what}");
        let inputs = inputs(simulator, name, options);
        let answer = record.answer(&check, &inputs, || {
            Ok(verify(&check, &[&["--simulator", simulator, "--block", name], options].concat()))
        });
        Passed::read(&answer)
    };
    names.par_iter().map(of).collect()
}

impl Passed {
    /// From `20000 cycles, 7 of 7 goals`.
    fn read(answer: &str) -> Self {
        let words = answer.split_whitespace().filter_map(|word| word.parse().ok());
        let [cycles, met, of] = words.collect::<Vec<_>>().try_into().expect("three numbers");
        Passed { cycles, goals: (met, of) }
    }
}

/// Runs a block, which has to pass; what is known of it.
fn verify(check: &str, args: &[&str]) -> String {
    let blocks = super::verified(check, &[&STRICTLY[..], args].concat());
    let [block] = &blocks[..] else { panic!("{check}: {blocks:?}") };
    let goals = &block["goals"];
    format!("{} cycles, {} of {} goals", block["cycles"], goals["met"], goals["of"])
}

/// All that a simulator reads: bench, vectors and memories, which the Rust model makes, and the Verilog.
fn inputs(simulator: &str, name: &str, options: &[&str]) -> Inputs {
    let folder = common::empty();
    common::stdout(folder.path(), &[&["vectors", name, "-q", "-o", "out"], options].concat());
    let made = folder.path().join("out").join(name.trim_end_matches(&format!(".{DEFAULT}")));
    let inputs = match simulator {
        "icarus" => Inputs::default().version("iverilog", "-V"),
        _ => Inputs::default().version(simulator, "--version"),
    };
    let mut inputs = inputs.rust("checking", CHECKING).text("strictly", STRICTLY.join(" "));
    let text = |path: &Path| fs::read_to_string(path).unwrap();
    let (benches, data): (Vec<_>, Vec<_>) = (common::files(&made).into_iter())
        .filter(|file| file != "ports.json")
        .partition(|file| file.ends_with(".v"));
    for file in data {
        inputs = inputs.text(&file, fs::read(made.join(&file)).unwrap());
    }
    let rtl = Rtl::own(folder.path()).unwrap();
    for bench in benches {
        let bench = text(&made.join(bench));
        inputs = inputs.verilog("bench", &bench);
        for source in rtl.needed(&bench).unwrap() {
            let name = source.path.file_name().unwrap_or_default().to_string_lossy();
            inputs = inputs.verilog(&name, &text(&source.path));
        }
    }
    inputs
}
