//! Places of the scopes in the Verilog, to which waveforms point. The lines are those that the connections have found at
//! compile time.

use crate::firmware::tof_top::TofTop;
use crate::kernel::module::{Instance, Module, Visitor};
use crate::kernel::signals::Signals;
use crate::kernel::verilog::line_of;
use crate::verilog;

use super::channels::CHANNEL;
use super::entry::{TOP, below_top};

/// Lines of the top's declaration, and of what it has for each column of an array: the block, the converter, a histogram.
const TOP_LINE: u32 = line_of(verilog!(tof_top), &["\nmodule tof_top "]);
const CHANNEL_LINE: u32 = line_of(verilog!(tof_top), &[": channel"]);
const CHANNEL_TDC_LINE: u32 = line_of(verilog!(tof_top), &["\n            ) tdc ("]);
const BANK_LINE: u32 = line_of(verilog!(tof_top), &["\n                ) histogram_builder ("]);
/// Module of a channel's histograms, and the one of the top with that module.
const BANK: &str = "histogram_builder";

/// A module and the line of its file that declares it.
type Declared = (&'static str, u32);

/// Place of a scope in the Verilog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScopePlace {
    /// Name of the module; empty for a block within a module.
    pub component: &'static str,
    /// Module whose file declares it, and the line.
    pub declared: Declared,
    /// Module whose file instantiates it, and the line; `None` for the top.
    pub instantiated: Option<Declared>,
}

/// Every module of the largest possible design, by its path below the top.
pub struct ModulePlaces(Vec<(String, &'static Instance)>);

impl ModulePlaces {
    /// Lists the modules.
    pub fn new() -> Self {
        let mut places = ModulePlaces(Vec::new());
        TofTop::default().visit(None, &mut Places { path: String::new(), found: &mut places.0 });
        places
    }

    /// Returns the place of a scope, if it is one of the firmware's.
    pub fn of(&self, scope: &str) -> Option<ScopePlace> {
        let top = ScopePlace { component: TOP, declared: (TOP, TOP_LINE), instantiated: None };
        if scope == TOP {
            return Some(top);
        }
        let path = below_top(scope);
        let outer = path.rsplit_once('.').map_or("", |(outer, _)| outer);
        if path.starts_with(CHANNEL) {
            return self.in_channel(path);
        }
        let around = if outer.is_empty() { TOP } else { self.instance(outer)?.module };
        let Instance { module, declared, instantiated, .. } = *self.instance(path)?;
        let instantiated = Some((around, instantiated));
        Some(ScopePlace { component: module, declared: (module, declared), instantiated })
    }

    /// Returns the place of a column's scope, or of one inside of it.
    fn in_channel(&self, path: &str) -> Option<ScopePlace> {
        let Some((_, inside)) = path.split_once('.') else {
            let place = (TOP, CHANNEL_LINE);
            return Some(ScopePlace { component: "", declared: place, instantiated: Some(place) });
        };
        if inside.starts_with("bank_") {
            let Instance { module, declared, .. } = *self.instance(BANK)?;
            let instantiated = Some((TOP, BANK_LINE));
            return Some(ScopePlace {
                component: module,
                declared: (module, declared),
                instantiated,
            });
        }
        let first = self.of(&format!("{TOP}.{inside}"))?;
        let is_tdc = !inside.contains('.');
        let instantiated = if is_tdc { Some((TOP, CHANNEL_TDC_LINE)) } else { first.instantiated };
        Some(ScopePlace { instantiated, ..first })
    }

    fn instance(&self, path: &str) -> Option<&'static Instance> {
        self.0.iter().find(|(other, _)| other == path).map(|(_, instance)| *instance)
    }
}

impl Default for ModulePlaces {
    fn default() -> Self {
        ModulePlaces::new()
    }
}

/// Traversal of the modules.
struct Places<'a> {
    path: String,
    found: &'a mut Vec<(String, &'static Instance)>,
}

impl Visitor for Places<'_> {
    fn signals<S: Signals>(&mut self, _: &'static str, _: &S, _: Option<&mut S>) {}

    fn module<M: Module>(&mut self, instance: &'static Instance, now: &M, _: Option<&mut M>) {
        let dot = if self.path.is_empty() { "" } else { "." };
        let path = format!("{}{dot}{}", self.path, instance.name);
        self.found.push((path.clone(), instance));
        now.visit(None, &mut Places { path, found: self.found });
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;
    use std::path::Path;

    use super::super::every_entry;
    use super::*;

    /// Returns a line of a module's file in the repository.
    fn line((module, number): Declared) -> String {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("rtl_ref/{module}.v"));
        let text = fs::read_to_string(path).unwrap();
        text.lines().nth(number as usize - 1).unwrap().trim().to_owned()
    }

    #[test]
    fn every_scope_has_the_place_of_its_module_and_of_its_instance() {
        let places = ModulePlaces::new();
        let scopes: BTreeSet<_> = every_entry().into_iter().map(|entry| entry.scope).collect();
        assert!(scopes.len() > 30);
        for scope in &scopes {
            let place = places.of(scope).unwrap_or_else(|| panic!("{scope}"));
            let (name, module) = (scope.rsplit('.').next().unwrap(), place.component);
            let declared = line(place.declared);
            assert!(declared.starts_with(&format!("module {module} ")), "{declared}");
            let Some(instance) = place.instantiated else {
                assert_eq!(scope, TOP);
                continue;
            };
            let expected = [format!(") {name} ("), format!("{module} {name} (")];
            assert!(expected.contains(&line(instance)), "{scope}: {}", line(instance));
        }
    }

    #[test]
    fn a_channel_is_the_block_that_is_generated_for_each_column() {
        let places = ModulePlaces::new();
        let of = |scope| places.of(scope).unwrap().instantiated.unwrap();
        let channel = of("tof_top.channel_12");
        assert!(line(channel).ends_with("begin : channel"));
        let [first, own] = ["tof_top.tdc", "tof_top.channel_12.tdc"].map(of);
        assert!(first.1 < channel.1 && channel.1 < own.1);
        assert!(of("tof_top.channel_12.bank_1").1 > own.1);
        assert_eq!(of("tof_top.channel_12.tdc.tdc_latch"), of("tof_top.tdc.tdc_latch"));
        assert!(places.of("spad_row").is_none());
    }
}
