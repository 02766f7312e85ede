//! A user's module that is to be one of our blocks: in Verilog, with what it shows.

use std::borrow::Cow;
use std::path::Path;

use tofsim::error::{Input, Result};
use tofsim::files::output::create_directory;
use tofsim::firmware::forward2::MOST_NEURONS;
use tofsim::kernel::sizes::{Size, Sizes};

use crate::golden::bench::Bench;
use crate::golden::parameters::Parameter;
use crate::golden::ports::Port;
use crate::golden::spec::Vectors;

use super::interface::{Interface, PortShape};
use super::map::{BlockMap, RtlMap};
use super::process::Limits;
use super::rtl::Rtl;
use super::simulator::Simulator;
use super::task::Task;
use super::vhdl;

/// A design under test.
#[derive(Clone, Debug)]
pub struct Dut<'a> {
    /// Its sources.
    pub rtl: &'a Rtl,
    /// Intended differences from ours.
    pub map: Option<&'a RtlMap>,
    /// Simulator that reads and runs it.
    pub simulator: Simulator,
    /// When to give up.
    pub limits: Limits<'a>,
}

/// A module that a bench can be put around.
#[derive(Debug)]
pub(super) struct Candidate<'a> {
    /// The design, with Verilog in place of VHDL.
    pub(super) rtl: Cow<'a, Rtl>,
    /// Ports and parameters of the module.
    pub(super) found: Interface,
    /// Ports for neurons past the last, or for a calibration that there is none of.
    pub(super) past: Vec<Port>,
    /// Inputs that nothing drives.
    pub(super) open: Vec<String>,
    /// Its part of the map.
    pub(super) map: Option<BlockMap>,
    /// True if it has its parameters already: one in VHDL has been given them as generics.
    pub(super) fixed: bool,
}

/// A parameter: our name, theirs, and its value.
type Set<'a> = (&'a str, &'a str, &'a Parameter);

/// The parameters that the bench sets: those that are no constants inside.
fn set<'a>(map: Option<&'a BlockMap>, vectors: &'a Vectors) -> Vec<Set<'a>> {
    let theirs = |ours: &'a str| map.map_or(Some(ours), |map| map.parameter(ours));
    let each = vectors.parameters.iter();
    each.filter_map(|(ours, value)| Some((*ours, theirs(ours)?, value))).collect()
}

impl<'a> Candidate<'a> {
    /// The module of a task's block, or why it cannot be what the task is about.
    ///
    /// # Errors
    /// When it is not there or cannot be compiled, or has other ports or parameters.
    pub(super) fn find(
        dut: &Dut<'a>,
        task: &Task,
        vectors: &Vectors,
        work: &Path,
    ) -> Result<std::result::Result<Self, String>> {
        let (spec, rtl, limits) = (task.spec, dut.rtl, &dut.limits);
        let map = dut.map.map(|map| map.block(spec.name));
        let module = map.as_ref().map_or(spec.name, |map| map.module(spec.name)).to_owned();
        let set = set(map.as_ref(), vectors);
        let fixed = rtl.has_entity(&module);
        let names = || set.iter().map(|(ours, theirs, _)| (*ours, *theirs));
        let named = [module.as_str(), spec.name];
        if fixed {
            let generics = Interface {
                parameters: rtl.generics(&module, set.iter().map(|(_, theirs, _)| *theirs)),
                ..Interface::default()
            };
            if let Some(reason) = dut.cannot_be(task, &module, &generics) {
                return Ok(Err(reason));
            }
            generics.check_parameters(&rtl.source, named, names())?;
        }
        let wanted = |found: &Interface| -> Vec<Port> {
            let ports = map.as_ref().map(|map| map.wanted(spec, &vectors.sizes, found));
            ports.unwrap_or_else(|| spec.ports(&vectors.sizes))
        };
        let tied = map.iter().flat_map(|map| map.tie.keys().cloned());
        let ports: Vec<_> =
            (wanted(&Interface::default()).into_iter().map(|port| port.name)).chain(tied).collect();
        let generics: Vec<_> = set.iter().map(|(_, theirs, value)| (*theirs, *value)).collect();
        let rtl = vhdl::as_verilog(rtl, &module, &generics, &ports, work, limits)?;
        let mut found = dut.simulator.interface(work, &module, &[], &rtl, limits)?;
        if !fixed {
            if let Some(reason) = dut.cannot_be(task, &module, &found) {
                return Ok(Err(reason));
            }
            found.check_parameters(&rtl.source, named, names())?;
            let shapes: Vec<_> = set.iter().filter_map(shape).collect();
            if !shapes.is_empty() {
                found = dut.simulator.interface(work, &module, &shapes, &rtl, limits)?;
            }
        }
        let word = vectors.sizes.count_bits;
        let wanted = wanted(&found);
        found.check_ports(&rtl.source, &module, (&wanted, word))?;
        let past = past(&found, task, &vectors.sizes);
        let is_tied = |name: &str| map.as_ref().is_some_and(|map| map.is_tied(name));
        let is_set = |name: &str| is_tied(name) || has(&wanted, name);
        let past: Vec<_> = past.into_iter().filter(|port| !is_set(&port.name)).collect();
        let open = found.open_inputs(|name| is_set(name) || has(&past, name));
        if let Some(map) = &map {
            map.check_ties(spec.name, &wanted, &found)?;
        }
        Ok(Ok(Candidate { rtl, found, past, open, map, fixed }))
    }
}

