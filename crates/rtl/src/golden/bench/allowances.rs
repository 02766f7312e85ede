//! Deviations that another implementation is allowed.

use std::collections::{BTreeMap, BTreeSet};

use crate::golden::spec::Vectors;
use crate::golden::table::Column;
use crate::golden::verilog::place;

/// Deviations that a bench allows; none by default.
#[derive(Clone, Debug, Default)]
pub struct Allowances {
    /// Clock cycles that an output comes later than the reference.
    pub delays: BTreeMap<String, i64>,
    /// Outputs that are not compared.
    pub ignored: BTreeSet<String>,
    /// Outputs that are not there.
    pub absent: BTreeSet<String>,
    /// Low bits of an output that are compared, where not all are.
    pub bits: BTreeMap<String, usize>,
    /// Outputs that are compared only where another port is high in the reference.
    pub valid: BTreeMap<String, String>,
    /// Lines after a reset that are not compared.
    pub settle: u64,
}

/// Inputs that reset a block: after a line with one, a pipeline may have to settle.
pub const RESETS: [&str; 2] = ["rst", "rst_late"];

/// Columns of the stimulus that reset a block.
pub fn resets(vectors: &Vectors) -> Vec<&Column> {
    let columns = vectors.stimulus.columns().iter();
    columns.filter(|column| RESETS.contains(&column.name.as_str())).collect()
}

/// Verilog that is true if a line of the stimulus resets the block.
pub fn resets_in(line: &str, vectors: &Vectors) -> String {
    let levels = resets(vectors).into_iter();
    let levels: Vec<_> = levels.map(|column| format!("stimulus[{line}][{}]", column.low)).collect();
    levels.join(" || ")
}

/// Place of the level by which a column is compared or not.
#[derive(Clone, Copy, Debug)]
pub struct Valid<'a> {
    /// Memory of the bench with it: `stimulus` or `expected`.
    pub table: &'static str,
    /// Its column there.
    pub column: &'a Column,
}

impl Allowances {
    /// Clock cycles that an output comes later than the reference.
    pub fn delay(&self, name: &str) -> i64 {
        self.delays.get(name).copied().unwrap_or(0)
    }

    /// The level that says whether a column is compared, if one does: of the same sample, if it is
    /// looked at in each.
    pub fn valid<'a>(&self, column: &Column, vectors: &'a Vectors) -> Option<Valid<'a>> {
        let name = self.valid.get(&column.name)?;
        let outputs = vectors.expected.columns().iter().filter(|other| other.name == *name);
        let output = outputs.max_by_key(|other| other.sample == column.sample);
        let inputs = vectors.stimulus.columns();
        let input = || inputs.iter().find(|other| other.name == *name);
        let output = output.map(|column| Valid { table: "expected", column });
        output.or_else(|| input().map(|column| Valid { table: "stimulus", column }))
    }

    /// Verilog that replaces what is wanted of a column where it is not as expected.
    pub fn text(&self, column: &Column, vectors: &Vectors) -> String {
        let place = place(column);
        if self.ignored.contains(&column.name) {
            return format!("    want[{place}] = got[{place}];\n");
        }
        let mut text = String::new();
        let delay = self.delay(&column.name);
        if delay != 0 {
            let cut = if delay < 0 && !resets(vectors).is_empty() {
                format!(" && next_reset >= cycle - ({delay})")
            } else {
                String::new()
            };
            text += &format!(
                "    if (cycle - ({delay}) >= 0 && cycle - ({delay}) < Cycles{cut})\n      \
                 want[{place}] = expected[cycle - ({delay})][{place}];\n    \
                 else\n      want[{place}] = got[{place}];\n",
            );
        }
        if let Some(bits) = self.bits.get(&column.name).filter(|bits| **bits < column.width) {
            let top = format!("{}:{}", column.low + column.width - 1, column.low + bits);
            text += &format!("    want[{top}] = got[{top}];\n");
        }
        if let Some(Valid { table, column: Column { low, .. } }) = self.valid(column, vectors) {
            let at = match delay {
                0 => "cycle".to_owned(),
                delay => format!("cycle - ({delay})"),
            };
            text += &format!("    if (!{table}[{at}][{low}]) want[{place}] = got[{place}];\n");
        }
        text
    }

    /// Returns whether an output comes earlier than the reference, and so before a reset that the reference has had.
    fn leads(&self, vectors: &Vectors) -> bool {
        self.delays.values().any(|delay| *delay < 0) && !resets(vectors).is_empty()
    }

    /// Verilog that declares the next line with a reset, if an output needs it.
    pub fn declaration(&self, vectors: &Vectors) -> &'static str {
        if self.leads(vectors) {
            "  integer next_reset = 0;  // first line from this one on that resets the block\n"
        } else {
            ""
        }
    }

    /// Verilog that looks for the next line with a reset, if an output needs it.
    pub fn search(&self, vectors: &Vectors) -> String {
        if !self.leads(vectors) {
            return String::new();
        }
        let levels = resets_in("next_reset", vectors);
        format!(
            "    while (next_reset < cycle || next_reset < Cycles && !({levels}))\n      \
             next_reset = next_reset + 1;\n",
        )
    }

    /// Returns whether a reset lies between a line and the one of the reference that it is compared with, which comes
    /// later: the reference has lost what the line shows.
    pub fn is_cut(&self, cycle: usize, name: &str, vectors: &Vectors) -> bool {
        let lead = usize::try_from(-self.delay(name)).unwrap_or(0);
        let lines = cycle..(cycle + lead).min(vectors.stimulus.rows());
        lines
            .into_iter()
            .any(|line| resets(vectors).iter().any(|column| vectors.stimulus.row(line)[column.low]))
    }

    /// Lines that are not compared to begin with: until the registers have been reset (-1), or have
    /// taken their first values.
    pub fn quiet(&self, vectors: &Vectors) -> i64 {
        match vectors.spec.reset {
            Some(_) => -1,
            None => vectors.settles as i64 + self.quiet_after_first(),
        }
    }

    /// Lines after the first reset that are not compared: what comes later there shows for so long what
    /// was before it.
    pub fn quiet_after_first(&self) -> i64 {
        let latest = self.delays.values().copied().max().unwrap_or(0).max(0);
        self.settle as i64 + latest
    }
}
