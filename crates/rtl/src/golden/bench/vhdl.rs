//! Bench in VHDL-2008. It compares ports only: VHDL keeps its registers to itself.

use tofsim::error::{Input, Result};
use tofsim::kernel::Time;

use super::allowances::{Allowances, RESETS};

use crate::golden::parameters::Parameter;
use crate::golden::ports::Port;
use crate::golden::spec::Vectors;
use crate::golden::table::Column;
use crate::golden::timing::{ASIDE, BenchStep, of_quarters};

/// The bench of an entity that has the block's name.
///
/// # Errors
/// When a generic is larger than VHDL's integers.
pub fn text(vectors: &Vectors) -> Result<String> {
    let spec = vectors.spec;
    if !vectors.column_stops.is_empty() {
        let expected = "expected Verilog for an array: benches in VHDL have one detector";
        return Err(Input::new(spec.name, expected).field("language").value("vhdl").into());
    }
    let ports = spec.ports(&vectors.sizes);
    let inputs = vectors.stimulus.columns();
    let generics: Vec<_> = vectors.parameters.iter().map(generic).collect::<Result<_>>()?;
    let generics = match generics.as_slice() {
        [] => String::new(),
        generics => format!("    generic map (\n{}\n    )\n", generics.join(",\n")),
    };
    let connected: Vec<_> =
        ports.iter().map(|Port { name, .. }| format!("      {name} => {name}")).collect();
    let apply: String = inputs
        .iter()
        .map(|column| format!("{} <= {};\n", column.name, slice("stimulus", column)))
        .collect();
    let before = if vectors.first_edge > vectors.period() {
        format!("{}    wait for FirstEdge - Period;\n", indented(&apply, 4))
    } else {
        String::new()
    };
    Ok(format!(
        include_str!("bench.vhd"),
        name = spec.name,
        version = env!("CARGO_PKG_VERSION"),
        source = vectors.source,
        seed = vectors.seed,
        cycles = vectors.stimulus.rows(),
        first_edge = physical(vectors.first_edge),
        period = physical(vectors.period()),
        signals = signals(vectors, &ports),
        generics = generics,
        ports = connected.join(",\n"),
        statements = statements(vectors),
        digits_in = digits(vectors.stimulus.width()),
        digits_out = digits(vectors.expected.width()),
        line_out = vectors.expected.width() - 1,
        quiet = Allowances::default().quiet(vectors),
        before = before,
        steps = steps(vectors, &apply),
    ))
}

/// The highest bit of whole hexadecimal digits for so many bits.
fn digits(bits: usize) -> usize {
    bits.max(1).next_multiple_of(4) - 1
}

fn indented(lines: &str, by: usize) -> String {
    lines.lines().map(|line| format!("{:by$}{line}\n", "")).collect()
}

/// A column of a line, as a bit or a vector.
fn slice(line: &str, column: &Column) -> String {
    match column.width {
        1 => format!("{line}({})", column.low),
        width => format!("{line}({} downto {})", column.low + width - 1, column.low),
    }
}

