//! The constraint files give each port of the boards' tops a pin and a standard, and pull the controls down.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use super::{between, root};

/// The bits of a top's ports.
fn ports(top: &str) -> BTreeSet<String> {
    let text = fs::read_to_string(root().join(format!("rtl_ref/{top}.v"))).unwrap();
    bits(&text, &["input wire ", "output wire "])
}

/// The bits of a top's inputs from the acquisition computer.
fn controls(top: &str) -> BTreeSet<String> {
    let text = fs::read_to_string(root().join(format!("rtl_ref/{top}.v"))).unwrap();
    bits(between(&text, "// Acquisition computer\n", "\n);").unwrap(), &["input wire "])
}

/// The bits of ports that are declared so.
fn bits(text: &str, kinds: &[&str]) -> BTreeSet<String> {
    let mut bits = BTreeSet::new();
    for line in text.lines().map(str::trim) {
        let Some(rest) = kinds.iter().find_map(|kind| line.strip_prefix(kind)) else {
            continue;
        };
        let declared = rest.trim_start_matches("signed ");
        let declared = declared.split([',', '/']).next().unwrap_or_default().trim();
        match declared.strip_prefix('[').and_then(|range| range.split_once(":0] ")) {
            Some((high, name)) => {
                let high: usize = high.parse().unwrap();
                bits.extend((0..=high).map(|bit| format!("{name}[{bit}]")));
            }
            None => bits.extend([declared.to_owned()]),
        }
    }
    bits
}

/// Checks that each bit of a top's ports has one pin and one standard, and that no pin has two.
fn check_pins<'a>(
    top: &str,
    pins: impl Iterator<Item = (&'a str, &'a str)>,
    standards: impl Iterator<Item = &'a str>,
) {
    let (mut of_port, mut of_pin) = (BTreeMap::new(), BTreeMap::new());
    for (port, pin) in pins {
        assert_eq!(of_port.insert(port, pin), None, "{top}: {port} has two pins");
        assert_eq!(of_pin.insert(pin, port), None, "{top}: {pin} has two ports");
    }
    let ports = ports(top);
    let found: BTreeSet<_> = of_port.keys().map(|port| (*port).to_owned()).collect();
    assert_eq!(found, ports, "{top}: ports with a pin");
    let with_standard: BTreeSet<_> = standards.map(str::to_owned).collect();
    assert_eq!(with_standard, ports, "{top}: ports with a standard");
}

#[test]
fn each_port_of_the_kc705_has_a_pin() {
    let text = fs::read_to_string(root().join("rtl_ref/kc705.xdc")).unwrap();
    let lines = || text.lines().filter(|line| line.starts_with("set_property -dict"));
    let port = |line: &str| -> Option<String> {
        let rest = line.split_once("[get_ports ")?.1;
        let braced = rest.strip_prefix('{').and_then(|rest| rest.split_once('}'));
        Some(
            braced
                .map_or_else(|| rest.split(']').next().unwrap_or_default(), |(name, _)| name)
                .to_owned(),
        )
    };
    let named: Vec<_> = lines().map(|line| (port(line).unwrap(), line)).collect();
    let pins = named
        .iter()
        .filter_map(|(port, line)| Some((&**port, between(line, "PACKAGE_PIN ", " ")?)));
    let standards =
        named.iter().filter(|(_, line)| line.contains("IOSTANDARD ")).map(|(port, _)| &**port);
    check_pins("kc705_top", pins, standards);
    let pulled = named.iter().filter(|(_, line)| line.contains(" PULLTYPE PULLDOWN}"));
    assert_eq!(
        pulled.map(|(port, _)| port.clone()).collect::<BTreeSet<_>>(),
        controls("kc705_top")
    );
}

#[test]
fn each_port_of_the_ecp5_has_a_pin() {
    let text = fs::read_to_string(root().join("rtl_ref/ecp5.lpf")).unwrap();
    let lines = || text.lines().filter(|line| !line.starts_with('#'));
    let pins = lines().filter_map(|line| {
        Some((between(line, "LOCATE COMP \"", "\"")?, between(line, "SITE \"", "\"")?))
    });
    let standards = lines().filter_map(|line| between(line, "IOBUF PORT \"", "\" IO_TYPE="));
    check_pins("ecp5_top", pins, standards);
    let pulled = lines().filter(|line| line.contains(" PULLMODE=DOWN;"));
    let pulled = pulled.filter_map(|line| between(line, "IOBUF PORT \"", "\""));
    assert_eq!(pulled.map(str::to_owned).collect::<BTreeSet<_>>(), controls("ecp5_top"));
}
