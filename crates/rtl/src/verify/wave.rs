//! Both sides as a waveform, with a save file that shows what differs first.

use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;

use tofsim::error::Result;
use tofsim::files::output::{write_bytes, write_file};
use tofsim::kernel::Time;
use tofsim::waves::side_by_side::{
    HEXADECIMAL, Layout, SIDES, Scope, Shown, SideBySide, TimescaleUnit, Value, View, range,
};

use crate::golden::spec::Vectors;
use crate::golden::table::Column;

use super::observed::{Observed, binary};
use super::verdict::Mismatch;

/// Longest run that goes into the waveform whole [cycles].
const WHOLE: usize = 50_000;
/// Of a longer one, so many before and after the first mismatch [cycles].
const PART: usize = 5_000;
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
    let count = observed.lines.len();
    let cycles = if count > WHOLE {
        first.cycle.saturating_sub(PART)..(first.cycle + PART).min(count)
    } else {
        0..count
    };
    let wave = format!("{stem}.vcd");
    write_file(&folder.join(&wave), |file| body(file, vectors, observed, cycles))?;
    let save = save_file(&wave, vectors, observed, first);
    write_bytes(&folder.join(format!("{stem}.gtkw")), save)
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
    let is_there = |columns: &&[Column]| observed.has(&columns[0]);
    let got: Vec<_> = expected.iter().copied().filter(is_there).collect();
    let is_compared = |columns: &&[Column]| columns[0].internal || observed.has(&columns[0]);
    let expected: Vec<_> = expected.into_iter().filter(is_compared).collect();
    let sides = [(SIDES[0], &expected), (SIDES[1], &got), (INPUT, &inputs)];
    let top = vectors.bench_module();
    let (unit, first) = (TimescaleUnit::PS, Some(timing.clock));
    let layout = Layout { version: None, unit, top: &top, first, last: None };
    let signal = |columns: &&[Column]| (columns[0].name.clone(), columns[0].width as u32);
    let scopes: [Scope; 3] = sides.map(|(name, side)| (name, side.iter().map(signal).collect()));
    let mut wave = SideBySide::begin(file, &layout, &scopes)?;

    let slot = Time::from_fs(vectors.period().fs() / timing.samples() as u64);
    let mut last = sides.map(|(_, side)| vec![String::new(); side.len()]);
    for cycle in cycles {
        let end = vectors.edge(cycle);
        for sample in 0..timing.samples() {
            wave.time((end - timing.before_edge(sample, vectors.pll.cycle) - slot).ps())?;
            if sample == 0 {
                wave.bit(cycle > 0)?;
            } else if 2 * sample == timing.samples() {
                wave.bit(false)?;
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
                        wave.vector(scope, n, bits.chars().map(value))?;
                        last[scope][n] = bits;
                    }
                }
            }
        }
        if timing.samples() == 1 {
            wave.time((end - Time::from_fs(vectors.period().fs() / 2)).ps())?;
            wave.bit(false)?;
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
    let show = |scope: &'static str, column: &Column| {
        let (name, width) = (column.name.clone(), column.width as u32);
        let label = format!("{name}{} {scope}", range(width));
        Shown { flags: HEXADECIMAL, colour: None, label, scope, name, width }
    };
    let timing = &vectors.spec.timing;
    let mut shown = Vec::new();
    for signal in signals(vectors.expected.columns()) {
        if signal.iter().any(|column| observed.differs(first.cycle, column)) {
            shown.extend(SIDES.map(|side| show(side, &signal[0])));
        }
    }
    shown.extend(signals(vectors.stimulus.columns()).iter().map(|signal| show(INPUT, &signal[0])));
    let view = View {
        top: [&vectors.bench_module(), timing.clock],
        colour: None,
        from: first.time_ps.saturating_sub(8 * vectors.period().ps()),
        zoom: "-14.0".to_owned(),
        height: 700,
        columns: None,
        marker: Some(first.time_ps),
        signals: shown,
    };
    view.gtkwave(wave)
}
