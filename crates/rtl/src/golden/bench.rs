//! The self-checking Verilog bench of a block.
//!
//! One process applies the inputs 1 ps after the edge, moves the clocks and looks 1 ps before the
//! next edge, so that nothing depends on the order in which a simulator takes simultaneous events.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

mod compare;

use super::block::Parameter;
use super::table::Column;
use super::timing::Step;
use super::vectors::Vectors;

/// A bench, with what another implementation is allowed.
#[derive(Clone, Debug)]
pub struct Bench<'a> {
    vectors: &'a Vectors,
    /// Clock cycles that an output comes later than the reference.
    pub delays: BTreeMap<String, i64>,
    /// Outputs that are not compared.
    pub ignored: BTreeSet<String>,
    /// Low bits of an output that are compared, where not all are.
    pub bits: BTreeMap<String, usize>,
    /// Outputs that are compared only where another one is high.
    pub valid: BTreeMap<String, String>,
    /// The module that is instantiated.
    pub module: String,
}

impl<'a> Bench<'a> {
    /// The bench for the reference itself.
    pub fn new(vectors: &'a Vectors) -> Self {
        Bench {
            vectors,
            delays: BTreeMap::new(),
            ignored: BTreeSet::new(),
            bits: BTreeMap::new(),
            valid: BTreeMap::new(),
            module: vectors.spec.name.to_owned(),
        }
    }

    /// What it runs.
    pub fn vectors(&self) -> &Vectors {
        self.vectors
    }

    /// Names of the parameters that it sets.
    pub fn parameters(&self) -> impl Iterator<Item = &'static str> {
        self.vectors.parameters.iter().map(|(name, _)| *name)
    }

    /// Its Verilog.
    pub fn text(&self) -> String {
        let (vectors, spec) = (self.vectors, self.vectors.spec);
        let (name, timing) = (spec.name, &spec.timing);
        let mut text = format!(
            "// Golden vectors for {name} by tofsim {version}: scenario {source}, seed {seed}.\n\
             // Line k of stimulus.mem is taken by edge k, line k of expected.mem seen just before \
             it.\n\
             // Define REGISTERS to compare registers inside too; +got=FILE writes what was seen.\n\
             `timescale 1ps/1fs\n`default_nettype none\n\n\
             module tb_{name};\n  \
               localparam Cycles = {cycles};\n  \
               localparam [63:0] FirstEdge = 64'd{first}; // [ps]\n  \
               localparam [63:0] Period = 64'd{period}; // [ps]\n",
            version = env!("CARGO_PKG_VERSION"),
            source = vectors.source,
            seed = vectors.seed,
            cycles = vectors.stimulus.rows(),
            first = vectors.first_edge_ps,
            period = timing.period_ps(),
        );
        text.push_str(&self.signals());
        text.push_str(&self.instance());
        text.push_str(&self.tasks());
        text.push_str(&self.process());
        text.push_str("endmodule\n\n`default_nettype wire\n");
        text
    }

    /// Declarations of what is connected to the block, and their drivers.
    fn signals(&self) -> String {
        let (vectors, spec) = (self.vectors, self.vectors.spec);
        let driven = |name: &str| vectors.stimulus.columns().iter().any(|c| c.name == name);
        let mut text = String::from("\n");
        for port in spec.ports(self.vectors.neurons) {
            let (name, range) = (&port.name, range(port.width));
            text += &match port.output {
                true => format!("  wire {range}{name};\n"),
                false if driven(name) || name.starts_with("clk") || name == "tdc_stop" => {
                    format!("  reg {range}{name} = {}'d0;\n", port.width)
                }
                false => continue,
            };
        }
        let ports: Vec<_> =
            spec.ports(self.vectors.neurons).into_iter().map(|port| port.name).collect();
        for column in vectors.stimulus.columns().iter().filter(|c| !ports.contains(&c.name)) {
            let Column { name, width, .. } = column;
            text += &format!("  reg {}{name} = {width}'d0;\n", range(*width as u32));
        }
        text += spec.glue.map_or("", |glue| glue.verilog);
        if spec.timing.oscillator {
            text += "  always #2500 clk_200 = !clk_200;\n";
        }
        if let Some(last) = vectors.stops.len().checked_sub(1) {
            text += &stops(last);
        }
        text
    }

    fn instance(&self) -> String {
        let spec = self.vectors.spec;
        let parameter = |(name, value): &(&str, Parameter)| match value {
            Parameter::Number(number) if *number > i32::MAX as u64 => {
                format!("    .{name}(64'd{number})")
            }
            Parameter::Number(number) => format!("    .{name}({number})"),
            Parameter::File(file) => format!("    .{name}(\"{file}\")"),
        };
        let parameters: Vec<_> = self.vectors.parameters.iter().map(parameter).collect();
        let parameters = match parameters.as_slice() {
            [] => String::new(),
            list => format!("#(\n{}\n  ) ", list.join(",\n")),
        };
        let ports: Vec<_> = spec
            .ports(self.vectors.neurons)
            .iter()
            .map(|port| format!("    .{0}({0})", port.name))
            .collect();
        format!("\n  {} {parameters}dut (\n{}\n  );\n", self.module, ports.join(",\n"))
    }

    /// The process that drives everything.
    fn process(&self) -> String {
        let (vectors, timing) = (self.vectors, &self.vectors.spec.timing);
        let name = vectors.spec.name;
        let mut text = String::from(
            "\n  initial begin\n    $readmemh(\"stimulus.mem\", stimulus);\n    \
             $readmemh(\"expected.mem\", expected);\n    \
             if ($value$plusargs(\"got=%s\", got_name)) got_file = $fopen(got_name, \"w\");\n",
        );
        let columns: Vec<_> =
            vectors.stimulus.columns().iter().map(|column| column.name.as_str()).collect();
        let columns = columns.join(", ");
        if vectors.first_edge_ps > timing.period_ps() {
            let _ = writeln!(text, "    {{{columns}}} = stimulus[0];");
            text += "    #(FirstEdge - Period);\n";
        }
        text += "    for (cycle = 0; cycle < Cycles; cycle = cycle + 1) begin\n      \
                 want = expected[cycle];\n      got = want;\n";
        if columns.is_empty() {
            text += "      #1;\n";
        } else {
            let _ = writeln!(text, "      #1 {{{columns}}} = stimulus[cycle];");
        }
        let mut sample = 0;
        for (k, step) in timing.steps.iter().enumerate() {
            let rest = step.length_ps - u64::from(k == 0);
            let last = k + 1 == timing.steps.len();
            if step.sample {
                let _ = writeln!(text, "      #{} look_{sample};", rest - 1);
                sample += 1;
                text += if last { "      compare;\n      #1" } else { "      #1" };
            } else {
                let _ = write!(text, "      #{rest}");
            }
            text += &edges(step, last);
            if let Some((input, column)) = step.late {
                let _ = writeln!(text, "      {input} = {column};");
            }
        }
        let _ = write!(
            text,
            "    end\n    if (got_file != 0) $fclose(got_file);\n    \
             if (mismatches == 0) begin\n      \
             $display(\"tb_{name}: PASS, %0d cycles, 0 mismatches\", Cycles);\n      \
             $finish;\n    end else begin\n      \
             $display(\"tb_{name}: FAIL, %0d cycles, %0d mismatches\", Cycles, mismatches);\n      \
             $fatal(1, \"tb_{name}: %0d mismatches\", mismatches);\n    end\n  end\n",
        );
        text
    }
}

