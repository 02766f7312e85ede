//! Writer of the value change dump: one flat scope, and sample numbers as times.

use std::io::{self, Write};

use bitvec::prelude::*;

use tofsim::files::date;

use super::super::capture::Capture;
use super::spill::spill;

/// Writes a capture as Vivado's VCD. `_TRIGGER` and `_WINDOW` toggle at every trigger and at every window but the
/// first.
pub fn vcd(out: &mut dyn Write, capture: &Capture) -> io::Result<()> {
    head(out, capture)?;
    let [trigger_id, window_id, gap_id] =
        [1, 2, 3].map(|after| identifier(capture.width() + after));
    let mut windows = capture.windows.iter().copied().filter(|&window| window > 0).peekable();
    let mut triggers = capture.triggers.iter().copied().peekable();
    let (mut trigger, mut window, mut text) = (0, 1, Vec::new());
    for sample in 0..capture.samples() {
        let (now, before) = (capture.sample(sample), capture.sample(sample.saturating_sub(1)));
        let mut changes = String::new();
        let places = capture.places().filter(|_| sample == 0 || now != before);
        for place in
            places.filter(|place| sample == 0 || now[place.clone()] != before[place.clone()])
        {
            changes += &change(&now[place.clone()], &identifier(place.start + 1));
        }
        let triggers_now = triggers.next_if_eq(&sample).is_some();
        let begins = windows.next_if_eq(&sample).is_some();
        (trigger, window) = (trigger ^ u8::from(triggers_now), window ^ u8::from(begins));
        if triggers_now || sample == 0 {
            changes += &format!("{trigger}{trigger_id}\n");
        }
        if begins || sample == 0 {
            changes += &format!("{window}{window_id}\n");
        }
        match sample {
            0 => write!(text, "#0\n$dumpvars\n{changes}0{gap_id}\n$end\n")?,
            _ if changes.is_empty() => {}
            _ => write!(text, "#{sample}\n{changes}")?,
        }
        spill(out, &mut text)?;
    }
    out.write_all(&text)
}

fn head(out: &mut dyn Write, capture: &Capture) -> io::Result<()> {
    if let Some(date) = date::fixed().map_err(io::Error::other)? {
        writeln!(out, "$date\n        {date}\n$end")?;
    }
    writeln!(out, "$version\n        tofsim {}\n$end", env!("CARGO_PKG_VERSION"))?;
    writeln!(out, "$timescale\n        1ps\n$end\n$scope module dut $end")?;
    for (probe, place) in capture.probes.iter().zip(capture.places()) {
        let escape = if probe.name.contains(['[', ']']) { "\\" } else { "" };
        let identifier = identifier(place.start + 1);
        write!(out, "$var reg {} {identifier} {escape}{} ", probe.width, probe.name)?;
        if probe.vector {
            write!(out, "[{}:{}] ", probe.lsb + probe.width - 1, probe.lsb)?;
        }
        writeln!(out, "$end")?;
    }
    for (after, name) in (1..).zip(["_TRIGGER", "_WINDOW", "_GAP"]) {
        writeln!(out, "$var reg 1 {} {name} $end", identifier(capture.width() + after))?;
    }
    writeln!(out, "$upscope $end\n$enddefinitions $end")
}

/// Formats a number in base 94, least significant digit first.
fn identifier(mut number: usize) -> String {
    let mut identifier = String::new();
    while number > 0 || identifier.is_empty() {
        identifier.push((b'!' + (number % 94) as u8) as char);
        number /= 94;
    }
    identifier
}

/// Formats a value change, without the leading zeros of a vector.
fn change(value: &BitSlice<u64>, identifier: &str) -> String {
    let digits = value[..value.last_one().map_or(1, |top| top + 1)].iter().by_vals().rev();
    let digits: String = digits.map(|bit| if bit { '1' } else { '0' }).collect();
    match value.len() {
        1 => format!("{digits}{identifier}\n"),
        _ => format!("b{digits} {identifier}\n"),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::ila::{Probe, Radix};

    fn probe(name: &str, width: u32, lsb: u32, vector: bool) -> Probe {
        Probe { name: name.to_owned(), width, lsb, vector, radix: Radix::Hex }
    }

    fn written(capture: &Capture) -> String {
        let mut out = Vec::new();
        vcd(&mut out, capture).unwrap();
        String::from_utf8(out).unwrap()
    }

    /// Creates two windows of three samples; the last sample changes nothing.
    fn small() -> Capture {
        let mut capture = Capture::new(vec![
            probe("top/valid", 1, 0, false),
            probe("r[3]", 4, 2, true),
            probe("one", 1, 0, true),
        ]);
        capture.words = vec![0, 0, 0x2b, 0x2a, 0x2a, 0x2a];
        capture.windows = vec![0, 3];
        capture.triggers = vec![1, 4];
        capture
    }

    #[test]
    fn changes_stand_under_their_sample_and_marks_turn_over() {
        let text = written(&small());
        let (_, body) = text.split_once("$timescale").unwrap();
        let expected = r#"
        1ps
$end
$scope module dut $end
$var reg 1 " top/valid $end
$var reg 4 # \r[3] [5:2] $end
$var reg 1 ' one [0:0] $end
$var reg 1 ( _TRIGGER $end
$var reg 1 ) _WINDOW $end
$var reg 1 * _GAP $end
$upscope $end
$enddefinitions $end
#0
$dumpvars
0"
b0 #
0'
0(
1)
0*
$end
#1
1(
#2
1"
b101 #
1'
#3
0"
0)
#4
0(
"#;
        assert_eq!(body, expected);
    }

    #[test]
    fn identifiers_begin_with_their_lowest_digit() {
        assert_eq!([1, 93, 94, 95, 94 * 94].map(identifier), ["\"", "~", "!\"", "\"\"", "!!\""]);
    }

    #[test]
    fn a_library_reads_the_same_values() {
        let mut capture = Capture::new(vec![probe("wide", 130, 0, true), probe("b", 1, 0, false)]);
        capture.words = vec![1, 0, 2, 1 << 63, 7, 0b110];
        capture.windows = vec![0];
        let mut wave = wellen::simple::read_from_reader(Cursor::new(written(&capture))).unwrap();
        let found: Vec<_> = wave.hierarchy().all_vars().collect();
        let names: Vec<_> = found
            .iter()
            .map(|&var| wave.hierarchy()[var].full_name(wave.hierarchy()).to_owned())
            .collect();
        assert_eq!(names, ["dut.wide", "dut.b", "dut._TRIGGER", "dut._WINDOW", "dut._GAP"]);
        let signals: Vec<_> = found.iter().map(|&var| wave.hierarchy()[var].signal_ref()).collect();
        wave.load_signals(&signals);
        let values = |signal: usize| -> Vec<String> {
            let signal = wave.get_signal(signals[signal]).unwrap();
            signal.iter_changes().map(|(_, value)| value.to_bit_string().unwrap()).collect()
        };
        let wide = [1, 7 << 64 | 1 << 63].map(|low: u128| format!("10{low:0128b}"));
        assert_eq!(values(0), wide);
        assert_eq!(values(1), ["0", "1"]);
    }
}
