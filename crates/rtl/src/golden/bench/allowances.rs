//! What another implementation is allowed.

use std::collections::{BTreeMap, BTreeSet};

use crate::golden::table::Column;
use crate::golden::verilog::place;

/// Where a bench is not strict; nowhere, to begin with.
#[derive(Clone, Debug, Default)]
pub struct Allowances {
    /// Clock cycles that an output comes later than the reference.
    pub delays: BTreeMap<String, i64>,
    /// Outputs that are not compared.
    pub ignored: BTreeSet<String>,
    /// Low bits of an output that are compared, where not all are.
    pub bits: BTreeMap<String, usize>,
    /// Outputs that are compared only where another one is high.
    pub valid: BTreeMap<String, String>,
}

impl Allowances {
    /// Clock cycles that an output comes later than the reference.
    pub fn delay(&self, name: &str) -> i64 {
        self.delays.get(name).copied().unwrap_or(0)
    }

    /// Verilog that replaces what is wanted of one of these columns, where it is not as expected.
    pub fn text(&self, column: &Column, columns: &[Column]) -> String {
        let place = place(column);
        if self.ignored.contains(&column.name) {
            return format!("    want[{place}] = got[{place}];\n");
        }
        let mut text = String::new();
        let delay = self.delay(&column.name);
        if delay != 0 {
            text += &format!(
                "    if (cycle - ({delay}) >= 0 && cycle - ({delay}) < Cycles)\n      \
                 want[{place}] = expected[cycle - ({delay})][{place}];\n    \
                 else\n      want[{place}] = got[{place}];\n",
            );
        }
        if let Some(bits) = self.bits.get(&column.name).filter(|bits| **bits < column.width) {
            let top = format!("{}:{}", column.low + column.width - 1, column.low + bits);
            text += &format!("    want[{top}] = got[{top}];\n");
        }
        let valid = self.valid.get(&column.name);
        if let Some(valid) = valid.and_then(|name| columns.iter().find(|c| c.name == *name)) {
            let at = match self.delay(&valid.name) {
                0 => "cycle".to_owned(),
                delay => format!("cycle - ({delay})"),
            };
            let low = valid.low;
            text += &format!("    if (!expected[{at}][{low}]) want[{place}] = got[{place}];\n");
        }
        text
    }
}
