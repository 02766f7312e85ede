//! The signals of the firmware as a waveform shows them: scopes, names and drivers.
//!
//! The hierarchy is the Verilog's. A signal that a module stores or a wire carries has an id of
//! its own; a port that passes it on is an alias of the same id, found by the same connections
//! that the simulation uses.

use crate::kernel::connect::Connection;
use crate::kernel::signals::{Format, Signal, Signals, Sink};

use crate::firmware::histogram_builder::BINS;
use crate::firmware::tof_top::{CodeSource, HistogramSource, Params, TofTop, Wires};
use crate::firmware::{depth_estimator, tdc, vcsel_driver};

mod part;
mod ports;

pub use part::Part;
use part::ram_changes;
use ports::{CLOCKS, SHOWN, place};

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

/// The groups of signals that hold values, in the order of their ids: scope below the top, path
/// of the field in [`TofTop`], type.
macro_rules! groups {
    ($($scope:literal => $root:ident $(. $field:ident)*: $ty:ty;)*) => {
        fn groups() -> Vec<(&'static str, &'static str, Vec<Signal>)> {
            vec![$((
                $scope,
                concat!(stringify!($root) $(, ".", stringify!($field))*),
                <$ty as Signals>::list(),
            ),)*]
        }

        /// First id of the RAM's words, after those of all groups.
        const RAM: usize = 0 $(+ <$ty as Signals>::COUNT)*;

        /// Reports every signal that differs from `before`, or every one.
        pub fn changes(top: &TofTop, before: Option<&TofTop>, sink: &mut impl Sink) {
            let _id = 0;
            $(
                let (now, then) = (&top.$root $(.$field)*, before.map(|b| &b.$root $(.$field)*));
                if then != Some(now) {
                    now.changes(then, _id, sink);
                }
                let _id = _id + <$ty as Signals>::COUNT;
            )*
            ram_changes(top, before, sink);
        }

        /// Reports every signal that differs from `kept` in those groups, a bit for each, and keeps
        /// it there.
        #[inline]
        fn follow(top: &TofTop, groups: u32, kept: &mut TofTop, sink: &mut impl Sink) {
            let (_id, _group) = (0, 1);
            $(
                if groups & _group != 0 {
                    let (now, then) = (&top.$root $(.$field)*, &mut kept.$root $(.$field)*);
                    if then != now {
                        now.changes(Some(&*then), _id, sink);
                        *then = *now;
                    }
                }
                let (_id, _group) = (_id + <$ty as Signals>::COUNT, _group << 1);
            )*
        }

        /// Makes all that [`changes`] looks at in `to` what it is in `from`, without allocating.
        pub fn copy(from: &TofTop, to: &mut TofTop) {
            $(to.$root $(.$field)* = from.$root $(.$field)*;)*
            to.histogram_builder.ram.copy_from_slice(&from.histogram_builder.ram[..]);
        }
    };
}

groups! {
    "" => clocks: crate::firmware::tof_top::Clocks;
    "" => pins: crate::firmware::tof_top::Pins;
    "" => nets: crate::firmware::tof_top::Nets;
    "pll" => pll: crate::firmware::pll::Out;
    "reset_sync_125" => reset_sync_125: crate::firmware::reset_sync::ResetSync;
    "reset_sync_250" => reset_sync_250: crate::firmware::reset_sync::ResetSync;
    "control_sync" => control_sync: crate::firmware::control_sync::ControlSync;
    "frame_ctrl" => frame_ctrl: crate::firmware::frame_ctrl::FrameCtrl;
    "vcsel_driver" => vcsel_driver.registers: vcsel_driver::Registers;
    "vcsel_driver" => vcsel_driver.registers_250: vcsel_driver::Registers250;
    "vcsel_driver.ddr_output" => vcsel_driver.ddr_output: crate::firmware::ddr_output::DdrOutput;
    "lvds_output" => lvds_output: crate::firmware::lvds_output::Out;
    "spad_control" => spad_control: crate::firmware::spad_control::SpadControl;
    "tdc.carry_chain" => tdc.carry_chain: crate::firmware::carry_chain::CarryChain;
    "tdc.coarse_counter" => tdc.coarse_counter: crate::firmware::coarse_counter::CoarseCounter;
    "tdc.tdc_latch" => tdc.tdc_latch: crate::firmware::tdc_latch::TdcLatch;
    "tdc.tdc_decoder" => tdc.tdc_decoder: crate::firmware::tdc_decoder::TdcDecoder;
    "code_preload" => code_preload: crate::firmware::code_preload::CodePreload;
    "depth_estimator.estimator_ctrl" =>
        depth_estimator.estimator_ctrl: crate::firmware::estimator_ctrl::EstimatorCtrl;
    "depth_estimator.forward1" => depth_estimator.forward1: crate::firmware::forward1::Forward1;
    "depth_estimator.tansig" => depth_estimator.tansig: crate::firmware::tansig::Tansig;
    "depth_estimator.forward2" => depth_estimator.forward2: crate::firmware::forward2::Forward2;
}

/// Every name in every scope that those parameters have, without the RAM's words.
pub fn entries(params: &Params) -> Vec<Entry> {
    let absent = absent(params);
    let mut entries = every_entry();
    entries.retain(|entry| !absent.iter().any(|scope| within(&entry.scope, scope)));
    entries
}

/// Every name in every scope, in the order of the hierarchy, without the RAM's words.
pub fn every_entry() -> Vec<Entry> {
    let mut build = Build::default();
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
    absent
}

/// Whether a dotted path lies in another or is the same.
pub fn within(scope: &str, parent: &str) -> bool {
    scope.strip_prefix(parent).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

#[derive(Default)]
struct Build {
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
