//! Checkers in SystemVerilog: modules to bind to a design, each with a block of the model beside its block, and the
//! photons of a scenario as a module.
//!
//! The model itself is behind functions of C, in the crate `tofsim-dpi`; [`Block`] is what they step.

use std::sync::Arc;

use tofsim::Setup;
use tofsim::error::Result;
use tofsim::hierarchy;

use crate::block::{Block, Layout};
use crate::golden::timing;
use crate::golden::{BLOCKS, Spec};

mod vpi;

/// Scenario, seed and language of checkers.
pub struct Checkers {
    setup: Arc<Setup>,
    /// The scenario for the library: a line with its name or path, and one for each key that is set.
    scenario: String,
    blocks: Vec<Block>,
}

/// The blocks that a scenario's design has, and that can be stepped by themselves.
pub fn blocks_of(setup: &Setup) -> Vec<&'static Spec> {
    let entries = hierarchy::entries(&setup.params);
    let is_there = |spec: &&Spec| entries.iter().any(|entry| entry.scope == spec.path());
    BLOCKS.iter().filter(|spec| spec.model.is_some()).filter(is_there).collect()
}

impl Checkers {
    /// For those blocks of a scenario's design, which `scenario` names.
    ///
    /// # Errors
    /// When there is no such block, or the scenario has it not.
    pub fn new<'a>(
        setup: Arc<Setup>,
        scenario: String,
        blocks: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self> {
        let blocks = blocks.into_iter().map(|name| Block::new(Arc::clone(&setup), name));
        let blocks = blocks.collect::<Result<_>>()?;
        Ok(Checkers { setup, scenario, blocks })
    }

    /// The files by their names, in the order in which a simulator takes them.
    pub fn files(&self) -> Vec<(&'static str, String)> {
        vec![
            ("tofsim_pkg.sv", self.package()),
            (
                "tofsim_photons.sv",
                include_str!("checkers/photons.sv").replace("{name}", &self.setup.name),
            ),
            ("tofsim_checkers.sv", self.checkers()),
            ("tofsim_bind.sv", self.binds()),
        ]
    }

    /// The widest line of inputs, and of outputs: as a type, and in bits.
    fn line(&self, which: usize) -> (String, usize) {
        let widths = self.blocks.iter().map(|block| block.layouts()[which].width());
        // At least two, so that it is a vector.
        let width = widths.max().unwrap_or_default().max(2);
        (format!("bit [{}:0]", width - 1), width)
    }

    fn package(&self) -> String {
        let ([inputs, outputs], version) =
            ([0, 1].map(|which| self.line(which).0), env!("CARGO_PKG_VERSION"));
        format!(
            include_str!("checkers/package.sv"),
            version = version,
            name = self.setup.name,
            scenario = escape(&self.scenario),
            inputs = inputs,
            outputs = outputs,
        )
    }

    fn checkers(&self) -> String {
        let [inputs, outputs] = [0, 1].map(|which| self.line(which).1);
        let cycle = self.setup.cycle().fs();
        let checker = |block: &Block| {
            let [given, shown] = block.layouts();
            let ports = ports(block);
            let widths = ports.iter().map(|(name, _)| format!("    parameter int {name}_bits = 1"));
            let port =
                |(name, _): &(String, u32)| format!("    input bit [{name}_bits-1:0] {name}");
            let check = |(name, _): &(String, u32)| {
                format!(
                    "    wrong += int'(tofsim_port(tofsim_model, \"{name}\", {name}_bits) == 0);"
                )
            };
            format!(
                include_str!("checkers/checker.sv"),
                name = block.name(),
                widths = join(widths, ",\n"),
                ports = join(
                    clocks(block)
                        .map(|clock| format!("    input bit {clock}"))
                        .chain(ports.iter().map(port)),
                    ",\n"
                ),
                checks = join(ports.iter().map(check), "\n"),
                inputs = line(given, inputs),
                outputs = line(shown, outputs),
                stops = stops(given),
                edges = edges(block.spec(), cycle),
            )
        };
        let text: String = self.blocks.iter().map(checker).collect();
        format!(
            "`timescale 1fs / 1fs\n\n// Checkers of tofsim {}, scenario {}.\n{text}{}",
            env!("CARGO_PKG_VERSION"),
            self.setup.name,
            self.summary()
        )
    }

