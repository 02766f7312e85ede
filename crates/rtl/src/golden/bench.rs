//! The self-checking bench of a block, in Verilog or in VHDL.
//!
//! One process applies the inputs 1 ps after the edge, moves the clocks and looks 1 ps before the
//! next edge, so that nothing depends on the order in which a simulator takes simultaneous events.

pub mod allowances;
mod columns;
mod steps;
mod vhdl;

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;

use allowances::{Allowances, resets_in};
use columns::{looks, pieces, show};
use steps::{steps, wait};

use tofsim::error::Result;
use tofsim::files::output::{create_directory, write_bytes, write_file};
use tofsim::kernel::Time;
use tofsim::kernel::sizes::Size;
use tofsim::network::mem::{Mem, lines};

use super::parameters::Parameter;
use super::ports::{self, Port};
use super::spec::Vectors;
use super::table::Column;
use super::timing::ASIDE;
use super::verilog::{parameter_list, range};

/// With `+progress`, a bench says after so many cycles how far it is.
const BEAT: usize = 100;

/// Bits of the instant of a change of `column_stop`; above them is the number of its bit.
const TIME_BITS: u32 = 56;

/// Language of a bench.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Language {
    /// Verilog-2005.
    #[default]
    Verilog,
    /// VHDL-2008; strict, and for ports only.
    Vhdl,
}

/// A bench, with what another implementation is allowed.
#[derive(Clone, Debug)]
pub struct Bench<'a> {
    /// Vectors that it runs.
    pub vectors: &'a Vectors,
    /// Deviations that it allows.
    pub allowed: Allowances,
    /// The module that is instantiated.
    pub module: String,
    /// True if the module has its parameters already and cannot be given any.
    pub fixed: bool,
    /// Ports that the module has for neurons past the last or a calibration: inputs that it does not look at, outputs that
    /// stay 0.
    pub past: Vec<Port>,
    /// Parameters that are constants inside the module: it loads memories of its own for them.
    pub constants: BTreeSet<&'static str>,
    /// Its language.
    pub language: Language,
    /// An object whose keys go into `ports.json` too: where the vectors come from.
    pub about: Value,
}

impl<'a> Bench<'a> {
    /// The bench for the reference itself.
    pub fn new(vectors: &'a Vectors) -> Self {
        let (allowed, about) = (Allowances::default(), Value::Null);
        let module = vectors.spec.name.to_owned();
        let (past, language) = (Vec::new(), Language::default());
        let constants = BTreeSet::new();
        Bench { vectors, allowed, module, fixed: false, past, constants, language, about }
    }

