//! Writer of `waveform.dmp`, the archive's data: one line of samples per bit.

use std::fmt::Display;
use std::io::{self, Write};

use super::super::capture::Capture;
use super::spill::spill;

/// First lines of Vivado's dumps.
const BANNER: &str = "=========================================\n              ILA Data Dump\n\
    =========================================\n";

/// Writes a capture as Vivado's `waveform.dmp`. As in Vivado's files, keys up to `window_marks` are padded to one
/// width and the others to another, and a blank ends a list of marks.
pub fn dump(out: &mut dyn Write, capture: &Capture) -> io::Result<()> {
    let head: [(&str, &dyn Display); 7] = [
        ("core_id", &super::ltx::CORE),
        ("data_width", &capture.width()),
        ("sample_count", &capture.samples()),
        ("has_timestamps", &false),
        ("clock_frequency_hz", &0),
        ("timestamp_counter_width", &0),
        ("window_marks", &marks(&capture.windows)),
    ];
    let rest = ["gaps", "timestamps", "gap_timestamps", "data_per_channel"];
    out.write_all(BANNER.as_bytes())?;
    for (key, value) in head {
        writeln!(out, "{key:23}:{value}")?;
    }
    writeln!(out, "{:19}:{}", "trigger_marks", marks(&capture.triggers))?;
    for key in rest {
        writeln!(out, "{key:19}:")?;
    }
    let mut text = Vec::new();
    for bit in 0..capture.width() {
        let words = capture.words.iter().skip(bit / 64).step_by(capture.stride);
        write!(text, "    ch[{bit}]: ")?;
        text.extend(words.map(|word| b'0' + (word >> (bit % 64) & 1) as u8));
        text.push(b'\n');
        spill(out, &mut text)?;
    }
    out.write_all(&text)
}

/// Formats sample numbers, each followed by a blank.
fn marks(samples: &[usize]) -> String {
    samples.iter().map(|sample| format!("{sample} ")).collect()
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
        let expected = "\
=========================================
              ILA Data Dump
=========================================
core_id                :u_ila_0
data_width             :3
sample_count           :4
has_timestamps         :false
clock_frequency_hz     :0
timestamp_counter_width:0
window_marks           :0 2 
trigger_marks      :1 3 
gaps               :
timestamps         :
gap_timestamps     :
data_per_channel   :
    ch[0]: 1010
    ch[1]: 0110
    ch[2]: 0011
";
        assert_eq!(text, expected);
    }
}
