//! `ports.json`: what the lines of a block's vectors hold, for other people's benches.

use serde_json::{Value, json};

use tofsim::hierarchy::{self, Entry, Kind};
use tofsim::kernel::Time;
use tofsim::kernel::sizes::Sizes;

use super::parameters::{Parameter, Parameters};
use super::spec::{Spec, Vectors};
use super::table::{Column, Table};
use super::verilog::range;

/// A port of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// Its name.
    pub name: String,
    /// Its width [bits].
    pub width: u32,
    /// True if the block drives it.
    pub output: bool,
    /// Its meaning.
    pub meaning: &'static str,
}

impl Port {
    /// Returns whether it is a clock that the block takes.
    pub fn is_clock(&self) -> bool {
        !self.output && self.name.starts_with("clk")
    }

    /// Returns its direction, as Verilog says it.
    pub fn direction(&self) -> &'static str {
        if self.output { "output" } else { "input" }
    }

    /// Its declaration in a module, without a sign.
    pub fn declaration(&self) -> String {
        format!("{} wire {}{}", self.direction(), range(self.width), self.name)
    }

    /// Its connection to ones, which it must not look at.
    pub fn ones(&self) -> String {
        format!(".{}({{{}{{1'b1}}}})", self.name, self.width)
    }

    /// Its connection to a signal of its name.
    pub fn connection(&self) -> String {
        format!(".{0}({0})", self.name)
    }
}

impl Spec {
    /// The block's ports in a design of those sizes, clocks and inputs before outputs.
    pub fn ports(&self, sizes: &Sizes) -> Vec<Port> {
        let path = self.path();
        let port = |entry: Entry| Port {
            width: entry.signal.width,
            output: entry.kind == Kind::Output,
            meaning: entry.signal.doc,
            name: entry.signal.name,
        };
        let entries = hierarchy::every_entry_of(sizes).into_iter();
        let own = entries.filter(|entry| entry.scope == path && entry.kind != Kind::Internal);
        let mut ports: Vec<_> = own.map(port).collect();
        ports.sort_by_key(|port| (port.output, !port.is_clock()));
        ports
    }
}

/// The description of the vectors.
pub fn json(vectors: &Vectors) -> Value {
    let spec = vectors.spec;
    let timing = &spec.timing;
    let reset = spec.reset.map(|name| json!({"name": name, "active": "high", "synchronous": true}));
    json!({
        "schema": "tofsim.ports/1",
        "tofsim": env!("CARGO_PKG_VERSION"),
        "block": spec.name,
        "scenario": vectors.source,
        "seed": vectors.seed,
        "cycles": vectors.stimulus.rows(),
        "clock": {
            "name": timing.clock,
            "period_ps": in_ps(vectors.period()),
            "first_edge_ps": in_ps(vectors.first_edge),
        },
        "reset": reset,
        "latency": spec.latency.iter().map(|latency| json!({
            "from": latency.from, "to": latency.to, "cycles": (latency.cycles)(vectors),
        })).collect::<Vec<_>>(),
        "parameters": parameters(&vectors.parameters),
        "ports": spec.ports(&vectors.sizes).iter().map(|port| json!({
            "name": port.name,
            "width": port.width,
            "direction": port.direction(),
            "meaning": port.meaning,
        })).collect::<Vec<_>>(),
        "stimulus": columns(&vectors.stimulus, |_, _| ()),
        "expected": columns(&vectors.expected, |column, value| {
            value["before_edge_ps"] = in_ps(vectors.before_edge(column.sample));
            value["register"] = json!(column.internal);
        }),
        "roms": vectors.memories().map(|memory| &*memory.name).collect::<Vec<_>>(),
    })
}

/// Picoseconds, a whole number where it is one.
fn in_ps(time: Time) -> Value {
    if time.fs().is_multiple_of(1000) { json!(time.ps()) } else { json!(time.fs() as f64 / 1e3) }
}

fn parameters(parameters: &Parameters) -> Value {
    let value = |parameter: &Parameter| match parameter {
        Parameter::Number(number) => json!(number),
        Parameter::Words(words) => json!(words),
        Parameter::Memory(memory) => json!(memory.name),
        Parameter::Flag(_) => json!(1),
    };
    parameters.iter().map(|(name, parameter)| ((*name).to_owned(), value(parameter))).collect()
}

/// The columns, first to last, top bits first.
fn columns(table: &Table, more: impl Fn(&Column, &mut Value)) -> Vec<Value> {
    let describe = |column: &Column| {
        let mut value = json!({"name": column.name, "width": column.width, "low_bit": column.low});
        more(column, &mut value);
        value
    };
    table.columns().iter().map(describe).collect()
}
