//! The ports and parameters that a module really has, against those that the bench connects and sets.

use std::collections::{BTreeMap, BTreeSet};

use tofsim::error::{Input, Result, hint};

use crate::golden::ports::Port;

pub(super) mod icarus;
pub(super) mod verilator;

/// A port as a simulator tells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PortShape {
    /// True if the module drives it.
    pub output: bool,
    /// Its width, of all words together [bits].
    pub width: u32,
    /// First and last index of an unpacked array of words, as declared; none of a vector.
    pub words: Option<(u32, u32)>,
}

/// Interface of a module.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Interface {
    /// Its ports by name.
    pub ports: BTreeMap<String, PortShape>,
    /// Names of its parameters.
    pub parameters: BTreeSet<String>,
}

impl Interface {
    /// Checks that it has the ports that are wanted of it; the words of an array have `word` bits.
    ///
    /// # Errors
    /// Names the first port that is missing, or is no output, or has another width.
    pub fn check_ports(
        &self,
        source: &str,
        module: &str,
        (wanted, word): (&[Port], u32),
    ) -> Result<()> {
        for port in wanted {
            let fault = |what: String| {
                let field = format!("module {module}, port {}", port.name);
                Err(Input::new(source, what).field(field).into())
            };
            let Some(real) = self.ports.get(&port.name) else {
                let (hint, names) = hint(&port.name, self.ports.keys().map(String::as_str));
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
            let words = real.words.map_or(1, |(first, last)| first.abs_diff(last) + 1);
            if words > 1 && real.width / words != word {
                let bits = real.width / words;
                return fault(format!("is an array of {bits} bits, expected words of {word}"));
            }
        }
        Ok(())
    }

    /// Checks that it has the parameters that the bench of `block` sets: our name and theirs of each.
    ///
    /// # Errors
    /// Names the first one that is missing, and the entry of a map that leaves it out.
    pub fn check_parameters<'a>(
        &self,
        source: &str,
        [module, block]: [&str; 2],
        set: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<()> {
        let lacks = |(_, theirs): &(&str, &str)| !self.parameters.contains(*theirs);
        let Some((ours, theirs)) = set.into_iter().find(lacks) else { return Ok(()) };
        let (hint, names) = hint(theirs, self.parameters.iter().map(String::as_str));
        let has =
            if names.is_empty() { "it has none".to_owned() } else { format!("it has {names}") };
        let what = format!(
            "no such parameter{hint}; {has}. If it is a constant inside, leave it out in a map: \
             [block.{block}.parameters] {ours} = \"\"",
        );
        let field = format!("module {module}, parameter {theirs}");
        Err(Input::new(source, what).field(field).into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn port(name: &str, width: u32, output: bool) -> Port {
        Port { name: name.to_owned(), width, output, meaning: "" }
    }

    fn interface() -> Interface {
        let shape = |output, width| PortShape { output, width, words: None };
        Interface {
            ports: [("clk".to_owned(), shape(false, 1)), ("depth".to_owned(), shape(true, 36))]
                .into(),
            parameters: ["W1".to_owned(), "Neurons".to_owned()].into(),
        }
    }

    #[test]
    fn a_port_that_does_not_fit_is_named_with_what_there_is() {
        let fault =
            |port| interface().check_ports("rtl", "a", (&[port], 16)).unwrap_err().to_string();
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
        assert!(interface().check_ports("rtl", "a", (&[port("clk", 1, false)], 16)).is_ok());
    }

    #[test]
    fn a_missing_parameter_is_named_with_the_entry_that_leaves_it_out() {
        let check = |set| interface().check_parameters("rtl", ["a", "forward1"], set);
        assert!(check([("W1File", "W1"), ("Neurons", "Neurons")]).is_ok());
        assert_eq!(
            check([("W1File", "W1"), ("B1File", "B1")]).unwrap_err().to_string(),
            "rtl: module a, parameter B1: no such parameter; it has Neurons, W1. If it is a \
             constant inside, leave it out in a map: [block.forward1.parameters] B1File = \"\""
        );
    }
}
