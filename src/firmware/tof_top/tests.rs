use super::*;
use crate::kernel::module::{Instance, Module, Visitor};
use crate::kernel::signals::Signals;

/// Connections of the ports of each module: module, port, source.
#[derive(Default)]
struct Connections(Vec<[&'static str; 3]>);

impl Visitor for Connections {
    fn signals<S: Signals>(&mut self, _: &'static str, _: &S, _: Option<&mut S>) {}

    fn module<M: Module>(&mut self, instance: &'static Instance, _: &M, _: Option<&mut M>) {
        let sources = instance.sources.iter();
        self.0.extend(sources.map(|&(port, source)| [instance.name, port, source]));
    }
}

#[test]
fn an_asynchronous_pin_reaches_only_the_module_that_synchronises_it() {
    let mut connections = Connections::default();
    TofTop::default().visit(None, &mut connections);
    for [module, port, source] in connections.0 {
        let Some(pin) = source.strip_prefix("this.pins.") else { continue };
        let expected: &[&str] = match pin {
            "rst" => &["reset_sync_sys", "reset_sync_laser"],
            "tdc_stop" => &["tdc"],
            _ => &["control_sync"],
        };
        assert!(expected.contains(&module), "{pin} reaches {module}.{port}");
    }
}
