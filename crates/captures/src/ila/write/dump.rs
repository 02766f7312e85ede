//! `waveform.dmp`: the archive's data, a line of samples for each bit.

use std::io::{self, Write};

use super::super::capture::Capture;
use super::spill::spill;

/// Writes a capture as Vivado's `waveform.dmp`.
pub fn dump(out: &mut dyn Write, capture: &Capture) -> io::Result<()> {
    writeln!(out, "core_id:{}", super::ltx::CORE)?;
    writeln!(out, "data_width:{}", capture.width())?;
    writeln!(out, "sample_count:{}", capture.samples())?;
    writeln!(out, "has_timestamps:false\nclock_frequency_hz:0")?;
    writeln!(out, "window_marks:{}", marks(&capture.windows))?;
    writeln!(out, "trigger_marks:{}", marks(&capture.triggers))?;
    writeln!(out, "gaps:\ntimestamps:\ngap_timestamps:")?;
    let mut text = Vec::new();
    for bit in 0..capture.width() {
        let words = capture.words.iter().skip(bit / 64).step_by(capture.stride);
        write!(text, "ch[{bit}]: ")?;
        text.extend(words.map(|word| b'0' + (word >> (bit % 64) & 1) as u8));
        text.push(b'\n');
        spill(out, &mut text)?;
    }
    out.write_all(&text)
}

fn marks(samples: &[usize]) -> String {
    let numbers: Vec<_> = samples.iter().map(usize::to_string).collect();
    numbers.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ila::{Probe, Radix};

    #[test]
    fn a_line_holds_the_samples_of_a_bit() {
        let probe = |name: &str, width, vector| {
            let (name, radix) = (name.to_owned(), Radix::Hex);
            Probe { name, width, lsb: 0, vector, radix }
        };
        let mut capture = Capture::new(vec![probe("a", 2, true), probe("b", 1, false)]);
        capture.words = vec![0b001, 0b010, 0b111, 0b100];
        capture.windows = vec![0, 2];
        capture.triggers = vec![1, 3];
        let mut out = Vec::new();
        dump(&mut out, &capture).unwrap();
        let text = String::from_utf8(out).unwrap();
        let (head, body) = text.split_once("gap_timestamps:\n").unwrap();
        assert!(head.contains("data_width:3\nsample_count:4\n"), "{head}");
        assert!(head.contains("window_marks:0 2\ntrigger_marks:1 3\n"), "{head}");
        assert_eq!(body, "ch[0]: 1010\nch[1]: 0110\nch[2]: 0011\n");
    }
}
