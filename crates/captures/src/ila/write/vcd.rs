//! The value change dump: one flat scope, sample numbers for times.

use std::io::{self, Write};

use tofsim::files::date;

use super::super::capture::{Capture, Probe};
use super::words::{spill, take};

/// Writes a capture as Vivado's VCD. `_TRIGGER` and `_WINDOW` turn over at every trigger and at
/// every window but the first.
pub fn vcd(out: &mut dyn Write, capture: &Capture) -> io::Result<()> {
    let mut signals: Vec<_> =
        capture.probes.iter().zip(capture.places()).map(VcdSignal::of).collect();
    let [trigger_id, window_id, gap_id] =
        [1, 2, 3].map(|after| identifier(capture.width() + after));
    head(out, &signals, [&trigger_id, &window_id, &gap_id])?;

    let mut text = Vec::new();
    let mut windows = capture.windows.iter().copied().filter(|&window| window > 0).peekable();
    let mut triggers = capture.triggers.iter().copied().peekable();
    let (mut trigger, mut window) = (b'0', b'1');
    for (sample, words) in capture.words.chunks_exact(capture.stride).enumerate() {
        let begin = text.len();
        writeln!(text, "#{sample}")?;
        if sample == 0 {
            text.extend_from_slice(b"$dumpvars\n");
        }
        let empty = text.len();
        let before = &capture.words[sample.saturating_sub(1) * capture.stride..][..words.len()];
        if sample == 0 || before != words {
            for signal in &mut signals {
                signal.push(words, sample == 0, &mut text);
            }
        }
        if triggers.next_if_eq(&sample).is_some() {
            trigger ^= 1;
            push_scalar(&mut text, trigger, &trigger_id);
        } else if sample == 0 {
            push_scalar(&mut text, trigger, &trigger_id);
        }
        if windows.next_if_eq(&sample).is_some() {
            window ^= 1;
            push_scalar(&mut text, window, &window_id);
        } else if sample == 0 {
            push_scalar(&mut text, window, &window_id);
            push_scalar(&mut text, b'0', &gap_id);
            text.extend_from_slice(b"$end\n");
        }
        if text.len() == empty {
            text.truncate(begin);
        }
        spill(out, &mut text)?;
    }
    out.write_all(&text)
}

fn head(out: &mut dyn Write, signals: &[VcdSignal], marks: [&str; 3]) -> io::Result<()> {
    if let Some(date) = date::fixed().map_err(io::Error::other)? {
        writeln!(out, "$date\n        {date}\n$end")?;
    }
    writeln!(out, "$version\n        tofsim {}\n$end", env!("CARGO_PKG_VERSION"))?;
    writeln!(out, "$timescale\n        1ps\n$end\n$scope module dut $end")?;
    for VcdSignal { probe, identifier, .. } in signals {
        let escape = if probe.name.contains(['[', ']']) { "\\" } else { "" };
        write!(out, "$var reg {} {identifier} {escape}{} ", probe.width, probe.name)?;
        if probe.vector {
            write!(out, "[{}:{}] ", probe.lsb + probe.width - 1, probe.lsb)?;
        }
        writeln!(out, "$end")?;
    }
    for (identifier, name) in marks.iter().zip(["_TRIGGER", "_WINDOW", "_GAP"]) {
        writeln!(out, "$var reg 1 {identifier} {name} $end")?;
    }
    writeln!(out, "$upscope $end\n$enddefinitions $end")
}

/// A number in base 94, lowest digit first.
fn identifier(mut number: usize) -> String {
    let mut identifier = String::new();
    while number > 0 || identifier.is_empty() {
        identifier.push((b'!' + (number % 94) as u8) as char);
        number /= 94;
    }
    identifier
}

fn push_scalar(text: &mut Vec<u8>, digit: u8, identifier: &str) {
    text.push(digit);
    text.extend_from_slice(identifier.as_bytes());
    text.push(b'\n');
}

/// A probe and its last value.
struct VcdSignal<'a> {
    probe: &'a Probe,
    low: usize,
    identifier: String,
    last: Vec<u64>,
    value: Vec<u64>,
}

impl<'a> VcdSignal<'a> {
    fn of((probe, low): (&'a Probe, usize)) -> Self {
        let words = vec![0; probe.width.div_ceil(64) as usize];
        VcdSignal { probe, low, identifier: identifier(low + 1), last: words.clone(), value: words }
    }

    /// Appends the value if it has changed, or in any case.
    #[inline]
    fn push(&mut self, sample: &[u64], always: bool, text: &mut Vec<u8>) {
        take(sample, self.low, self.probe.width as usize, &mut self.value);
        if !always && self.value == self.last {
            return;
        }
        self.last.copy_from_slice(&self.value);
        if self.probe.width == 1 {
            push_scalar(text, b'0' + self.value[0] as u8, &self.identifier);
            return;
        }
        text.push(b'b');
        let top = self.value.iter().rposition(|&word| word != 0).unwrap_or(0);
        let digits = (64 - self.value[top].leading_zeros()).max(1);
        text.extend((0..digits).rev().map(|bit| b'0' + (self.value[top] >> bit & 1) as u8));
        for &word in self.value[..top].iter().rev() {
            text.extend((0..64).rev().map(|bit| b'0' + (word >> bit & 1) as u8));
        }
        text.push(b' ');
        text.extend_from_slice(self.identifier.as_bytes());
        text.push(b'\n');
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::ila::Radix;

    fn probe(name: &str, width: u32, lsb: u32, vector: bool) -> Probe {
        Probe { name: name.to_owned(), width, lsb, vector, radix: Radix::Hex }
    }

    fn written(capture: &Capture) -> String {
        let mut out = Vec::new();
        vcd(&mut out, capture).unwrap();
        String::from_utf8(out).unwrap()
    }

    /// Two windows of three samples; the last sample changes nothing.
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
