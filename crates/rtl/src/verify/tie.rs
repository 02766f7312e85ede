//! Inputs of a design that ours lacks: those that a map ties to a constant, and those that are left open.

use tofsim::error::{Input, Result, hint};

use crate::golden::ports::Port;

use super::interface::Interface;
use super::map::BlockMap;

impl BlockMap {
    /// Checks that each port that is tied is an input of their module which nothing else drives, and wide enough.
    ///
    /// # Errors
    /// Names the first one that is not, as an entry of the map.
    pub(super) fn check_ties(&self, block: &str, wanted: &[Port], found: &Interface) -> Result<()> {
        for (name, value) in &self.tie {
            let fault = |what: String| {
                let field = format!("block.{block}.tie.{name}");
                Err(Input::new(&self.source, what).field(field).value(value).into())
            };
            let module = self.module(block);
            let Some(port) = found.ports.get(name) else {
                let inputs = found.ports.iter().filter(|(_, port)| !port.output);
                let (hint, inputs) = hint(name, inputs.map(|(name, _)| name.as_str()));
                let expected = format!("module {module} has no such input{hint}; it has {inputs}");
                return fault(expected);
            };
            if port.output {
                return fault(format!("expected an input; {name} is an output of module {module}"));
            }
            if wanted.iter().any(|other| other.name == *name) {
                return fault(format!(
                    "expected an input that ours lacks; the bench drives {name}"
                ));
            }
            if port.words.is_some() {
                return fault(format!("expected a vector; {name} is an array of words"));
            }
            if port.width < u64::BITS && value >> port.width != 0 {
                let most = (1u64 << port.width) - 1;
                return fault(format!("expected 0 to {most}: {name} has {} bits", port.width));
            }
        }
        Ok(())
    }

    /// Returns whether it ties the port of that name.
    pub(super) fn is_tied(&self, name: &str) -> bool {
        self.tie.contains_key(name)
    }

    /// Connections of the ports that are tied.
    pub(super) fn ties<'a>(&'a self, found: &'a Interface) -> impl Iterator<Item = String> + 'a {
        self.tie.iter().filter_map(|(name, value)| {
            Some(format!("        .{name}({}'d{value})", found.ports.get(name)?.width))
        })
    }
}

impl Interface {
    /// Inputs that are not driven.
    pub(super) fn open_inputs(&self, is_driven: impl Fn(&str) -> bool) -> Vec<String> {
        let inputs = self.ports.iter().filter(|(name, port)| !port.output && !is_driven(name));
        inputs.map(|(name, _)| name.clone()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::interface::PortShape;

    fn found() -> Interface {
        let port = |output, width| PortShape { output, width, words: None };
        let ports = [("clk", port(false, 1)), ("enable", port(false, 2)), ("full", port(true, 1))];
        let ports = ports.map(|(name, port)| (name.to_owned(), port)).into();
        Interface { ports, ..Interface::default() }
    }

    #[test]
    fn what_cannot_be_tied_is_refused_with_its_entry() {
        let clk = Port { name: "clk".to_owned(), width: 1, output: false, meaning: "" };
        let check = |name: &str, value| {
            let tie = [(name.to_owned(), value)].into();
            let map = BlockMap { tie, source: "a.toml".to_owned(), ..BlockMap::default() };
            let checked = map.check_ties("tdc", std::slice::from_ref(&clk), &found());
            checked.map_err(|error| error.to_string())
        };
        assert_eq!(check("enable", 3), Ok(()));
        let faults = [
            ("enable", 4, "expected 0 to 3: enable has 2 bits"),
            ("enabl", 1, "module tdc has no such input (`enable`?); it has clk, enable"),
            ("full", 1, "expected an input; full is an output of module tdc"),
            ("clk", 1, "expected an input that ours lacks; the bench drives clk"),
        ];
        for (name, value, expected) in faults {
            let expected = format!("a.toml: block.tdc.tie.{name} = {value}: {expected}");
            assert_eq!(check(name, value), Err(expected));
        }
    }

    #[test]
    fn an_input_that_nothing_drives_is_open() {
        assert_eq!(found().open_inputs(|name| name == "clk"), ["enable"]);
        assert!(found().open_inputs(|_| true).is_empty());
    }
}
