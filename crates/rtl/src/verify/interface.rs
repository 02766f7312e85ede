//! The ports that a module really has, against those that the bench connects.

use std::collections::BTreeMap;

use tofsim::error::{Input, Result, hint};

use crate::golden::ports::Port;

/// A port as a simulator tells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PortShape {
    /// Whether the module drives it.
    pub output: bool,
    /// Its width [bits].
    pub width: u32,
}

/// Ports of a module by name.
pub type Ports = BTreeMap<String, PortShape>;

/// From the compiled form of Icarus: `.port_info 2 /OUTPUT 36 "depth";`, first those of the root.
pub(super) fn of_icarus(text: &str) -> Ports {
    let lines = text.lines().map(str::trim);
    let lines = lines.skip_while(|line| !line.starts_with(".port_info"));
    let lines = lines.take_while(|line| line.starts_with(".port_info"));
    let port = |line: &str| {
        let mut words = line.split_whitespace().skip(2);
        let output = words.next()? == "/OUTPUT";
        let width = words.next()?.parse().ok()?;
        let name = line.split('"').nth(1)?.to_owned();
        Some((name, PortShape { output, width }))
    };
    lines.filter_map(port).collect()
}

/// From the XML of Verilator: the `var` elements of the module that have a direction, and the types
/// that they refer to.
pub(super) fn of_verilator(text: &str, module: &str) -> Result<Ports> {
    let fault = |what: String| Input::new("verilator --xml-only", what);
    let document =
        roxmltree::Document::parse(text).map_err(|error| fault(format!("no XML: {error}")))?;
    let number = |node: &roxmltree::Node, name| node.attribute(name)?.parse::<i64>().ok();
    let width = |id: &str| {
        let node = document.descendants().find(|node| node.attribute("id") == Some(id))?;
        match (number(&node, "left"), number(&node, "right")) {
            (Some(left), Some(right)) => Some(left.abs_diff(right) as u32 + 1),
            _ => Some(1),
        }
    };
    let modules = document.descendants().filter(|node| node.has_tag_name("module"));
    let is_meant = |node: &roxmltree::Node| {
        [node.attribute("origName"), node.attribute("name")].contains(&Some(module))
    };
    let found = modules.into_iter().find(is_meant);
    let found = found.ok_or_else(|| fault(format!("no module {module} in it")))?;
    let port = |node: roxmltree::Node| {
        let output = node.attribute("dir")? == "output";
        let width = width(node.attribute("dtype_id")?)?;
        Some((node.attribute("name")?.to_owned(), PortShape { output, width }))
    };
    Ok(found.children().filter_map(port).collect())
}

/// Whether `module` has the ports that are wanted of it.
///
/// # Errors
/// Names the first port that is missing, or is no output, or has another width.
pub fn check(source: &str, module: &str, wanted: &[Port], found: &Ports) -> Result<()> {
    for port in wanted {
        let fault = |what: String| {
            let field = format!("module {module}, port {}", port.name);
            Err(Input::new(source, what).field(field).into())
        };
        let Some(real) = found.get(&port.name) else {
            let (hint, names) = hint(&port.name, found.keys().map(String::as_str));
            return fault(format!("no such port{hint}; it has {names}"));
        };
        let direction = |output| if output { "an output" } else { "an input" };
        if real.output != port.output {
            let [is, expected] = [real.output, port.output].map(direction);
            return fault(format!("is {is}, expected {expected}"));
        }
        if real.width != port.width {
            return fault(format!("has {} bits, expected {}", real.width, port.width));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn port(name: &str, width: u32, output: bool) -> Port {
        Port { name: name.to_owned(), width, output, meaning: "" }
    }

    const VVP: &str = "S_0x1 .scope module, \"a\" \"a\" 2 2;\n .timescale -12 -15;\n    \
        .port_info 0 /INPUT 1 \"clk\";\n    .port_info 1 /OUTPUT 36 \"depth\";\nP_0x2 .param;\n\
        S_0x3 .scope module, \"b\";\n    .port_info 0 /INPUT 3 \"inner\";\n";

    #[test]
    fn icarus_tells_the_ports_of_the_root() {
        let ports = of_icarus(VVP);
        assert_eq!(ports.keys().collect::<Vec<_>>(), ["clk", "depth"]);
        assert_eq!(ports["depth"], PortShape { output: true, width: 36 });
    }

    #[test]
    fn a_port_that_does_not_fit_is_named_with_what_there_is() {
        let ports = of_icarus(VVP);
        let fault = |port| check("rtl", "a", &[port], &ports).unwrap_err().to_string();
        assert_eq!(
            fault(port("dept", 36, true)),
            "rtl: module a, port dept: no such port (`depth`?); it has clk, depth"
        );
        assert_eq!(
            fault(port("depth", 32, true)),
            "rtl: module a, port depth: has 36 bits, expected 32"
        );
        assert_eq!(
            fault(port("clk", 1, true)),
            "rtl: module a, port clk: is an input, expected an output"
        );
        assert!(check("rtl", "a", &[port("clk", 1, false)], &ports).is_ok());
    }
}
