//! Netlists by Yosys.

use std::path::{Path, PathBuf};

use tofsim::error::Result;
use tofsim::files::output::{create_directory, write_bytes};
use tofsim::sim::setup::Setup;

use crate::golden::parameters;
use crate::verify::Rtl;
use crate::verify::process::Limits;
use crate::verify::yosys;

use super::block::{TOP, TimedBlock};
use super::wrapper::{self, wrapper};

/// Our tops for boards, and the pins of the ECP5's.
const ECP5_TOP: &str = include_str!("../../../../rtl_ref/ecp5_top.v");
const RING: &str = include_str!("../../../../rtl_ref/ring_oscillator.v");
const ECP5_LPF: &str = include_str!("../../../../rtl_ref/ecp5.lpf");

/// A module that a design with a host has.
const GUARD: &str = "laser_guard";
/// What `tof_top` has for a host.
const HOST: [&str; 7] =
    ["Hosted", "ParametersHash", "uart_rx", "uart_tx", "armed", "interlock", "select_pins"];

/// An FPGA.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Lattice's, which open tools place and route.
    Ecp5,
    /// The KC705's part.
    Kintex7,
}

impl Part {
    /// Its name in file names and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Part::Ecp5 => "ecp5",
            Part::Kintex7 => "kintex7",
        }
    }

    /// The macro that is set for it.
    pub(super) fn define(self) -> Option<&'static str> {
        (self == Part::Ecp5).then_some("ECP5")
    }

    /// Yosys's command that synthesises the module `top` for it.
    pub(super) fn synth(self, top: &str) -> String {
        match self {
            Part::Ecp5 => format!("synth_ecp5 -top {top}"),
            Part::Kintex7 => {
                format!("synth_xilinx -family xc7 -flatten -noiopad -noclkbuf -top {top}")
            }
        }
    }
}

/// A design that is timed.
#[derive(Clone, Copy, Debug)]
pub struct TimedDesign<'a> {
    /// Its sources.
    pub rtl: &'a Rtl,
    /// Folder in which the tools run: paths in the sources, such as those of ROMs, are relative to it.
    pub folder: &'a Path,
    /// Folder in which they write.
    pub work: &'a Path,
    /// When to give up.
    pub limits: Limits<'a>,
}

/// Writes our own Verilog, and the ROMs that it names, into `folder`.
///
/// # Errors
/// When it cannot be written.
pub fn own(folder: &Path, setup: &Setup) -> Result<Rtl> {
    let sources = folder.join("rtl_ref");
    create_directory(&sources)?;
    for memory in parameters::memories(&parameters::whole::tof_top_in_full(setup)) {
        write_bytes(&sources.join(&*memory.name), &memory.text)?;
    }
    Rtl::own(&sources)
}

impl TimedDesign<'_> {
    /// The netlist of a block in a file, and the name of its top.
    ///
    /// # Errors
    /// When Yosys is missing, refuses the sources, or does not end.
    pub fn synthesise(&self, block: &TimedBlock, part: Part) -> Result<(PathBuf, &'static str)> {
        let (top, text) = self.top(block, part);
        let name = part.name();
        let netlist = self.work.join(format!("{}.{name}.json", block.name));
        let autoname = if part == Part::Kintex7 { "\nautoname" } else { "" };
        let script = format!(
            "{}{autoname}\nsetattr -unset src\nsetattr -mod -unset src\nwrite_json \"{}\"\n",
            part.synth(top),
            netlist.display(),
        );
        let mut sources = yosys::sources(self.rtl, &text, self.folder, part.define())?;
        if !self.rtl.has(top) {
            let file = self.work.join(format!("{}.{name}.v", block.name));
            write_bytes(&file, &text)?;
            sources.push(file.into());
        }
        yosys::synthesise((self.rtl, block.name), self.folder, sources, script, &self.limits)?;
        Ok((netlist, top))
    }

    /// The module that is placed, and what names it or declares it.
    fn top(&self, block: &TimedBlock, part: Part) -> (&'static str, String) {
        const BOARD: &str = "ecp5_top";
        match part {
            _ if !block.is_top() => (wrapper::TOP, wrapper(block)),
            Part::Kintex7 => (TOP, TOP.to_owned()),
            Part::Ecp5 if self.rtl.has(BOARD) => (BOARD, BOARD.to_owned()),
            Part::Ecp5 if self.rtl.has(GUARD) => (BOARD, format!("{ECP5_TOP}{RING}")),
            Part::Ecp5 => (BOARD, format!("{}{RING}", without_host(ECP5_TOP))),
        }
    }

    /// The name of the module that is placed on an ECP5.
    pub(super) fn top_name(&self, block: &TimedBlock) -> &'static str {
        self.top(block, Part::Ecp5).0
    }

    /// The constraints of a block's pins, in a file.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(super) fn pins(&self, block: &TimedBlock) -> Result<PathBuf> {
        let file = self.work.join(format!("{}.lpf", block.name));
        let text = if block.is_top() {
            ECP5_LPF.to_owned()
        } else {
            let mut clocks = String::new();
            for (clock, mhz) in [("clk_sys", 125), ("clk_laser", 250)] {
                clocks += &format!("FREQUENCY PORT \"{clock}\" {mhz} MHZ;\n");
            }
            // An output register in the pin's own cell needs a place for the pin.
            clocks + "LOCATE COMP \"laser_on\" SITE \"G19\";\n"
        };
        write_bytes(&file, &text)?;
        Ok(file)
    }
}

/// A board's top for a design without a host, with ages from a ROM.
fn without_host(top: &str) -> String {
    let is_host = |line: &&str| {
        let port = line.trim_start().strip_prefix('.').and_then(|rest| rest.split_once('('));
        port.is_some_and(|(port, _)| HOST.contains(&port))
    };
    let lines = top.lines().filter(|line| !is_host(line)).map(|line| format!("{line}\n"));
    lines.collect::<String>().replace("Calibrated = 1'b1", "Calibrated = 1'b0")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_host_the_top_connects_what_the_thesis_has() {
        let top = without_host(ECP5_TOP);
        assert_eq!(top.lines().count() + HOST.len(), ECP5_TOP.lines().count());
        assert!(top.contains(".tdc_stop(hit),") && top.contains("Calibrated = 1'b0"));
        assert!(!HOST.iter().any(|port| top.contains(&format!(".{port}("))));
    }
}
