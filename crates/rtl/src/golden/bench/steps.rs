//! A cycle of a bench in Verilog.

use tofsim::kernel::Time;

use crate::golden::spec::Vectors;
use crate::golden::timing::{ASIDE, BenchStep, of_quarters};

/// A delay.
///
/// The fifth of a femtosecond makes a simulator that rounds it and one that cuts it off agree. Whole
/// picoseconds stand apart, because Verilator 5.006 has 32 bits for a delay that is no integer.
pub(super) fn wait(span: Time) -> String {
    match (span.ps(), span.fs() % 1000) {
        (ps, 0) => format!("#{ps}"),
        (ps, fs) => format!("#{ps} #0.{fs:03}2"),
    }
}

/// A cycle: the inputs 1 ps after the edge, then the parts of the timing.
pub(super) fn steps(vectors: &Vectors, inputs: &str) -> String {
    let timing = &vectors.spec.timing;
    let mut text = match inputs {
        "" => "      #1;\n".to_owned(),
        inputs => format!("      #1 {{{inputs}}} = stimulus[cycle];\n"),
    };
    let mut sample = 0;
    for (k, step) in timing.steps.iter().enumerate() {
        let mut rest = of_quarters(step.quarters, vectors.pll.cycle);
        let last = k + 1 == timing.steps.len();
        if k == 0 {
            rest = rest - ASIDE;
        }
        if let Some((input, column)) = step.late {
            text += &format!("      #1;\n      {input} = {column};\n");
            rest = rest - ASIDE;
        }
        if step.sample {
            let compare = if last { "      compare;\n" } else { "" };
            text += &format!("      {} look_{sample};\n{compare}      #1", wait(rest - ASIDE));
            sample += 1;
        } else {
            text += &format!("      {}", wait(rest));
        }
        text += &edges(step, last);
    }
    text
}

/// The clocks that change together, in one assignment.
fn edges(step: &BenchStep, last: bool) -> String {
    let names: Vec<_> = step.edges.iter().map(|(name, _)| *name).collect();
    let levels: String =
        step.edges.iter().map(|(_, level)| if *level { '1' } else { '0' }).collect();
    let rises = step.edges.iter().any(|(_, level)| *level);
    let first = if rises && !last { " if (cycle != 0)" } else { "" };
    match names.as_slice() {
        [] => ";\n".to_owned(),
        [name] => format!("{first} {name} = 1'b{levels};\n"),
        _ => format!("{first} {{{}}} = {}'b{levels};\n", names.join(", "), names.len()),
    }
}
