//! The ROMs as texts for Verilog's `$readmemh`: one word a line, in hexadecimal.

use std::fmt::Write;

use crate::firmware::depth_estimator::Params;
use crate::firmware::forward1::{self, BIAS_ROW, Weight};
use crate::firmware::forward2::NEURONS;
use crate::firmware::tdc_decoder::Calibration;

/// A ROM's file.
#[derive(Clone, Debug, PartialEq)]
pub struct Mem {
    /// File name.
    pub name: &'static str,
    /// Its lines.
    pub text: String,
}

/// MEM1: the weights, a line of 128 bits a bin, then the biases, one such line. Neuron 7 is in the
/// top 16 bits.
pub fn forward1(rom: &forward1::Rom) -> [Mem; 2] {
    [
        Mem { name: "w1.mem", text: lines(rom[..BIAS_ROW].iter().map(word), 32) },
        Mem { name: "b1.mem", text: lines([word(&rom[BIAS_ROW])], 32) },
    ]
}

/// MEM2: line k is address k as an unsigned word.
pub fn tansig(rom: &crate::firmware::tansig::Rom) -> Mem {
    Mem { name: "tansig.mem", text: lines(rom.iter().map(|entry| entry.bits().into()), 4) }
}

/// MEM3: the weights, a line of 128 bits with neuron 7 in the top 16, and the bias.
pub fn forward2(rom: &crate::firmware::forward2::Rom) -> [Mem; 2] {
    [
        Mem { name: "w2.mem", text: lines([word(&rom.w2)], 32) },
        Mem { name: "b2.mem", text: lines([rom.b2.bits().into()], 4) },
    ]
}

/// All of the estimator's ROMs.
pub fn depth_estimator(params: &Params) -> Vec<Mem> {
    let (hidden, output) = (forward1(&params.forward1), forward2(&params.forward2));
    hidden.into_iter().chain(output).chain([tansig(&params.tansig)]).collect()
}

/// The decoder's calibration: line N is the time for N ones [25/16 ps].
pub fn tdc_decoder(calibration: &Calibration) -> Mem {
    let words = calibration.iter().map(|time| time.get().into());
    Mem { name: "tdc_cal.mem", text: lines(words, 4) }
}

/// Eight words side by side, the first in the low bits.
fn word(row: &[Weight; NEURONS]) -> u128 {
    row.iter().rev().fold(0, |word, weight| word << 16 | u128::from(weight.bits()))
}

/// Words as lines of that many hexadecimal digits.
pub fn lines(words: impl IntoIterator<Item = u128>, digits: usize) -> String {
    let mut text = String::new();
    for word in words {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{word:0digits$x}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::carry_chain::TAPS;
    use crate::kernel::{S, U};
    use crate::network::Network;

    #[test]
    fn neuron_7_is_in_the_top_16_bits() {
        let row = std::array::from_fn(|neuron| S::new(neuron as i64 - 1));
        assert_eq!(lines([word(&row)], 32), "0006000500040003000200010000ffff\n");
    }

    #[test]
    fn each_file_has_its_lines_and_digits() {
        let params = Network::builtin("uniform").unwrap().unwrap().params();
        let mut calibration = [U::new(0x3abc); TAPS + 1];
        calibration[0] = U::new(5);
        let mut files = depth_estimator(&params);
        files.push(tdc_decoder(&calibration));
        let shape = |mem: &Mem| {
            let digits = mem.text.lines().next().map(str::len);
            assert!(mem.text.lines().all(|line| Some(line.len()) == digits));
            (mem.name, mem.text.lines().count(), digits.unwrap_or(0))
        };
        let expected = [
            ("w1.mem", 256, 32),
            ("b1.mem", 1, 32),
            ("w2.mem", 1, 32),
            ("b2.mem", 1, 4),
            ("tansig.mem", 4096, 4),
            ("tdc_cal.mem", 801, 4),
        ];
        assert_eq!(files.iter().map(shape).collect::<Vec<_>>(), expected);
        assert!(files[5].text.starts_with("0005\n3abc\n"));
        assert_eq!(files[4].text.lines().nth(2048), Some("8016"));
        assert_eq!(files[3].text, "7d74\n");
    }
}