/// The process that drives `tdc_stop`. The fifth of a femtosecond makes a simulator that rounds a
/// delay and one that cuts it off agree; long waits are taken in steps of 1 us, because Verilator 5.006
/// has 32 bits for a delay that is no integer.
fn stops(last: usize) -> String {
    format!(
        "\n  reg [63:0] tdc_stop_at [0:{last}]; // [fs]\n  reg [63:0] now;\n  integer change;\n  \
         initial begin\n    $readmemh(\"tdc_stop.mem\", tdc_stop_at);\n    now = 64'd0;\n    \
         for (change = 0; change <= {last}; change = change + 1) begin\n      \
         while (tdc_stop_at[change] - now > 64'd1000000000) begin\n        \
         #1000000 now = now + 64'd1000000000;\n      end\n      \
         #((tdc_stop_at[change] - now + 0.2) / 1000.0) tdc_stop = !tdc_stop;\n      \
         now = tdc_stop_at[change];\n    end\n  end\n",
    )
}

/// The clocks that change together, in one assignment.
fn edges(step: &Step, last: bool) -> String {
    let names: Vec<_> = step.edges.iter().map(|(name, _)| *name).collect();
    let levels: String =
        step.edges.iter().map(|(_, level)| if *level { '1' } else { '0' }).collect();
    let rises = step.edges.iter().any(|(_, level)| *level);
    let first = if rises && !last { " if (cycle != 0)" } else { "" };
    match names.as_slice() {
        [] => ";\n".to_owned(),
        [name] => format!("{first} {name} = 1'b{levels};\n"),
        _ => format!("{first} {{{}}} = {}'b{levels};\n", names.join(", "), names.len()),
    }
}

/// The range of a vector in a declaration, with a space after it; nothing for a single bit.
pub(crate) fn range(width: u32) -> String {
    if width == 1 { String::new() } else { format!("[{}:0] ", width - 1) }
}

fn place(column: &Column) -> String {
    if column.width == 1 {
        return column.low.to_string();
    }
    format!("{}:{}", column.low + column.width - 1, column.low)
}
