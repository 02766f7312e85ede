//! The signals of the firmware as a waveform shows them: scopes, names and drivers.
//!
//! The hierarchy is the Verilog's. A signal that a module stores or a wire carries has an id of
//! its own; a port that passes it on is an alias of the same id, found by the same connections
//! that the simulation uses.

use crate::kernel::connect::Connection;
use crate::kernel::signals::{Format, Signal};

use crate::firmware::histogram_builder::BINS;
use crate::firmware::tof_top::{CodeSource, Estimator, HistogramSource, Params, Wires};
use crate::firmware::{depth_estimator, tdc, vcsel_driver};

mod groups;
mod instants;
mod part;
mod ports;

use groups::{RAM, follow, groups};
pub use groups::{changes, copy};
pub use instants::Instants;
pub use part::Part;
use ports::{CLOCKS, SHOWN, in_socket, place};

/// Name of the top scope.
pub const TOP: &str = "tof_top";

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Input port of its module.
    Input,
    /// Output port of its module.
    Output,
    /// Register or wire inside its module.
    Internal,
}

/// One name in one scope.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Dotted path of the module, `tof_top` first.
    pub scope: String,
    /// Name, width, format and meaning.
    pub signal: Signal,
    /// Port or not.
    pub kind: Kind,
    /// The value it shows; aliases share it.
    pub id: usize,
}

impl Entry {
    /// Dotted path of the signal.
    pub fn path(&self) -> String {
        format!("{}.{}", self.scope, self.signal.name)
    }
}

/// Every name in every scope that those parameters have, without the RAM's words.
pub fn entries(params: &Params) -> Vec<Entry> {
    let absent = absent(params);
    let neurons = params.depth_estimator.neurons();
    let mut entries = of_network(with_in_socket(params.estimator), neurons);
    entries.retain(|entry| !absent.iter().any(|scope| within(&entry.scope, scope)));
    entries
}

/// Every name in every scope with so many neurons, without the RAM's words.
pub fn every_entry_of(neurons: usize) -> Vec<Entry> {
    of_network(every_entry(), neurons)
}

fn of_network(entries: Vec<Entry>, neurons: usize) -> Vec<Entry> {
    let fit = |entry: Entry| Some(Entry { signal: fitted(entry.signal, neurons)?, ..entry });
    entries.into_iter().filter_map(fit).collect()
}

/// A signal as an estimator with so many neurons has it: not at all past the last of them, and their
/// count just as wide as it has to be.
pub fn fitted(signal: Signal, neurons: usize) -> Option<Signal> {
    let is_there = |place: &str| place.parse::<usize>().is_ok_and(|neuron| neuron < neurons);
    match signal.name.rsplit_once('_') {
        Some(("l1_in" | "l1_out" | "weight", place)) => is_there(place).then_some(signal),
        _ if signal.name == "neuron" => Some(Signal { width: (neurons + 1).ilog2() + 1, ..signal }),
        _ => Some(signal),
    }
}

/// Every name in every scope that there can be, in the order of the hierarchy, without the RAM's
/// words.
pub fn every_entry() -> Vec<Entry> {
    with_in_socket(Estimator::default())
}

/// The same with that estimator in the socket.
fn with_in_socket(estimator: Estimator) -> Vec<Entry> {
    let mut build = Build { estimator, ..Build::default() };
    build.held();
    build.shown();
    build.inputs("", &Wires::inputs(), Wires::CONNECTIONS);
    build.inputs("tdc", &tdc::Wires::inputs(), tdc::Wires::CONNECTIONS);
    let estimator = depth_estimator::Wires::inputs();
    build.inputs("depth_estimator", &estimator, depth_estimator::Wires::CONNECTIONS);
    let driver = vcsel_driver::Wires::inputs();
    build.inputs("vcsel_driver", &driver, vcsel_driver::Wires::CONNECTIONS);
    build.clocks();
    build.entries.sort_by_key(|entry| (place(&entry.scope), entry.kind as u8));
    build.entries
}

/// The words of the histogram's RAM, `histogram_builder.ram_0` to `ram_255`.
pub fn ram_entries() -> Vec<Entry> {
    let word = |bin| Entry {
        scope: format!("{TOP}.histogram_builder"),
        signal: Signal {
            name: format!("ram_{bin}"),
            width: 16,
            format: Format::Unsigned,
            output: false,
            doc: "Word of the histogram [hits].",
        },
        kind: Kind::Internal,
        id: RAM + bin,
    };
    (0..BINS).map(word).collect()
}

