//! Both sides as a waveform, with a save file that shows what differs first.

use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;

use vcd::{TimescaleUnit, Value};

use tofsim::error::Result;
use tofsim::files::output::write_file;

use crate::golden::spec::Vectors;
use crate::golden::table::Column;

use super::observed::{Observed, binary};
use super::verdict::Mismatch;

/// Longest run that goes into the waveform whole [cycles].
const WHOLE: usize = 50_000;
/// Of a longer one, so many before and after the first mismatch [cycles].
const PART: usize = 5_000;
/// The scopes of the two sides.
const SIDES: [&str; 2] = ["expected", "got"];
/// The scope of the inputs, after those of the sides.
const INPUT: &str = "input";

/// Writes `stem.vcd` and `stem.gtkw` into a folder.
///
/// # Errors
/// When one of them cannot be written.
pub fn write(
    folder: &Path,
    stem: &str,
    vectors: &Vectors,
    observed: &Observed,
    first: &Mismatch,
) -> Result<()> {
    let cycles = match observed.len() > WHOLE {
        true => first.cycle.saturating_sub(PART)..(first.cycle + PART).min(observed.len()),
        false => 0..observed.len(),
    };
    let wave = format!("{stem}.vcd");
    write_file(&folder.join(&wave), |file| body(file, vectors, observed, cycles))?;
    let save = save_file(&wave, vectors, observed, first);
    write_file(&folder.join(format!("{stem}.gtkw")), |file| file.write_all(save.as_bytes()))
}

/// The scope that has everything.
fn top(vectors: &Vectors) -> String {
    format!("tb_{}", vectors.spec.name)
}

/// Columns of one signal, one for each sample of a cycle that it has.
fn signals(columns: &[Column]) -> Vec<&[Column]> {
    columns.chunk_by(|a, b| a.name == b.name).collect()
}

fn body(
    file: &mut dyn Write,
    vectors: &Vectors,
    observed: &Observed,
    cycles: Range<usize>,
) -> io::Result<()> {
    let (timing, stimulus) = (&vectors.spec.timing, &vectors.stimulus);
    let [expected, inputs] = [&vectors.expected, stimulus].map(|table| signals(table.columns()));
    let sides = [(SIDES[0], &expected), (SIDES[1], &expected), (INPUT, &inputs)];
    let mut vcd = vcd::Writer::new(file);
    vcd.timescale(1, TimescaleUnit::PS)?;
    vcd.add_module(&top(vectors))?;
    let clock = vcd.add_wire(1, timing.clock)?;
    let mut codes = Vec::new();
    for (name, side) in sides {
        vcd.add_module(name)?;
        let wires = side.iter().map(|signal| vcd.add_wire(signal[0].width as u32, &signal[0].name));
        codes.push(wires.collect::<io::Result<Vec<_>>>()?);
        vcd.upscope()?;
    }
    vcd.upscope()?;
    vcd.enddefinitions()?;

    let slot = timing.period_ps() / timing.samples() as u64;
    let mut last = sides.map(|(_, side)| vec![String::new(); side.len()]);
    for cycle in cycles {
        let end = vectors.first_edge_ps + cycle as u64 * timing.period_ps();
        for sample in 0..timing.samples() {
            vcd.timestamp(end - timing.before_edge_ps(sample) - slot)?;
            if sample == 0 {
                vcd.change_scalar(clock, cycle > 0)?;
            } else if 2 * sample == timing.samples() {
                vcd.change_scalar(clock, false)?;
            }
            for (scope, (_, side)) in sides.into_iter().enumerate() {
                for (n, columns) in side.iter().enumerate() {
                    let Some(column) = shown(columns, sample) else { continue };
                    let bits = match scope {
                        0 => observed.wanted(cycle, column),
                        1 => observed.bits(cycle, column),
                        _ => binary(stimulus, cycle, column),
                    };
                    if bits != last[scope][n] {
                        vcd.change_vector(codes[scope][n], bits.chars().map(value))?;
                        last[scope][n] = bits;
                    }
                }
            }
        }
        if timing.samples() == 1 {
            vcd.timestamp(end - timing.period_ps() / 2)?;
            vcd.change_scalar(clock, false)?;
        }
    }
    Ok(())
}

/// The column that a signal shows from a sample's part of the cycle on: its own of each sample, or
/// its only one for the whole cycle.
fn shown(columns: &[Column], sample: usize) -> Option<&Column> {
    match columns {
        [only] => (sample == 0).then_some(only),
        each => each.get(sample),
    }
}

fn value(digit: char) -> Value {
    match digit {
        '0' => Value::V0,
        '1' => Value::V1,
        'z' => Value::Z,
        _ => Value::X,
    }
}

/// GTKWave's save file: what differs at first, the inputs, and a marker there.
fn save_file(wave: &str, vectors: &Vectors, observed: &Observed, first: &Mismatch) -> String {
    let (timing, top) = (&vectors.spec.timing, top(vectors));
    let (from, at) = (first.time_ps.saturating_sub(8 * timing.period_ps()), first.time_ps);
    let mut text = format!(
        "[dumpfile] \"{wave}\"\n[timestart] {from}\n[size] 1400 700\n*-14.0 {at}\n\
         @28\n{top}.{}\n",
        timing.clock
    );
    let mut show = |scope: &str, Column { name, width, .. }: &Column| {
        let range = if *width == 1 { String::new() } else { format!("[{}:0]", width - 1) };
        text += &format!("@22\n+{{{name}{range} {scope}}} {top}.{scope}.{name}{range}\n");
    };
    for signal in signals(vectors.expected.columns()) {
        if signal.iter().any(|column| observed.differs(first.cycle, column)) {
            SIDES.iter().for_each(|side| show(side, &signal[0]));
        }
    }
    signals(vectors.stimulus.columns()).iter().for_each(|signal| show(INPUT, &signal[0]));
    text
}
