//! How a bench looks at the block, compares and reports.

use std::fmt::Write;

use crate::golden::table::Column;

use super::{Bench, place, range};

impl Bench<'_> {
    /// The comparison.
    pub(super) fn tasks(&self) -> String {
        let (expected, spec) = (&self.vectors.expected, self.vectors.spec);
        let (lines_in, lines_out) = (self.vectors.stimulus.width().max(1), expected.width());
        let mut text = format!(
            "\n  reg {}stimulus [0:Cycles-1];\n  reg {1}expected [0:Cycles-1];\n  \
             reg {1}got;\n  reg {1}want;\n  integer cycle;\n  \
             integer mismatches = 0;\n  integer got_file = 0;\n  reg [8191:0] got_name;\n",
            range(lines_in as u32),
            range(lines_out as u32),
        );
        for sample in 0..spec.timing.samples() {
            let columns = expected.columns().iter().filter(|column| column.sample == sample);
            let (inner, ports): (Vec<_>, Vec<_>) = columns.partition(|column| column.internal);
            let take = |path: &str, column: &Column| {
                format!("    got[{}] = {path}{};\n", place(column), column.name)
            };
            let _ = writeln!(text, "\n  task look_{sample};\n  begin");
            text.extend(ports.iter().map(|column| take("", column)));
            if !inner.is_empty() {
                text += "`ifdef REGISTERS\n";
                text.extend(inner.iter().map(|column| take("dut.", column)));
                text += "`endif\n";
            }
            text += "  end\n  endtask\n";
        }
        text += "\n  task compare;\n  begin\n";
        text.extend(expected.columns().iter().filter_map(|column| self.allowance(column)));
        text += "    if (got !== want) begin\n      if (mismatches == 0) show;\n      \
                 mismatches = mismatches + 1;\n    end\n    \
                 if (got_file != 0) $fdisplay(got_file, \"%h\", got);\n  end\n  endtask\n";
        text += "\n  task show;\n  begin\n";
        for column in expected.columns() {
            let (place, name) = (place(column), &column.name);
            let before = spec.timing.before_edge_ps(column.sample) + 1;
            let _ = write!(
                text,
                "    if (got[{place}] !== want[{place}])\n      \
                 $display(\"mismatch: cycle %0d, time %0d ps, {name}: expected %h, got %h\",\n        \
                 cycle, FirstEdge + cycle * Period - 64'd{before}, want[{place}], got[{place}]);\n",
            );
        }
        text += "  end\n  endtask\n";
        text
    }

    /// What is allowed of a column: nothing, a delay, or anything.
    fn allowance(&self, column: &Column) -> Option<String> {
        let place = place(column);
        if self.ignored.contains(&column.name) {
            return Some(format!("    want[{place}] = got[{place}];\n"));
        }
        let delay = self.delays.get(&column.name).copied().unwrap_or(0);
        let mut text = String::new();
        if delay != 0 {
            let _ = write!(
                text,
                "    if (cycle - ({delay}) >= 0 && cycle - ({delay}) < Cycles)\n      \
                 want[{place}] = expected[cycle - ({delay})][{place}];\n    \
                 else\n      want[{place}] = got[{place}];\n",
            );
        }
        if let Some(bits) = self.bits.get(&column.name).filter(|bits| **bits < column.width) {
            let top = format!("{}:{}", column.low + column.width - 1, column.low + bits);
            let _ = writeln!(text, "    want[{top}] = got[{top}];");
        }
        let columns = || self.vectors.expected.columns().iter();
        let valid = self.valid.get(&column.name);
        if let Some(valid) = valid.and_then(|name| columns().find(|c| c.name == *name)) {
            let at = match self.delays.get(&valid.name).copied().unwrap_or(0) {
                0 => "cycle".to_owned(),
                delay => format!("cycle - ({delay})"),
            };
            let low = valid.low;
            let _ = writeln!(text, "    if (!expected[{at}][{low}]) want[{place}] = got[{place}];");
        }
        (!text.is_empty()).then_some(text)
    }
}
