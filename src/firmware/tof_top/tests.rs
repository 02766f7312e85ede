use super::*;
use crate::firmware::vcsel_driver::LONGEST_PULSE;
use crate::kernel::module::{Instance, Module, Visitor};
use crate::kernel::signals::Signals;
use crate::sim::setup::Setup;

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
            "uart_rx" => &["uart_bridge"],
            "interlock" | "select_pins" => &["laser_guard"],
            "laser_en" => &["control_sync", "laser_guard"],
            _ => &["control_sync"],
        };
        assert!(expected.contains(&module), "{pin} reaches {module}.{port}");
    }
}

#[test]
fn a_pulse_leaves_the_top_for_as_many_half_cycles_as_are_asked_for() {
    for half_cycles in 1..=LONGEST_PULSE as usize {
        let set = format!("firmware.pulse_half_cycles={half_cycles}");
        let setup = Setup::load("kc705", &[&set]).unwrap();
        let mut top = TofTop::new(Pins { laser_en: true, ..Pins::default() }, &setup.params);
        top.pll.locked = true;
        // Whether the laser is on in each half cycle of clk_laser.
        let mut lit = Vec::new();
        for _ in 0..600 {
            top.rise(&setup.params, Taps::settled(false));
            lit.push(top.nets.laser_on);
            top.fall_laser();
            lit.push(top.nets.laser_on);
            top.rise_laser(&setup.params);
            lit.push(top.nets.laser_on);
            top.fall_laser();
            lit.push(top.nets.laser_on);
        }
        let pulses = lit.chunk_by(|one, next| one == next).filter(|run| run[0]).map(<[bool]>::len);
        let pulses: Vec<_> = pulses.collect();
        assert!(
            pulses.len() > 10 && pulses.iter().all(|&pulse| pulse == half_cycles),
            "{pulses:?}"
        );
    }
}
