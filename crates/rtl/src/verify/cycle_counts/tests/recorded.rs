//! Proofs by the record, as long as they are of the same Verilog.

#[path = "../../../../../../tests/record.rs"]
mod record;

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use tofsim::error::Result;
use tofsim::network::mem;

use crate::verify::cycle_counts::design::with_defines;
use crate::verify::cycle_counts::promises::Promise;
use crate::verify::cycle_counts::{self, Count, CountedDesign, prove};
use crate::verify::process::Limits;
use crate::verify::rtl::Rtl;

use record::{Inputs, Record};

static PROOFS: LazyLock<Record> = LazyLock::new(|| {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/verify/cycle_counts/tests/proofs.record");
    Record::read(path, "cargo test -p tofsim-rtl --lib cycle_counts -- --include-ignored")
});

/// What asks Yosys, and reads its answer.
const ASKING: &str = concat!(include_str!("../prove.rs"), include_str!("../../yosys.rs"));

/// What the record says of a promise that holds.
const PROVEN: &str = "proven";

/// Counts promises of our Verilog, maybe with faults, and has the proofs by the record; `of` says what the design is.
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
    cycle_counts::count(promises, (design, rtl), &super::limits(), prove, |_| {}).unwrap()
}

/// All that Yosys reads for a proof of a promise, and for attempts to prove what is next to it.
fn inputs(promise: &Promise, rtl: &Rtl, design: &CountedDesign) -> Result<Inputs> {
    let (properties, program) = (promise.properties, mem::likelihood_solver(design.program()));
    let property = with_defines(properties.module, &promise.defines, properties.text);
    let mut inputs = Inputs::default()
        .version("yosys", "-V")
        .rust("asking", ASKING)
        .text("script", prove::script(promise, promise.expected, properties.steps))
        .text("options", format!("{:?}", rtl.options))
        .verilog(properties.module, &property)
        .text(&program.name, program.text);
    for source in rtl.needed(properties.text)? {
        let name = source.path.file_name().unwrap_or_default().to_string_lossy();
        inputs = inputs.verilog(&name, &fs::read_to_string(&source.path).unwrap());
    }
    Ok(inputs)
}
