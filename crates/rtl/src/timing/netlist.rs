//! A netlist as Yosys writes it into JSON.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use serde::Deserialize;
use serde_json::Value;

use tofsim::error::{Error, Input, Result};

/// A net of one bit.
pub type Bit = u64;

#[derive(Debug, Deserialize)]
struct File {
    modules: BTreeMap<String, Netlist>,
}

/// A flat module of primitives.
#[derive(Debug, Deserialize)]
pub struct Netlist {
    /// Primitives by name.
    pub cells: BTreeMap<String, Cell>,
    netnames: BTreeMap<String, Name>,
}

/// A primitive.
#[derive(Debug, Deserialize)]
pub struct Cell {
    /// Type of the cell.
    #[serde(rename = "type")]
    pub kind: String,
    /// Its parameters.
    #[serde(default)]
    pub parameters: BTreeMap<String, Value>,
    connections: BTreeMap<String, Vec<Value>>,
}

#[derive(Debug, Deserialize)]
struct Name {
    bits: Vec<Value>,
}

impl Netlist {
    /// The module called `top` in a file.
    ///
    /// # Errors
    /// When the file cannot be read, or has no such module.
    pub fn read(path: &Path, top: &str) -> Result<Self> {
        let text = std::fs::read_to_string(path).map_err(Error::io(path, "read"))?;
        let fault = |why: String| Input::new(path.display().to_string(), why);
        let mut file: File = serde_json::from_str(&text)
            .map_err(|error| fault(format!("expected a netlist of Yosys: {error}")))?;
        Ok(file.modules.remove(top).ok_or_else(|| fault(format!("expected a module {top}")))?)
    }

    /// Counts the cells of each type.
    pub fn counts(&self) -> BTreeMap<String, u64> {
        let mut counts = BTreeMap::new();
        for cell in self.cells.values() {
            *counts.entry(cell.kind.clone()).or_default() += 1;
        }
        counts
    }

    /// The name of each net, as the sources have it where they have one: the shortest of those that are not
    /// made up.
    pub fn names(&self) -> HashMap<Bit, String> {
        let mut names: HashMap<Bit, String> = HashMap::new();
        let rank = |name: &str| (name.contains('$'), name.matches('.').count(), name.len());
        for (name, net) in &self.netnames {
            for (index, bit) in net.bits.iter().enumerate() {
                let Some(bit) = bit.as_u64() else { continue };
                let name =
                    if net.bits.len() == 1 { name.clone() } else { format!("{name}[{index}]") };
                let known = names.entry(bit).or_insert_with(|| name.clone());
                if rank(&name) < rank(known) {
                    *known = name;
                }
            }
        }
        names
    }
}

impl Cell {
    /// The nets at a port; none where a constant is.
    pub fn bits(&self, port: &str) -> impl Iterator<Item = Option<Bit>> {
        self.connections.get(port).into_iter().flatten().map(Value::as_u64)
    }

    /// A parameter that is a number, as Yosys writes it: in binary.
    pub fn number(&self, parameter: &str) -> u64 {
        let digits = self.parameters.get(parameter).and_then(Value::as_str).unwrap_or_default();
        u64::from_str_radix(digits, 2).unwrap_or(0)
    }

    /// Returns whether a parameter is that text.
    pub fn says(&self, parameter: &str, text: &str) -> bool {
        self.parameters.get(parameter).and_then(Value::as_str) == Some(text)
    }
}
