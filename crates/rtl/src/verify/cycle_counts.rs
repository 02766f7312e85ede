//! The cycle counts that the design promises: counted in the Rust model, counted in a simulation
//! of the Verilog, and proven of it.
//!
//! A proof is a k-induction by Yosys, without a bound in time, for whatever the inputs do after a
//! first cycle of reset. Numbers next to the promised one must not be provable: a property that
//! is true of them too says nothing, and counts as not proven.

mod design;
mod measured;
mod model;
mod promises;
mod prove;
mod scan;
mod simulate;
#[cfg(test)]
mod tests;

pub use design::CountedDesign;
use measured::Measured;
use promises::Promise;

use std::path::Path;

use serde::Serialize;

use tofsim::error::Result;
use tofsim::files::output::{create_directory, write_bytes};
use tofsim::files::staged::ScratchFolder;
use tofsim::network::mem;

use super::process::Limits;
use super::rtl::Rtl;

/// One promise: a row of `tofsim verify --cycle-counts`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Count {
    /// Name of the count, for people.
    pub what: String,
    /// Number that the design promises.
    pub expected: u64,
    /// Unit of the three numbers.
    pub unit: &'static str,
    /// Count in the Rust model. Where the same thing is counted more than once, the first count that is not
    /// the promised one; `None` if it never happens.
    pub model: Option<u64>,
    /// Count in a simulation by Icarus Verilog, as for the model.
    pub rtl: Option<u64>,
    /// True if Yosys proves it of the Verilog.
    pub proven: bool,
    /// Reason why it is not proven, if it is not.
    pub reason: Option<String>,
}

impl Count {
    /// Returns whether all three agree with the promise.
    pub fn holds(&self) -> bool {
        let expected = Some(self.expected);
        self.model == expected && self.rtl == expected && self.proven
    }
}

/// Counts and proves everything that such a design promises; `limits` are those of one run of a tool, and `done` is
/// told of each count when it is there.
///
/// # Errors
/// When a tool is missing, Icarus Verilog cannot compile `rtl` with our bench (a module or a port
/// is missing), the simulation does not end, or the user stops.
pub fn cycle_counts(
    rtl: &Rtl,
    design: &CountedDesign,
    limits: &Limits,
    done: impl Fn(&Count),
) -> Result<Vec<Count>> {
    let promises = promises::of(rtl, design);
    let measure = |folder: &Path| simulate::measure(&promises, rtl, design, folder, limits);
    count(&promises, (design, rtl), limits, (measure, prove::prove), done)
}

/// Counts those promises: `measure` in a simulation, and `prove` says why one may not hold, or `None` if it is proven.
fn count(
    promises: &[Promise],
    (design, rtl): (&CountedDesign, &Rtl),
    limits: &Limits,
    (measure, prove): (
        impl FnOnce(&Path) -> Result<Measured>,
        impl Fn(&Promise, &Rtl, &Path, &Limits) -> Result<Option<String>>,
    ),
    done: impl Fn(&Count),
) -> Result<Vec<Count>> {
    let folder = ScratchFolder::new()?;
    write_program(design, folder.path())?;
    let simulated = measure(folder.path())?;
    let modelled = model::measure(design);
    let count = |promise: &Promise| {
        let (key, expected) = (promise.key(), promise.expected);
        let reason = prove(promise, rtl, folder.path(), limits)?;
        let count = Count {
            what: promise.what.clone(),
            expected,
            unit: promise.properties.unit,
            model: modelled.count(&key, expected),
            rtl: simulated.count(&key, expected),
            proven: reason.is_none(),
            reason,
        };
        done(&count);
        Ok(count)
    };
    promises.iter().map(count).collect()
}

/// Writes the ROM whose words decide how long something takes, where `rtl_ref` looks for it.
fn write_program(design: &CountedDesign, folder: &Path) -> Result<()> {
    let (program, rtl_ref) = (mem::likelihood_solver(design.program()), folder.join("rtl_ref"));
    create_directory(&rtl_ref)?;
    write_bytes(&rtl_ref.join(&*program.name), program.text)
}