/// Returns whether a port has that name.
fn has(ports: &[Port], name: &str) -> bool {
    ports.iter().any(|port| port.name == name)
}

/// The ports that a module has for neurons past the last, and for a calibration, a host, a glass or an array that there
/// is none of.
fn past(found: &Interface, task: &Task, sizes: &Sizes) -> Vec<Port> {
    let used = task.spec.ports(sizes);
    let is_past = |port: &Port| {
        let fits = |found: &PortShape| (found.output, found.width) == (port.output, port.width);
        found.ports.get(&port.name).is_some_and(fits) && !has(&used, &port.name)
    };
    let most = Sizes { neurons: MOST_NEURONS as u32, ..*sizes };
    let columns = sizes.columns.max(2);
    let with_all = Sizes {
        calibrates: true,
        hosted: true,
        has_glass: true,
        has_second: true,
        columns,
        banks: 2,
        ..*sizes
    };
    let inputs = task.spec.ports(&with_all).into_iter().filter(|port| !port.output);
    task.spec.ports(&most).into_iter().chain(inputs).filter(is_past).collect()
}

/// A parameter that ports may depend on, if it is one.
fn shape<'a>((ours, theirs, value): &Set<'a>) -> Option<(&'a str, u64)> {
    match value {
        Parameter::Number(value) if Size::named(ours).is_some() => Some((theirs, *value)),
        _ => None,
    }
}

impl Dut<'_> {
    /// Fits a bench of a task's block to the design's module, for any simulator: what lies between the
    /// two is written into `folder`. The module is looked at in `work`. Returns its inputs that nothing drives.
    ///
    /// # Errors
    /// When the module is not there or cannot be compiled, has other ports or parameters, or is in VHDL.
    pub fn fit(
        &self,
        bench: &mut Bench,
        task: &Task,
        work: &Path,
        folder: &Path,
    ) -> Result<Vec<String>> {
        let fault = |expected: String| Input::new(&self.rtl.source, expected).field(task.spec.name);
        create_directory(work)?;
        let candidate = Candidate::find(self, task, bench.vectors, work)?.map_err(fault)?;
        if candidate.fixed {
            let expected = "expected Verilog; for VHDL there is --language vhdl, without a map";
            return Err(fault(expected.to_owned()).into());
        }
        bench.past = candidate.past;
        if let Some(map) = &candidate.map {
            create_directory(folder)?;
            map.apply(bench, task.spec, &candidate.found, folder)?;
        }
        Ok(candidate.open)
    }

    /// Returns why the design cannot be what a task is about, if it cannot.
    fn cannot_be(&self, task: &Task, module: &str, found: &Interface) -> Option<String> {
        let configuration = task.configuration?;
        let module_of = |block: &str| {
            let map = self.map.map(|map| map.block(block));
            map.as_ref().map_or(block, |map| map.module(block)).to_owned()
        };
        let other = configuration.module.map(module_of);
        if let Some(other) = other.filter(|other| !self.rtl.has(other)) {
            return Some(format!("{} has no module {other}", self.rtl.source));
        }
        let map = self.map.map(|map| map.block(task.spec.name));
        let lacks = |parameter: &&&str| {
            let theirs = map.as_ref().map_or(Some(**parameter), |map| map.parameter(parameter));
            theirs.is_none_or(|theirs| !found.parameters.contains(theirs))
        };
        let missing = configuration.parameters.iter().find(lacks)?;
        Some(format!("module {module} has no parameter {missing}"))
    }
}
