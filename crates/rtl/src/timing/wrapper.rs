//! Registers around a block, so that pins do not count.

use std::collections::BTreeMap;
use std::fmt::Write;

use tofsim::kernel::sizes::Sizes;

use crate::golden::blocks;
use crate::golden::ports::Port;

use super::block::TimedBlock;

/// Name of the module.
pub const TOP: &str = "between_registers";

const CLOCKS: [&str; 2] = ["clk_sys", "clk_laser"];

/// The clock that a port belongs to, by its name.
fn clock(port: &str) -> &'static str {
    if port.ends_with("_laser") { CLOCKS[1] } else { CLOCKS[0] }
}

/// A module that has the block's modules under their own names, with a register before every input and
/// behind every output, of the port's own clock.
pub fn wrapper(block: &TimedBlock) -> String {
    let specs: Vec<_> = block.modules.iter().filter_map(|name| blocks::find(name)).collect();
    let all: Vec<Port> = specs.iter().flat_map(|spec| spec.ports(&Sizes::default())).collect();
    let is_driven = |name: &str| all.iter().any(|port| port.output && port.name == name);
    let is_read = |name: &str| all.iter().any(|port| !port.output && port.name == name);
    let (mut head, mut body, mut edges) = (Vec::new(), String::new(), BTreeMap::new());
    let mut ports: Vec<&Port> = all.iter().collect();
    ports.sort_by(|a, b| (&a.name, b.output).cmp(&(&b.name, a.output)));
    ports.dedup_by(|a, b| a.name == b.name);
    for port in ports {
        let (name, range) = (&port.name, format!("[{}:0]", port.width - 1));
        if CLOCKS.contains(&name.as_str()) || block.pins.contains(&name.as_str()) {
            head.push(format!("    {} wire {range} {name}", port.direction()));
            continue;
        }
        let mut register = |to: &str, from: &str| {
            let edge: &mut String = edges.entry(clock(name)).or_default();
            let _ = writeln!(edge, "        {to} <= {from};");
        };
        if !port.output {
            head.push(format!("    input wire {range} {name}_pin"));
            let _ = writeln!(body, "    reg {range} {name};");
            register(name, &format!("{name}_pin"));
        } else {
            let _ = writeln!(body, "    wire {range} {name};");
            if !(is_driven(name) && is_read(name)) {
                head.push(format!("    output reg {range} {name}_pin"));
                register(&format!("{name}_pin"), name);
            }
        }
    }
    for (clock, edge) in &edges {
        let _ = write!(body, "    always @(posedge {clock}) begin\n{edge}    end\n");
    }
    for spec in &specs {
        let ports = spec.ports(&Sizes::default());
        let connected: Vec<_> = ports.iter().map(Port::connection).collect();
        let _ = writeln!(body, "    {0} {0} ({1});", spec.name, connected.join(", "));
    }
    format!("module {TOP} (\n{}\n);\n{body}endmodule\n", head.join(",\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_two_modules_share_has_no_register_between_them() {
        let text = wrapper(TimedBlock::find("estimator_histogram").unwrap());
        assert!(text.contains("    wire [15:0] count;\n"), "{text}");
        assert!(!text.contains("count_pin") && !text.contains("read_addr_pin"), "{text}");
        assert!(text.contains("        tdc_code <= tdc_code_pin;\n"), "{text}");
        assert!(text.contains("        depth_pin <= depth;\n"), "{text}");
    }

    #[test]
    fn a_port_has_the_register_of_its_own_clock_and_a_pin_has_none() {
        let text = wrapper(TimedBlock::find("vcsel_driver").unwrap());
        let (slow, fast) = text.split_once("posedge clk_laser").unwrap();
        assert!(
            fast.contains("rst_laser <= rst_laser_pin;") && !slow.contains("rst_laser <= "),
            "{text}"
        );
        assert!(
            text.contains("output wire [0:0] laser_on\n")
                || text.contains("output wire [0:0] laser_on,")
        );
    }
}
