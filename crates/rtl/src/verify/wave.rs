//! Both sides as a waveform, with a save file that shows what differs first.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;

use vcd::{IdCode, TimescaleUnit, Value, Writer};

use crate::golden::Vectors;
use crate::golden::table::Column;
use tofsim::error::Result;
use tofsim::files::output::write_file;

use super::seen::{Seen, binary};
use super::verdict::Mismatch;

/// Longest run that goes into the waveform whole [cycles].
const WHOLE: usize = 50_000;
/// Of a longer one, so many before and after the first mismatch [cycles].
const PART: usize = 5_000;

/// Writes `stem.vcd` and `stem.gtkw` into a folder.
///
/// # Errors
/// When one of them cannot be written.
pub fn write(
    folder: &Path,
    stem: &str,
    vectors: &Vectors,
    seen: &Seen,
    first: &Mismatch,
) -> Result<()> {
    let cycles = match seen.len() > WHOLE {
        true => first.cycle.saturating_sub(PART)..(first.cycle + PART).min(seen.len()),
        false => 0..seen.len(),
    };
    let wave = format!("{stem}.vcd");
    write_file(&folder.join(&wave), |file| body(file, vectors, seen, cycles))?;
    let save = save_file(&wave, vectors, seen, first);
    write_file(&folder.join(format!("{stem}.gtkw")), |file| file.write_all(save.as_bytes()))
}

/// The names of the two sides and of the inputs, as scopes.
const SCOPES: [&str; 3] = ["expected", "got", "input"];

/// The scope that has everything.
fn scope(vectors: &Vectors) -> String {
    format!("tb_{}", vectors.spec.name)
}

/// Columns of one signal, one for each sample of a cycle that it has.
fn signals(columns: &[Column]) -> Vec<Vec<&Column>> {
    let mut signals: Vec<Vec<&Column>> = Vec::new();
    for column in columns {
        match signals.last_mut().filter(|signal| signal[0].name == column.name) {
            Some(signal) => signal.push(column),
            None => signals.push(vec![column]),
        }
    }
    signals
}

fn body(
    file: &mut dyn Write,
    vectors: &Vectors,
    seen: &Seen,
    cycles: Range<usize>,
) -> io::Result<()> {
    let timing = &vectors.spec.timing;
    let mut vcd = Writer::new(file);
    vcd.timescale(1, TimescaleUnit::PS)?;
    vcd.add_module(&scope(vectors))?;
    let clock = vcd.add_wire(1, timing.clock)?;
    let tables = [&vectors.expected, &vectors.expected, &vectors.stimulus];
    let mut sides: Vec<Vec<(IdCode, Vec<&Column>)>> = Vec::new();
    for (name, table) in SCOPES.iter().zip(tables) {
        vcd.add_module(name)?;
        let mut side = Vec::new();
        for signal in signals(table.columns()) {
            side.push((vcd.add_wire(signal[0].width as u32, &signal[0].name)?, signal));
        }
        vcd.upscope()?;
        sides.push(side);
    }
    vcd.upscope()?;
    vcd.enddefinitions()?;
    let slot = timing.period_ps() / timing.samples() as u64;
    let mut last: Vec<Vec<String>> =
        sides.iter().map(|side| vec![String::new(); side.len()]).collect();
    for cycle in cycles {
        let end = vectors.first_edge_ps + cycle as u64 * timing.period_ps();
        for sample in 0..timing.samples() {
            vcd.timestamp(end - timing.before_edge_ps(sample) - slot)?;
            if sample == 0 {
                vcd.change_scalar(clock, cycle > 0)?;
            } else if 2 * sample == timing.samples() {
                vcd.change_scalar(clock, false)?;
            }
            for (k, side) in sides.iter().enumerate() {
                for (n, (code, columns)) in side.iter().enumerate() {
                    let Some(column) = shown(columns, sample) else { continue };
                    let bits = match k {
                        0 => seen.wanted(cycle, column),
                        1 => seen.bits(cycle, column),
                        _ => binary(&vectors.stimulus, cycle, column),
                    };
                    if bits != last[k][n] {
                        vcd.change_vector(*code, bits.chars().map(value))?;
                        last[k][n] = bits;
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
fn shown<'a>(columns: &[&'a Column], sample: usize) -> Option<&'a Column> {
    match columns {
        [only] => (sample == 0).then_some(*only),
        each => each.get(sample).copied(),
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
fn save_file(wave: &str, vectors: &Vectors, seen: &Seen, first: &Mismatch) -> String {
    let period = vectors.spec.timing.period_ps();
    let begin = first.time_ps.saturating_sub(8 * period);
    let top = scope(vectors);
    let mut text = format!(
        "[dumpfile] \"{wave}\"\n[timestart] {begin}\n[size] 1400 700\n*-14.0 {}\n@28\n{top}.{}\n",
        first.time_ps, vectors.spec.timing.clock
    );
    let name = |side: &str, column: &Column| {
        let range = match column.width {
            1 => String::new(),
            width => format!("[{}:0]", width - 1),
        };
        let name = format!("{}{range}", column.name);
        format!("+{{{name} {side}}} {top}.{side}.{name}")
    };
    for signal in signals(vectors.expected.columns()) {
        if signal.iter().any(|column| seen.differs(first.cycle, column)) {
            for scope in ["expected", "got"] {
                let _ = writeln!(text, "@22\n{}", name(scope, signal[0]));
            }
        }
    }
    for signal in signals(vectors.stimulus.columns()) {
        let _ = writeln!(text, "@22\n{}", name("input", signal[0]));
    }
    text
}
