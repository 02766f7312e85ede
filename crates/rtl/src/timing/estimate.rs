//! The estimate for a Kintex-7: levels, and a range that depends on what routing takes.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use tofsim::error::{Input, Result};

use super::block::TimedBlock;
use super::netlist::Netlist;
use super::paths::{TimedPath, TimingGraph};
use super::synthesis::{Part, TimedDesign};

/// Assumed delays of a routed net [ps]: little, usual and much.
pub const NET_PS: [u32; 3] = [300, 600, 900];

/// An estimate: there is no placement in it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Cells between two registers on the longest path.
    pub levels: usize,
    /// Length of the longest path for each of [`NET_PS`] [ns].
    pub ns: [f64; 3],
    /// The longest path with the usual routing.
    pub path: TimedPath,
    /// Primitives by type.
    pub cells: BTreeMap<String, u64>,
    /// DSP48E1 with AREG, BREG, MREG and PREG in use.
    pub pipelined_dsps: u64,
    /// Types of cells that are taken for a register and a way for nothing, because no delay is known.
    pub unknown: BTreeSet<String>,
}

impl Estimate {
    /// Primitives of the types that begin so.
    pub fn count(&self, begin: &str) -> u64 {
        let cells = self.cells.iter().filter(|(kind, _)| kind.starts_with(begin));
        cells.map(|(_, count)| count).sum()
    }
}

/// Synthesises a block for the 7 series and looks for its longest path.
///
/// # Errors
/// When Yosys is missing or refuses the sources, or no register follows another.
pub fn estimate(design: &TimedDesign, block: &TimedBlock) -> Result<Estimate> {
    let (file, top) = design.synthesise(block, Part::Kintex7)?;
    let netlist = Netlist::read(&file, top)?;
    let graph = TimingGraph::new(&netlist);
    let nothing = || {
        let expected = "expected a path from register to register";
        Input::new(&design.rtl.source, expected).field(block.name)
    };
    let paths: Option<Vec<_>> = NET_PS.iter().map(|ps| graph.longest(*ps)).collect();
    let [little, usual, much] =
        paths.and_then(|paths| <[_; 3]>::try_from(paths).ok()).ok_or_else(nothing)?;
    let is_pipelined = |cell: &&super::netlist::Cell| {
        let registers = ["AREG", "BREG", "MREG", "PREG"];
        cell.kind == "DSP48E1" && registers.iter().all(|name| cell.number(name) > 0)
    };
    Ok(Estimate {
        levels: usual.levels(),
        ns: [little.ns, usual.ns, much.ns],
        path: usual,
        cells: netlist.counts(),
        pipelined_dsps: netlist.cells.values().filter(is_pipelined).count() as u64,
        unknown: graph.unknown.iter().map(|kind| (*kind).to_owned()).collect(),
    })
}
