//! How a bench looks at the block, and says what differs.

use crate::golden::spec::Vectors;
use crate::golden::table::Column;
use crate::golden::verilog::place;

/// A task for each sample of a cycle, which takes what is compared there.
pub(super) fn looks(vectors: &Vectors) -> String {
    let look = |sample: usize| {
        let columns = vectors.expected.columns().iter().filter(|column| column.sample == sample);
        let (inner, ports): (Vec<_>, Vec<_>) = columns.partition(|column| column.internal);
        let take = |path: &str, columns: &[&Column]| -> String {
            let line =
                |column: &&Column| format!("    got[{}] = {path}{};\n", place(column), column.name);
            columns.iter().map(line).collect()
        };
        let inner = match inner.as_slice() {
            [] => String::new(),
            inner => format!("`ifdef REGISTERS\n{}`endif\n", take("dut.", inner)),
        };
        let ports = take("", &ports);
        format!("\n  task look_{sample};\n  begin\n{ports}{inner}  end\n  endtask\n")
    };
    (0..vectors.spec.timing.samples()).map(look).collect()
}

/// Lines that say which columns differ.
pub(super) fn show(vectors: &Vectors) -> String {
    let show = |column: &Column| {
        let (place, name) = (place(column), &column.name);
        let before = vectors.spec.timing.before_edge_ps(column.sample) + 1;
        format!(
            "    if (got[{place}] !== want[{place}])\n      \
             $display(\"mismatch: cycle %0d, time %0d ps, {name}: expected %h, got %h\",\n        \
             cycle, FirstEdge + cycle * Period - 64'd{before}, want[{place}], got[{place}]);\n",
        )
    };
    vectors.expected.columns().iter().map(show).collect()
}
