//! Construction of the list of all names in all scopes, by traversing the firmware.

use crate::firmware::tof_top::FirmwareEstimator;
use crate::firmware::tof_top::TofTop;
use crate::kernel::module::{Alias, Instance, Module, Visitor};
use crate::kernel::signals::{Signal, Signals, Unit, View};
use crate::kernel::sizes::Size;

use super::entry::{Entry, Kind, TOP};

/// State of the traversal. Paths are dotted and start below the top.
#[derive(Default)]
pub(super) struct Build {
    /// Path of the current module.
    path: String,
    /// Sources of its input ports.
    sources: Vec<(&'static str, String)>,
    /// Paths of all modules, in order.
    scopes: Vec<String>,
    /// Signals that store a value, in order of id, each with the index of its scope.
    held: Vec<(usize, Entry)>,
    /// Path of the field of each stored signal.
    fields: Vec<String>,
    aliases: Vec<Shown>,
}

/// What an input port has of its own, and not from the stored signal.
#[derive(Clone, Copy)]
struct Port {
    doc: &'static str,
    unit: Unit,
    only_if: Option<Size>,
}

impl Port {
    fn of(signal: &Signal) -> Self {
        Port { doc: signal.doc, unit: signal.unit, only_if: signal.only_if }
    }
}

/// An alias of a stored signal.
struct Shown {
    /// Index of the scope.
    scope: usize,
    name: &'static str,
    kind: Kind,
    /// Path of the field that stores the value.
    holder: String,
    /// The input port, if it is one of a module inside.
    port: Option<Port>,
}

impl Build {
    /// Lists every name in every scope, in the order of the modules, with the given estimator in the estimator slot.
    pub(super) fn entries(estimator: FirmwareEstimator) -> Vec<Entry> {
        let mut build = Build { scopes: vec![String::new()], ..Build::default() };
        TofTop::default().visit(None, &mut build);
        let aliases = build.aliases.iter().flat_map(|alias| build.shown(alias, estimator));
        let mut entries: Vec<_> = build.held.iter().cloned().chain(aliases).collect();
        // A register that is a port for a host only stands where it stands without one.
        let rank = |entry: &Entry| match entry.signal.only_if {
            Some(Size::Hosted) if entry.kind == Kind::Output => Kind::Internal,
            _ => entry.kind,
        };
        entries.sort_by_key(|(scope, entry)| (*scope, rank(entry) as u8));
        entries.into_iter().map(|(_, entry)| entry).collect()
    }

    /// Returns the index of a module's path among the scopes.
    fn place(&self, path: &str) -> usize {
        self.scopes.iter().position(|scope| scope == path).unwrap_or_default()
    }

    fn alias(&mut self, name: &'static str, kind: Kind, holder: String, port: Option<Port>) {
        let scope = self.place(&self.path);
        self.aliases.push(Shown { scope, name, kind, holder, port });
    }

    /// Returns the path of the field that stores the value of `source`, an expression inside the module at `parent`.
    fn holder(&self, parent: &str, source: &str) -> String {
        match source.split_once('.') {
            Some(("this", rest)) => join(parent, rest),
            Some((_, port)) => {
                let of_port = self.sources.iter().find(|(name, _)| *name == port);
                of_port.map(|(_, holder)| holder.clone()).unwrap_or_default()
            }
            None => String::new(),
        }
    }

    /// Returns the field that drives an output of the estimator slot; other signals are returned unchanged. A port that
    /// the estimator does not have is driven by an estimator that has it and never runs: zero, as in the Verilog.
    fn in_slot(&self, estimator: FirmwareEstimator, holder: &str) -> String {
        let Some(port) = holder.strip_prefix("slot.") else { return holder.to_owned() };
        let port = port.rsplit('.').next().unwrap_or_default();
        let others = FirmwareEstimator::ALL.iter().copied();
        let mut all = [estimator].into_iter().chain(others);
        all.find_map(|one| self.output(one.module(), port)).unwrap_or_default()
    }

    /// Returns the field that drives an output port of a module, if the module has that port.
    fn output(&self, module: &str, port: &str) -> Option<String> {
        let scope = self.place(module);
        let is_port =
            |alias: &&Shown| (alias.scope, alias.name, alias.kind) == (scope, port, Kind::Output);
        if let Some(alias) = self.aliases.iter().find(is_port) {
            return Some(alias.holder.clone());
        }
        let own = self.held.iter().find(|(at, entry)| (*at, &*entry.signal.name) == (scope, port));
        own.map(|(_, entry)| self.fields[entry.id].clone())
    }