/// Number of ids.
pub const IDS: usize = RAM + BINS;

/// Modules that those parameters leave out.
fn absent(params: &Params) -> Vec<&'static str> {
    let mut absent = Vec::new();
    match params.code_source {
        CodeSource::Tdc => absent.push("tof_top.code_preload"),
        CodeSource::Preload(_) => absent.push("tof_top.tdc"),
    }
    match params.histogram_source {
        HistogramSource::Builder => absent.push("tof_top.histogram_preload"),
        HistogramSource::Preload(_) => absent.push("tof_top.histogram_builder"),
    }
    match params.estimator {
        Estimator::Network => absent.push("tof_top.centroid_estimator"),
        Estimator::Centroid => absent.push("tof_top.depth_estimator"),
    }
    absent
}

/// Whether a dotted path lies in another or is the same.
pub fn within(scope: &str, parent: &str) -> bool {
    scope.strip_prefix(parent).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

#[derive(Default)]
struct Build {
    /// The one in the socket.
    estimator: Estimator,
    entries: Vec<Entry>,
    /// Path of the field in the Rust structs, for each entry that holds a value.
    held: Vec<(String, usize)>,
}

impl Build {
    fn held(&mut self) {
        for (scope, field, signals) in groups() {
            for signal in signals {
                let id = self.held.len();
                self.held.push((format!("{field}.{}", signal.name), id));
                let kind = match (field, signal.output) {
                    ("pins", _) => Kind::Input,
                    ("clocks", _) if signal.name == "clk_200" => Kind::Input,
                    ("clocks" | "nets", _) | (_, false) => Kind::Internal,
                    (_, true) => Kind::Output,
                };
                self.entries.push(Entry { scope: scope_path(scope), signal, kind, id });
            }
        }
    }

    fn shown(&mut self) {
        for &(scope, name, kind, holder) in SHOWN {
            self.alias(scope, name, kind, holder, None);
        }
    }

    fn inputs(
        &mut self,
        parent: &str,
        modules: &[(&str, Vec<Signal>)],
        connections: &[Connection],
    ) {
        for &(module, port, source) in connections {
            let scope =
                if parent.is_empty() { module.into() } else { format!("{parent}.{module}") };
            let signals = modules.iter().filter(|(name, _)| *name == module);
            let doc = |port: &str| {
                let mut list = signals.clone().flat_map(|(_, list)| list);
                list.find(|s| s.name == port || s.name == format!("{port}_0")).map(|s| s.doc)
            };
            let holder = match source.split_once('.') {
                Some(("this", rest)) if parent.is_empty() => rest.to_owned(),
                Some(("this", rest)) => format!("{parent}.{rest}"),
                Some((_, own)) => driver_of(parent, own),
                None => String::new(),
            };
            self.alias(&scope, port, Kind::Input, &holder, doc(port));
        }
    }

    fn clocks(&mut self) {
        for &(scope, clocks) in CLOCKS {
            for clock in clocks {
                self.alias(scope, clock, Kind::Input, &format!("clocks.{clock}"), None);
            }
        }
    }

    /// Shows, under `name`, what `holder` holds; an array under `name_0`, `name_1` ...
    fn alias(
        &mut self,
        scope: &str,
        name: &str,
        kind: Kind,
        holder: &str,
        doc: Option<&'static str>,
    ) {
        let holder = in_socket(self.estimator, holder);
        let element = format!("{holder}_");
        let found: Vec<_> = (self.held.iter())
            .filter_map(|(path, id)| match path.strip_prefix(&element) {
                _ if path == holder => Some((name.to_owned(), *id)),
                Some(k) if k.bytes().all(|b| b.is_ascii_digit()) => {
                    Some((format!("{name}_{k}"), *id))
                }
                _ => None,
            })
            .collect();
        for (name, id) in found {
            let of = &self.entries[id].signal;
            let doc = doc.unwrap_or(of.doc);
            let signal = Signal { name, doc, output: kind == Kind::Output, ..of.clone() };
            self.entries.push(Entry { scope: scope_path(scope), signal, kind, id });
        }
    }
}

/// What the top connects to a port of one of its modules.
fn driver_of(module: &str, port: &str) -> String {
    let connection = Wires::CONNECTIONS.iter().find(|c| (c.0, c.1) == (module, port));
    connection.map_or("", |c| c.2).trim_start_matches("this.").to_owned()
}

fn scope_path(scope: &str) -> String {
    if scope.is_empty() { TOP.to_owned() } else { format!("{TOP}.{scope}") }
}
