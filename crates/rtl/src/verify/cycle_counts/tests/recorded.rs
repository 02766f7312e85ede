//! Counts in simulations and proofs by the record, as long as they are of the same Verilog.

#[path = "../../../../../../tests/record.rs"]
mod record;

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use tofsim::error::Result;
use tofsim::network::mem;

use crate::verify::cycle_counts::design::with_defines;
use crate::verify::cycle_counts::measured::Measured;
use crate::verify::cycle_counts::promises::Promise;
use crate::verify::cycle_counts::{self, Count, CountedDesign, prove, simulate};
use crate::verify::process::Limits;
use crate::verify::rtl::Rtl;

use record::{Inputs, Record};

static PROOFS: LazyLock<Record> = LazyLock::new(|| {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/verify/cycle_counts/tests/proofs.record");
    Record::read(path, "cargo test -p tofsim-rtl --lib cycle_counts -- --include-ignored")
});

/// What asks Yosys, and reads its answer.
const ASKING: &str = concat!(include_str!("../prove.rs"), include_str!("../../yosys.rs"));

/// What compiles a bench, runs it and reads what it says.
const SIMULATING: &str = concat!(
    include_str!("../simulate.rs"),
    include_str!("../measured.rs"),
    include_str!("../../simulator.rs"),
    include_str!("../../simulator/arguments.rs"),
    include_str!("../../simulator/job.rs"),
);

/// What the record says of a promise that holds.
const PROVEN: &str = "proven";

/// Counts promises of our Verilog, maybe with faults, by the record; `of` says what the design is.
pub fn count(of: &str, promises: &[Promise], design: &CountedDesign, rtl: &Rtl) -> Vec<Count> {
    let of = if of.is_empty() { "kc705" } else { of };
    let prove = |promise: &Promise, rtl: &Rtl, folder: &Path, limits: &Limits| {
        let check = format!("{} {} of {of}", promise.key(), promise.expected);
        let ask = || match prove::prove(promise, rtl, folder, limits).unwrap() {
            None => Ok(PROVEN.to_owned()),
            Some(why) if why.contains("has not ended") => Err(why),
            Some(why) => Ok(why),
        };
        let answer = PROOFS.answer(&check, &inputs(promise, rtl, design)?, ask);
        Ok(Some(answer).filter(|answer| answer != PROVEN))
    };
    let measure = |folder: &Path| measure(of, promises, design, rtl, folder);
    cycle_counts::count(promises, (design, rtl), &super::limits(), (measure, prove), |_| {})
        .unwrap()
}

/// Counts promises in a simulation, by the record: of each the count that decides.
fn measure(
    of: &str,
    promises: &[Promise],
    design: &CountedDesign,
    rtl: &Rtl,
    folder: &Path,
) -> Result<Measured> {
    let keys: Vec<_> = promises.iter().map(|it| format!("{} {}", it.key(), it.expected)).collect();
    let mut inputs = Inputs::default()
        .version("iverilog", "-V")
        .rust("simulating", SIMULATING)
        .text("options", format!("{:?}", rtl.options))
        .text("promises", keys.join(", "));
    for (name, text) in simulate::benches(promises) {
        let bench = with_defines(name, &design.defines(), text);
        inputs = read(inputs.verilog(name, &bench), design, rtl, text)?;
    }
    let ask = || {
        let limits = super::limits();
        let measured = simulate::measure(promises, rtl, design, folder, &limits);
        let measured = measured.map_err(|error| error.to_string())?;
        let of = |it: &Promise| {
            Some(format!("{}={}", it.key(), measured.count(&it.key(), it.expected)?))
        };
        Ok(promises.iter().filter_map(of).collect::<Vec<_>>().join(" "))
    };
    let check = format!("counts of {of}: {}", keys.first().map_or("none", String::as_str));
    let answer = PROOFS.answer(&check, &inputs, ask);
    let mut measured = Measured::default();
    for count in answer.split_whitespace() {
        let (key, number) = count.split_once('=').unwrap_or_else(|| panic!("{answer}"));
        measured.add(key, number.parse().unwrap_or_else(|_| panic!("{answer}")));
    }
    Ok(measured)
}

/// All that Yosys reads for a proof of a promise, and for attempts to prove what is next to it.
fn inputs(promise: &Promise, rtl: &Rtl, design: &CountedDesign) -> Result<Inputs> {
    let properties = promise.properties;
    let property = with_defines(properties.module, &promise.defines, properties.text);
    let inputs = Inputs::default()
        .version("yosys", "-V")
        .rust("asking", ASKING)
        .text("script", prove::script(promise, promise.expected, properties.steps));
    let options = inputs.text("options", format!("{:?}", rtl.options));
    read(options.verilog(properties.module, &property), design, rtl, properties.text)
}

/// Adds the ROM of a design, and the Verilog that a top needs.
fn read(inputs: Inputs, design: &CountedDesign, rtl: &Rtl, top: &str) -> Result<Inputs> {
    let program = mem::likelihood_solver(design.program());
    let mut inputs = inputs.text(&program.name, program.text);
    for source in rtl.needed(top)? {
        let name = source.path.file_name().unwrap_or_default().to_string_lossy();
        inputs = inputs.verilog(&name, &fs::read_to_string(&source.path).unwrap());
    }
    Ok(inputs)
}
