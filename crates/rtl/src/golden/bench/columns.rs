//! What a bench looks at, column by column: how it takes them, and how it shows those that differ.

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

/// Statements that show all bits of a line, in pieces: Verilator shows no more than 8192 bits at once.
pub(super) fn pieces(line: &str, width: usize) -> String {
    const PIECE: usize = 4096;
    if width <= PIECE {
        return format!("\"%h\", {line}");
    }
    let piece = |low: usize| format!("{line}[{}:{low}]", (low + PIECE).min(width) - 1);
    let pieces: Vec<_> = (0..width).step_by(PIECE).map(piece).rev().collect();
    format!("\"{}\", {}", "%h".repeat(pieces.len()), pieces.join(", "))
}

/// Lines that say which columns differ.
pub(super) fn show(vectors: &Vectors) -> String {
    let show = |column: &Column| {
        let (place, name) = (place(column), &column.name);
        let before = vectors.before_edge(column.sample).fs();
        format!(
            "    if (got[{place}] !== want[{place}])\n      \
             $display(\"mismatch: cycle %0d, time %0d ps, {name}: expected %h, got %h\",\n        \
             cycle, (FirstEdge + cycle * Period - 64'd{before}) / 1000, want[{place}], got[{place}]);\n",
        )
    };
    vectors.expected.columns().iter().map(show).collect()
}

#[cfg(test)]
mod tests {
    use super::pieces;

    #[test]
    fn a_wide_line_is_shown_in_pieces_from_the_highest_bit_down() {
        assert_eq!(pieces("got", 4096), r#""%h", got"#);
        assert_eq!(pieces("got", 8200), r#""%h%h%h", got[8199:8192], got[8191:4096], got[4095:0]"#);
    }
}
