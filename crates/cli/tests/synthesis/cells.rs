//! The primitives that synthesis leaves of a module, and the table of them.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::recorded::recorded;
use super::yosys::{self, Sources};

/// Primitives of a module: how many of each type.
#[derive(Serialize, Deserialize)]
pub struct Cells {
    counts: BTreeMap<String, u64>,
    /// CARRY4 of the TDC's chain, by their names.
    pub chain: u64,
    /// The program that made them, such as `Yosys 0.23`.
    pub maker: String,
}

/// Columns of the table, with the prefixes of the cell types that they count.
pub const COLUMNS: &[(&str, &[&str])] = &[
    ("LUT", &["LUT", "INV"]),
    ("FF", &["FD"]),
    ("DSP48E1", &["DSP48E1"]),
    ("RAMB18E1", &["RAMB18E1"]),
    ("RAMB36E1", &["RAMB36E1"]),
    ("RAM256X1S", &["RAM256X1S"]),
    ("CARRY4", &["CARRY4"]),
];

/// Number of these cells in the XC7K325T, if the data sheet states it.
const DEVICE: [Option<u64>; 7] =
    [Some(203_800), Some(407_600), Some(840), Some(890), Some(445), None, Some(50_950)];

/// Primitives that only an instance by name makes.
const NAMED: &[&str] = &["PLLE2", "ODDR", "OBUFDS", "IBUFDS"];

impl Cells {
    /// Synthesises a module for the 7 series.
    pub fn of(sources: &Sources, top: &str) -> Self {
        Self::with(sources, top, top, "")
    }

    /// The same after a command of Yosys, under another name.
    pub fn with(sources: &Sources, top: &str, name: &str, command: &str) -> Self {
        Self::by(sources, (top, " -flatten"), name, command)
    }

    /// The same with the modules apart: each is optimised once and by itself, which is quicker where many are alike.
    pub fn of_modules(sources: &Sources, top: &str, name: &str, command: &str) -> Self {
        // Of several modules, Yosys 0.23 writes JSON that is none.
        Self::by(sources, (top, "\nflatten"), name, command)
    }

    fn by(sources: &Sources, (top, option): (&str, &str), name: &str, command: &str) -> Self {
        let mut needed = yosys::needed(sources, top);
        // A memory that only the command names.
        needed.extend(sources.clone().into_iter().filter(|(name, _)| command.contains(name)));
        let sources = needed;
        let script = format!(
            "read_verilog {}\n{command}\nsynth_xilinx -family xc7 -top {top}{option}\n\
             tee -q -o stat.json stat -json\n\
             tee -q -o chain.txt select -count t:CARRY4 c:*carry_chain.slice* %i\n",
            yosys::paths(yosys::modules(&sources)),
        );
        recorded(name, &script, &sources, || Cells::read(&yosys::results(&sources, &script)))
    }

    /// Reads what the script wrote.
    fn read(folder: &Path) -> Self {
        let stat = fs::read_to_string(folder.join("stat.json")).unwrap();
        let stat: serde_json::Value = serde_json::from_str(&stat).unwrap();
        let counts = stat["design"]["num_cells_by_type"].clone();
        let chain = fs::read_to_string(folder.join("chain.txt")).unwrap();
        let chain = chain.split_whitespace().next().unwrap().parse().unwrap();
        let maker = stat["creator"].as_str().unwrap();
        let maker = maker.split(" (").next().unwrap().to_owned();
        Cells { counts: serde_json::from_value(counts).unwrap(), chain, maker }
    }

    /// Counts the cells whose type begins so.
    pub fn count(&self, begin: &str) -> u64 {
        let types = self.counts.iter().filter(|(name, _)| name.starts_with(begin));
        types.map(|(_, count)| count).sum()
    }

    /// Types that no 7-series device has, and latches.
    pub fn odd(&self) -> Vec<&str> {
        let odd = |name: &&str| {
            name.contains(['$', '\\']) || name.starts_with("LD") || name.contains("LATCH")
        };
        self.counts.keys().map(String::as_str).filter(odd).collect()
    }

    /// The cells of a row of a table.
    pub fn row(&self) -> String {
        let cell = |count| if count == 0 { " |".to_owned() } else { format!(" {count} |") };
        self.columns().map(cell).collect()
    }

    /// The cells of a row with the parts of the board's device that they take.
    pub fn used(&self) -> String {
        let part = |(used, has): (u64, Option<u64>)| match has {
            Some(has) => format!(" {:.1} % |", 100.0 * used as f64 / has as f64),
            None => " |".to_owned(),
        };
        self.columns().zip(DEVICE).map(part).collect()
    }

    /// Their numbers.
    fn columns(&self) -> impl Iterator<Item = u64> {
        COLUMNS.iter().map(|(_, begins)| begins.iter().map(|begin| self.count(begin)).sum())
    }
}

/// The table of all modules, with what the board's device has.
pub fn table(modules: &BTreeMap<String, Cells>) -> String {
    let mut text = format!("| {} |", modules["kc705_top"].maker);
    for (name, _) in COLUMNS {
        write!(text, " {name} |").unwrap();
    }
    text += " by name |\n|---|";
    text += &"---:|".repeat(COLUMNS.len());
    text += "---|\n";
    for (module, cells) in modules {
        write!(text, "| `{module}` |").unwrap();
        text += &cells.row();
        let types = cells.counts.keys().filter(|t| NAMED.iter().any(|begin| t.starts_with(begin)));
        let types: Vec<_> = types.map(String::as_str).collect();
        let types = types.join(", ");
        text += &if types.is_empty() { " |\n".to_owned() } else { format!(" {types} |\n") };
    }
    text += "| XC7K325T |";
    for has in DEVICE {
        match has {
            Some(has) => write!(text, " {has} |").unwrap(),
            None => text += " |",
        }
    }
    text + " |\n| used by `kc705_top` |" + &modules["kc705_top"].used() + " |\n"
}