    /// Names of the parameters that it sets.
    pub fn parameters(&self) -> impl Iterator<Item = &'static str> {
        self.set().map(|(name, _)| *name)
    }

    fn set(&self) -> impl Iterator<Item = &'a (&'static str, Parameter)> {
        self.vectors.parameters.iter().filter(|_| !self.fixed)
    }

    /// Writes it with all files that it needs into a folder, which is made if it is not there.
    ///
    /// # Errors
    /// When one cannot be written, or the language has no such parameter.
    pub fn write(&self, folder: &Path) -> Result<()> {
        create_directory(folder)?;
        let text = |name: &str, text: &str| write_bytes(&folder.join(name), text);
        let vectors = self.vectors;
        let is_inside = |memory: &&Mem| {
            let own = |(name, value): &(&'static str, Parameter)| {
                self.constants.contains(name)
                    && matches!(value, Parameter::Memory(own) if own.name == memory.name)
            };
            vectors.parameters.iter().any(own)
        };
        for memory in vectors.memories().filter(|memory| !is_inside(memory)) {
            text(&memory.name, &memory.text)?;
        }
        if !vectors.stops.is_empty() {
            text("tdc_stop.mem", &lines(vectors.stops.iter().map(|at| at.fs()), 16))?;
        }
        if !vectors.column_stops.is_empty() {
            let word = |(at, bit): &(Time, u32)| u64::from(*bit) << TIME_BITS | at.fs();
            text("column_stop.mem", &lines(vectors.column_stops.iter().map(word), 16))?;
        }
        for (name, table) in
            [("stimulus.mem", &vectors.stimulus), ("expected.mem", &vectors.expected)]
        {
            write_file(&folder.join(name), |file| table.write(file))?;
        }
        let mut ports = ports::json(vectors);
        if let (Some(ports), Some(about)) = (ports.as_object_mut(), self.about.as_object()) {
            ports.extend(about.clone());
        }
        text("ports.json", &format!("{ports:#}\n"))?;
        match self.language {
            Language::Verilog => text(&(vectors.bench_module() + ".v"), &self.text()),
            Language::Vhdl => text(&(vectors.bench_module() + ".vhd"), &vhdl::text(vectors)?),
        }
    }

    /// Its Verilog.
    fn text(&self) -> String {
        let (vectors, spec) = (self.vectors, self.vectors.spec);
        let ports = spec.ports(&vectors.sizes);
        let parameters: Vec<_> = self.set().map(parameter).collect();
        let past =
            self.past.iter().map(|port| if port.output { port.connection() } else { port.ones() });
        let connected = ports.iter().map(Port::connection).chain(past);
        let connected: Vec<_> = connected.map(|port| format!("    {port}")).collect();
        let columns = vectors.expected.columns();
        let allowances = columns.iter().map(|column| self.allowed.text(column, vectors));
        let inputs: Vec<_> = vectors.stimulus.columns().iter().map(|c| c.name.as_str()).collect();
        let inputs = inputs.join(", ");
        let before = vectors.first_edge.since(vectors.period());
        let before = if before > Time::ZERO {
            format!("    {{{inputs}}} = stimulus[0];\n    {};\n", wait(before))
        } else {
            String::new()
        };
        format!(
            include_str!("bench/bench.v"),
            name = spec.name,
            version = env!("CARGO_PKG_VERSION"),
            source = vectors.source,
            seed = vectors.seed,
            cycles = vectors.stimulus.rows(),
            first_edge = vectors.first_edge.fs(),
            period = vectors.period().fs(),
            signals =
                signals(vectors, &ports) + &self.past_signals() + self.allowed.declaration(vectors),
            module = self.module,
            parameters = parameter_list(&parameters, "  "),
            ports = connected.join(",\n"),
            line_in = range(vectors.stimulus.width().max(1) as u32),
            line_out = range(vectors.expected.width() as u32),
            looks = looks(vectors),
            got = pieces("got", vectors.expected.width()),
            allowances = self.allowed.search(vectors) + &allowances.collect::<String>(),
            beat = BEAT,
            quiet = self.allowed.quiet(vectors),
            resets = self.resets(),
            show = show(vectors) + &self.show_past(),
            before = before,
            steps = steps(vectors, &inputs),
        )
    }

    fn past_outputs(&self) -> impl Iterator<Item = &Port> {
        self.past.iter().filter(|port| port.output)
    }

    /// Declares the outputs past the last neuron, and whether one of them is not 0.
    fn past_signals(&self) -> String {
        let declare = |port: &Port| format!("  wire {}{};\n", range(port.width), port.name);
        let names: Vec<_> = self.past_outputs().map(|port| port.name.as_str()).collect();
        let any =
            if names.is_empty() { "1'b0".to_owned() } else { format!("|{{{}}}", names.join(", ")) };
        self.past_outputs().map(declare).collect::<String>() + &format!("  wire past = {any};\n")
    }

    /// Lines that say which of them is not 0.
    fn show_past(&self) -> String {
        let show = |Port { name, width, .. }: &Port| {
            format!(
                "    if ({name} !== {width}'d0)\n      \
                 $display(\"mismatch: cycle %0d, time %0d ps, {name}: expected %h, got %h\",\n        \
                 cycle, (FirstEdge + cycle * Period - 64'd{aside}) / 1000, {width}'d0, {name});\n",
                aside = ASIDE.fs(),
            )
        };
        self.past_outputs().map(show).collect()
    }

    /// Statements for a line that resets the block: which lines are compared from then on.
    fn resets(&self) -> String {
        let Allowances { settle, .. } = self.allowed;
        let levels = resets_in("cycle", self.vectors);
        if levels.is_empty() {
            return String::new();
        }
        format!(
            "    if ({levels})\n      quiet = quiet < 0 ? {} : quiet < {settle} ? {settle} : quiet;\n",
            self.allowed.quiet_after_first(),
        )
    }
}

/// A parameter as the instance sets it.
fn parameter((name, value): &(&'static str, Parameter)) -> String {
    format!("    .{name}({})", value.literal())
}

/// Declarations of what is connected to the block, and their drivers.
fn signals(vectors: &Vectors, ports: &[Port]) -> String {
    let (spec, inputs) = (vectors.spec, vectors.stimulus.columns());
    let mut text = String::new();
    for Port { name, width, output, .. } in ports {
        let is_column = inputs.iter().any(|column| column.name == *name);
        if *output {
            text += &format!("  wire {}{name};\n", range(*width));
        } else if is_column || name.starts_with("clk") || name.ends_with("_stop") {
            text += &format!("  reg {}{name} = {width}'d0;\n", range(*width));
        }
    }
    for Column { name, width, .. } in inputs {
        if !ports.iter().any(|port| port.name == *name) {
            text += &format!("  reg {}{name} = {width}'d0;\n", range(*width as u32));
        }
    }
    text += &spec.glue.map_or(String::new(), |glue| glue.verilog(&vectors.sizes));
    if spec.timing.oscillator {
        text += &format!("  always {} clk_in = !clk_in;\n", wait(vectors.half_of_oscillator()));
    }
    // Long waits are taken in steps of 1 us.
    if let Some(last) = vectors.stops.len().checked_sub(1) {
        text += &format!(include_str!("bench/stops.v"), last = last);
    }
    if let Some(last) = vectors.column_stops.len().checked_sub(1) {
        let width = vectors.sizes.of(Size::LastColumn);
        text += &format!(include_str!("bench/column_stops.v"), last = last, width = width);
    }
    text
}