    /// Lists the entries of an alias: one, or one per element of an array (`name_0`, `name_1`, ...).
    fn shown(&self, alias: &Shown, estimator: FirmwareEstimator) -> Vec<(usize, Entry)> {
        let holder = self.in_slot(estimator, &alias.holder);
        let element = format!("{holder}_");
        let name = |field: &String| match field.strip_prefix(&element) {
            _ if *field == holder => Some(alias.name.to_owned()),
            Some(k) if k.bytes().all(|b| b.is_ascii_digit()) => Some(format!("{}_{k}", alias.name)),
            _ => None,
        };
        let entry = |(id, field): (usize, &String)| {
            let (name, of) = (name(field)?, &self.held[id].1.signal);
            let stored = Port::of(of);
            let Port { doc, unit, only_if } = alias.port.unwrap_or(stored);
            // A value has the same unit everywhere, though not every name of it states one.
            let unit = if of.unit == Unit::default() { unit } else { of.unit };
            let (output, view) = (alias.kind == Kind::Output, View::NONE);
            let signal = Signal { name, doc, unit, only_if, output, view, ..of.clone() };
            let scope = scope_path(&self.scopes[alias.scope]);
            Some((alias.scope, Entry { scope, signal, kind: alias.kind, id }))
        };
        self.fields.iter().enumerate().filter_map(entry).collect()
    }
}

impl Visitor for Build {
    fn signals<S: Signals>(&mut self, field: &'static str, _: &S, _: Option<&mut S>) {
        let place = self.place(&self.path);
        for signal in S::list() {
            let id = self.held.len();
            self.fields.push(join(&join(&self.path, field), &signal.name));
            let kind = match (field, signal.output) {
                ("pins", _) => Kind::Input,
                ("clocks", _) if signal.name == "clk_in" => Kind::Input,
                ("clocks" | "nets", _) | (_, false) => Kind::Internal,
                (_, true) => Kind::Output,
            };
            self.held.push((place, Entry { scope: scope_path(&self.path), signal, kind, id }));
        }
    }

    fn aliases(&mut self, aliases: &'static [Alias]) {
        for &Alias { name, output, source } in aliases {
            let kind = if output { Kind::Output } else { Kind::Internal };
            self.alias(name, kind, self.holder(&self.path, source), None);
        }
    }

    fn module<M: Module>(&mut self, instance: &'static Instance, now: &M, _: Option<&mut M>) {
        let parent = self.path.clone();
        let holder = |source: &str| self.holder(&parent, source);
        let sources: Vec<_> =
            instance.sources.iter().map(|(port, source)| (*port, holder(source))).collect();
        let outputs: Vec<_> =
            instance.outputs.iter().map(|(port, source)| (*port, holder(source))).collect();
        let outer = std::mem::replace(&mut self.sources, sources.clone());
        self.path = join(&parent, instance.name);
        self.scopes.push(self.path.clone());

        // A clock that has another name outside goes before the other inputs.
        let (renamed, own): (Vec<_>, Vec<_>) =
            instance.clocks.iter().partition(|(port, clock)| port != clock);
        let clock = |clock: &str| format!("clocks.{clock}");
        for (port, source) in renamed {
            self.alias(port, Kind::Input, clock(source), None);
        }
        let inputs = (instance.inputs)();
        for (port, holder) in sources {
            let is_port = |s: &&Signal| s.name == port || s.name == format!("{port}_0");
            let own = inputs.iter().find(is_port);
            self.alias(port, Kind::Input, holder, own.map(Port::of));
        }
        for (port, source) in own {
            self.alias(port, Kind::Input, clock(source), None);
        }
        now.visit(None, self);
        for (port, holder) in outputs {
            self.alias(port, Kind::Output, holder, None);
        }
        (self.path, self.sources) = (parent, outer);
    }
}

/// Joins two dotted paths, either of which may be empty.
fn join(parent: &str, rest: &str) -> String {
    let parts = [parent, rest].into_iter().filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join(".")
}

fn scope_path(path: &str) -> String {
    join(TOP, path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hierarchy::every_entry;

    /// Counts the ports that each module declares.
    struct Ports(String, Vec<String>);

    impl Visitor for Ports {
        fn signals<S: Signals>(&mut self, _: &'static str, _: &S, _: Option<&mut S>) {}

        fn aliases(&mut self, aliases: &'static [Alias]) {
            self.1.extend(aliases.iter().map(|alias| join(&self.0, alias.name)));
        }

        fn module<M: Module>(&mut self, instance: &'static Instance, now: &M, _: Option<&mut M>) {
            let mut inside = Ports(join(&self.0, instance.name), Vec::new());
            let inputs = (instance.inputs)().into_iter().map(|signal| signal.name);
            let clocks = instance.clocks.iter().chain(instance.outputs);
            let names = inputs.chain(clocks.map(|(port, _)| (*port).to_owned()));
            inside.1.extend(names.map(|name| join(&inside.0, &name)));
            now.visit(None, &mut inside);
            self.1.append(&mut inside.1);
        }
    }

    #[test]
    fn every_port_and_wire_shows_a_value_and_no_name_comes_twice() {
        let mut ports = Ports(TOP.to_owned(), Vec::new());
        TofTop::default().visit(None, &mut ports);
        let mut paths: Vec<_> = every_entry().iter().map(Entry::path).collect();
        paths.sort_unstable();
        for path in &ports.1 {
            assert!(paths.binary_search(path).is_ok(), "{path}");
        }
        assert!(ports.1.len() > 150 && paths.is_sorted_by(|a, b| a < b));
    }

    #[test]
    fn the_top_shows_the_outputs_of_the_estimator_in_the_slot() {
        for &estimator in FirmwareEstimator::ALL {
            let entries = Build::entries(estimator);
            let id = |path: &str| entries.iter().find(|e| e.path() == path).map(|e| e.id);
            for port in ["read_en", "read_addr", "depth", "sigma", "status", "valid", "algo_done"] {
                let own = id(&format!("tof_top.{}.{port}", estimator.module()));
                let unused = id(&format!("tof_top.likelihood_estimator.{port}"));
                let own = if estimator.states_sigma() { own } else { own.or(unused) };
                assert_eq!(id(&format!("tof_top.{port}")), own, "{estimator:?} {port}");
                assert!(own.is_some(), "{estimator:?} {port}");
            }
        }
    }
}