fn generic((name, value): &(&'static str, Parameter)) -> Result<String> {
    match value {
        Parameter::Number(number) if *number > i32::MAX as u64 => {
            let expected = format!("expected at most {}, VHDL's largest integer", i32::MAX);
            Err(Input::new("--language vhdl", expected)
                .field(*name)
                .value(number.to_string())
                .into())
        }
        Parameter::Number(number) => Ok(format!("      {name} => {number}")),
        quoted => Ok(format!("      {name} => \"{}\"", quoted.vhdl())),
    }
}

/// Declarations of what is connected to the entity.
fn signals(vectors: &Vectors, ports: &[Port]) -> String {
    let declare = |name: &str, width: usize, output: bool| {
        let (kind, zero) = match width {
            1 => ("std_logic".to_owned(), "'0'"),
            width => (format!("std_logic_vector({} downto 0)", width - 1), "(others => '0')"),
        };
        let initial = if output { String::new() } else { format!(" := {zero}") };
        format!("  signal {name} : {kind}{initial};\n")
    };
    let mut text: String =
        ports.iter().map(|port| declare(&port.name, port.width as usize, port.output)).collect();
    for Column { name, width, .. } in vectors.stimulus.columns() {
        if !ports.iter().any(|port| port.name == *name) {
            text += &declare(name, *width, false);
        }
    }
    if let Some(glue) = vectors.spec.glue {
        text += include_str!("words.vhd");
        text += &format!("  {}\n", glue.vhdl(&vectors.sizes)[0]);
    }
    text
}

/// Concurrent statements that drive inputs beside the main process.
fn statements(vectors: &Vectors) -> String {
    let mut text = String::new();
    if let Some(glue) = vectors.spec.glue {
        text += &format!("\n  {}\n", glue.vhdl(&vectors.sizes)[1]);
    }
    if vectors.spec.timing.oscillator {
        let half = physical(vectors.half_of_oscillator());
        text += &format!("\n  clk_in <= not clk_in after {half};\n");
    }
    if !vectors.stops.is_empty() {
        text += include_str!("stops.vhd");
    }
    text
}

/// A span of time.
fn physical(span: Time) -> String {
    if span.fs().is_multiple_of(1000) {
        format!("{} ps", span.ps())
    } else {
        format!("{} fs", span.fs())
    }
}

/// A cycle: the inputs 1 ps after the edge, then the parts of the timing.
fn steps(vectors: &Vectors, apply: &str) -> String {
    let (timing, columns) = (&vectors.spec.timing, vectors.expected.columns());
    let mut text = format!("wait for 1 ps;\n{apply}");
    let mut sample = 0;
    for (k, step) in timing.steps.iter().enumerate() {
        let mut rest = of_quarters(step.quarters, vectors.pll.cycle);
        let last = k + 1 == timing.steps.len();
        if k == 0 {
            rest = rest - ASIDE;
        }
        if let Some((input, column)) = step.late {
            text += &format!("wait for 1 ps;\n{input} <= {column};\n");
            rest = rest - ASIDE;
        }
        if step.sample {
            text += &format!("wait for {};\n", physical(rest - ASIDE));
            let seen = columns.iter().filter(|column| column.sample == sample && !column.internal);
            let take = |column: &Column| format!("{} := {};\n", slice("got", column), column.name);
            text.extend(seen.map(take));
            if last {
                text += &compare(vectors);
            }
            text += "wait for 1 ps;\n";
            sample += 1;
        } else {
            text += &format!("wait for {};\n", physical(rest));
        }
        text += &edges(step, last);
    }
    indented(&text, 6)
}

/// Counts a line that differs; the first one is shown, column by column.
fn compare(vectors: &Vectors) -> String {
    let columns = vectors.expected.columns();
    let show = |column: &Column| {
        let (high, low) = (column.low + column.width - 1, column.low);
        let before = physical(vectors.before_edge(column.sample));
        format!(
            "    show(\"{}\", cycle, {before}, want({high} downto {low}), got({high} downto {low}));\n",
            column.name,
        )
    };
    let shown: String = columns.iter().filter(|column| !column.internal).map(show).collect();
    format!(
        "if quiet = 0 and got /= want then\n  if mismatches = 0 then\n{shown}  end if;\n  \
         mismatches := mismatches + 1;\nend if;\n\
         if quiet > 0 then\n  quiet := quiet - 1;\nend if;\n{}",
        resets(vectors.stimulus.columns()),
    )
}

/// Statements for a line that resets the entity: which lines are compared from then on.
fn resets(inputs: &[Column]) -> String {
    let resets = inputs.iter().filter(|column| RESETS.contains(&column.name.as_str()));
    let levels: Vec<_> = resets.map(|column| format!("stimulus({}) = '1'", column.low)).collect();
    match levels.as_slice() {
        [] => String::new(),
        levels => {
            format!("if quiet < 0 and ({}) then\n  quiet := 0;\nend if;\n", levels.join(" or "))
        }
    }
}

/// The clocks that change together: their signals do in one delta cycle.
fn edges(step: &BenchStep, last: bool) -> String {
    let set: String = (step.edges.iter())
        .map(|(name, level)| format!("{name} <= '{}';\n", u8::from(*level)))
        .collect();
    if step.edges.iter().any(|(_, level)| *level) && !last {
        format!("if cycle /= 0 then\n{}end if;\n", indented(&set, 2))
    } else {
        set
    }
}