    fn summary(&self) -> String {
        let ran = |block: &Block| format!("    tofsim_ran(\"{}\");", block.name());
        let ran = join(self.blocks.iter().map(ran), "\n");
        format!(include_str!("checkers/summary.sv"), ran = ran, count = self.blocks.len())
    }

    fn binds(&self) -> String {
        let bind = |block: &Block| {
            let name = block.name();
            let ports = ports(block);
            let width = |(port, _): &(String, u32)| format!("    .{port}_bits($bits({port}))");
            let connected = clocks(block).chain(ports.iter().map(|(port, _)| port.clone()));
            format!(
                "\nbind {name} tofsim_{name} #(\n{}\n) tofsim_checker (\n{}\n);\n",
                join(ports.iter().map(width), ",\n"),
                join(connected.map(|port| format!("    .{port}({port})")), ",\n"),
            )
        };
        let text: String = self.blocks.iter().map(bind).collect();
        format!(
            "// Binds checkers to modules of these names; yours may have others, or fewer of them. The macro TOFSIM_BENCH\n\
             // names the bench, which prints at its end how often each was compared.\n{text}\n\
             `ifdef TOFSIM_BENCH\nbind `TOFSIM_BENCH tofsim_summary tofsim_summary ();\n`endif\n"
        )
    }
}

/// Ports of a checker beside clocks.
fn ports(block: &Block) -> Vec<(String, u32)> {
    let layouts = block.layouts().into_iter().flat_map(Layout::places);
    layouts.map(|place| (place.name.clone(), place.width as u32)).collect()
}

/// The clocks of a block; of the whole, those inside it.
fn clocks(block: &Block) -> impl Iterator<Item = String> {
    let names: Vec<String> = match block.spec().timing {
        timing::OWN_WITH_RESET => vec!["clk_sys".to_owned(), "clk_laser".to_owned()],
        timing::OWN => Vec::new(),
        _ => {
            let clocks = block.ports().iter().filter(|port| port.is_clock());
            clocks.map(|port| port.name.clone()).collect()
        }
    };
    names.into_iter()
}

/// The ports of a layout side by side, in so many bits.
fn line(layout: &Layout, width: usize) -> String {
    let names = layout.places().iter().map(|place| place.name.clone());
    match layout.width() {
        0 => format!("{width}'d0"),
        _ => format!("{width}'({{{}}})", join(names, ", ")),
    }
}

/// Tells the model the changes of `tdc_stop`, if that is an input.
fn stops(inputs: &Layout) -> &'static str {
    match inputs.find("tdc_stop") {
        Some(_) => include_str!("checkers/stops.sv"),
        None => "",
    }
}

/// When a block is looked at; `cycle` is the period of `clk_sys` [fs].
fn edges(spec: &Spec, cycle: u64) -> String {
    match spec.timing {
        timing::CLK_LASER => include_str!("checkers/clk_laser.sv").to_owned(),
        timing::BOTH | timing::OWN_WITH_RESET => include_str!("checkers/both.sv").to_owned(),
        timing::OWN => format!(include_str!("checkers/quarters.sv"), cycle = cycle, looks = 4),
        timing::NONE => format!(include_str!("checkers/quarters.sv"), cycle = cycle, looks = 1),
        timing => format!("  always @(posedge {}) tofsim_check(1);\n", timing.clock),
    }
}

/// A text as Verilog writes it between quotes.
fn escape(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n")
}

fn join(lines: impl Iterator<Item = String>, between: &str) -> String {
    lines.collect::<Vec<_>>().join(between)
}
