//! Checkers in Verilog, for a simulator without DPI and `bind`: Icarus, by way of VPI.

use tofsim::hierarchy::TOP;

use crate::block::{Block, Layout};
use crate::golden::Spec;
use crate::golden::timing;
use crate::golden::verilog::range;

use super::{Checkers, clocks, escape, join, ports};

impl Checkers {
    /// One file with the photons, a checker for each block, and `tofsim_attach`, a second top that connects them to the
    /// design at the path that the macro `TOFSIM_TOP` names.
    pub fn verilog(&self) -> String {
        let checkers: String = self.blocks.iter().map(|block| self.in_verilog(block)).collect();
        format!(
            "`timescale 1fs / 1fs\n`define TOFSIM_VERSION \"{version}\"\n`define TOFSIM_SCENARIO \"{scenario}\"\n\n\
             // Photons and checkers of tofsim {version}, scenario {name}, over VPI.\n{photons}{checkers}{attach}",
            version = env!("CARGO_PKG_VERSION"),
            scenario = escape(&self.scenario),
            name = self.setup.name,
            photons = include_str!("photons.v"),
            attach = self.attach(),
        )
    }

    fn in_verilog(&self, block: &Block) -> String {
        let [given, shown] = block.layouts();
        let line = |layout: &Layout| match layout.places() {
            [] => "1'b0".to_owned(),
            places => format!("{{{}}}", join(places.iter().map(|place| place.name.clone()), ", ")),
        };
        let high = |layout: &Layout| layout.width().max(1) - 1;
        let port = |(name, bits): &(String, u32)| format!("    input {}{name}", range(*bits));
        let stops = given.find("tdc_stop").map_or("", |_| include_str!("stops.v"));
        format!(
            include_str!("checker.v"),
            name = block.name(),
            ports = join(
                clocks(block)
                    .map(|clock| format!("    input {clock}"))
                    .chain(ports(block).iter().map(port)),
                ",\n"
            ),
            high_in = high(given),
            high_out = high(shown),
            inputs = line(given),
            outputs = line(shown),
            stops = stops,
            edges = edges(block.spec(), self.setup.cycle().fs()),
        )
    }

    fn attach(&self) -> String {
        let attach = |block: &Block| {
            let (name, below) = (block.name(), block.spec().scope);
            let path = if below.is_empty() { String::new() } else { format!(".{below}") };
            let ports = ports(block);
            let names = clocks(block).chain(ports.iter().map(|(port, _)| port.clone()));
            let connected = names.map(|port| format!("      .{port}(`TOFSIM_TOP{path}.{port})"));
            let fits = |(port, _): &(String, u32)| {
                format!(
                    "    wrong = wrong || !$tofsim_port({name}.tofsim_model, \"{port}\", `TOFSIM_TOP{path}.{port});\n"
                )
            };
            format!(
                "\n  tofsim_{name} {name} (\n{}\n  );\n  initial begin\n    if (!{name}.tofsim_begun) {name}.tofsim_start;\n{}    \
                 if (wrong) begin\n      $tofsim_report({name}.tofsim_model);\n      \
                 $fatal(1, \"tofsim: {name} is not as wide as the scenario's\");\n    end\n  end\n",
                join(connected, ",\n"),
                ports.iter().map(fits).collect::<String>(),
            )
        };
        let all: String = self.blocks.iter().map(attach).collect();
        let ran = |block: &Block| {
            format!("    missing = missing + !$tofsim_ran(\"{}\");\n", block.name())
        };
        let ran: String = self.blocks.iter().map(ran).collect();
        let count = self.blocks.len();
        format!(
            "\n// Where the checkers are connected: -DTOFSIM_TOP=path.of.{TOP} -s tofsim_attach.\n\
                 `ifdef TOFSIM_TOP\nmodule tofsim_attach;\n  reg wrong = 1'b0;\n  integer missing = 0;\n{all}\n  \
                 // At the end, how often each block was compared.\n  final begin\n{ran}    \
                 if (missing != 0) $fatal(1, \"tofsim: %0d of {count} checkers compared nothing\", missing);\n  end\nendmodule\n`endif\n"
        )
    }
}

/// When a block is looked at.
fn edges(spec: &Spec, cycle: u64) -> String {
    match spec.timing {
        timing::CLK_LASER => "  always @(negedge clk_laser) tofsim_check(3);\n  always @(posedge clk_laser) tofsim_check(1);\n".to_owned(),
        timing::BOTH | timing::OWN_WITH_RESET => include_str!("both.v").to_owned(),
        timing::OWN => format!(include_str!("quarters.v"), cycle = cycle, looks = 4),
        timing::NONE => format!(include_str!("quarters.v"), cycle = cycle, looks = 1),
        timing => format!("  always @(posedge {}) tofsim_check(1);\n", timing.clock),
    }
}
