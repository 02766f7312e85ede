//! ROM contents for Verilog's `$readmemh`: one hexadecimal word per line.

use std::borrow::Cow;

use crate::firmware::depth_estimator::Params;
use crate::firmware::depth_estimator::datapath::Datapath;
use crate::firmware::forward1::{Rom, Weight};
use crate::firmware::forward2;
use crate::firmware::likelihood_estimator;
use crate::firmware::likelihood_estimator::pulse::PulseWord;
use crate::firmware::likelihood_estimator::tables::{LOG2, TABLES};
use crate::firmware::likelihood_solver::instruction::Instruction;
use crate::firmware::likelihood_solver::program::Program;
use crate::firmware::tansig;
use crate::firmware::tdc_decoder;
use crate::kernel::WordFormat;
use crate::kernel::sizes::likelihood::WIDTH_BITS;

/// Name and text of a ROM file.
#[derive(Clone, Debug, PartialEq)]
pub struct Mem {
    pub name: Cow<'static, str>,
    pub text: String,
}

impl Mem {
    /// A file of that name.
    pub fn new(name: impl Into<Cow<'static, str>>, text: String) -> Self {
        Mem { name: name.into(), text }
    }

    /// Returns the file for a column of an array: with the column's number at the end of its name.
    pub fn of_column(self, column: usize) -> Self {
        Mem { name: format!("{}.{column:02}", self.name).into(), ..self }
    }
}

/// Formats MEM1: one line per bin with a word for each neuron, and one such line of biases. The last neuron is in the
/// top bits.
pub fn forward1(rom: &Rom, neurons: usize, datapath: &Datapath) -> [Mem; 2] {
    let row = |row: &[Weight], format: WordFormat| words(&row[..neurons], format.width);
    [
        Mem::new("w1.mem", rom.w1.iter().map(|bin| row(bin, datapath.w1)).collect()),
        Mem::new("b1.mem", row(&rom.b1, datapath.b1)),
    ]
}

/// Formats MEM2, the activation table; the line number is the address.
pub fn tansig(rom: &tansig::Rom, datapath: &Datapath) -> Mem {
    let width = datapath.l1_out.width;
    let entries = rom.entries.iter().map(|entry| low_bits(entry.get(), width));
    Mem::new("tansig.mem", lines(entries, digits(width)))
}

/// Formats MEM3: one line of weights with the last neuron in the top bits, and the bias.
pub fn forward2(rom: &forward2::Rom) -> [Mem; 2] {
    let Datapath { w2, b2, .. } = rom.datapath;
    [
        Mem::new("w2.mem", words(&rom.w2[..rom.neurons], w2.width)),
        Mem::new("b2.mem", words(&[rom.b2], b2.width)),
    ]
}

/// Formats all ROMs of the network estimator.
pub fn depth_estimator(params: &Params) -> Vec<Mem> {
    let datapath = &params.forward2.datapath;
    let hidden = forward1(&params.forward1, params.neurons(), datapath);
    let output = forward2(&params.forward2);
    hidden.into_iter().chain(output).chain([tansig(&params.tansig, datapath)]).collect()
}

/// Formats the decoder's calibration ROM: line N is the time for a ones count of N [units].
pub fn tdc_decoder(params: &tdc_decoder::Params) -> Mem {
    let words = params.cal.iter().map(|age| age.get());
    Mem::new("tdc_cal.mem", lines(words, digits(params.age_bits())))
}

/// Formats the ROMs of the likelihood estimator: for each bin boundary its time and the width of the bin before it,
/// the pulse, k with its slope, the logarithm, the solver's program, and the light of a cover glass if it is known.
pub fn likelihood_estimator(params: &likelihood_estimator::params::Params) -> Vec<Mem> {
    let edge_bits = params.edge_bits();
    let bins = params.histogram.bins;
    let edge = |column: usize, place: usize| {
        let (width, end) = params.rom_word(column, place);
        width.get() << edge_bits | end.get()
    };
    let pulse = |word: &PulseWord| {
        (word.part as u64) << 18 | low_bits(word.slope, 9) << 9 | low_bits(word.first, 9)
    };
    let edges = match params.columns.len() {
        0 => (0..=bins).map(|place| edge(0, place)).collect::<Vec<_>>(),
        // Each column from a power of two on.
        others => (0..=others)
            .flat_map(|column| (0..2 * bins).map(move |place| (column, place)))
            .map(|(column, place)| if place > bins { 0 } else { edge(column, place) })
            .collect(),
    };
    let pulse = params.pulse.iter().map(pulse);
    let hazard = (0..64).map(|quarter| (TABLES.k[quarter] << 11 | TABLES.growth[quarter]) as u64);
    let log = LOG2.iter().map(|&log| log as u64);
    let glass = (params.glass.bins() > 0).then(|| {
        let parts = (0..bins).map(|bin| params.glass.part(bin) as u64);
        Mem::new("glass.mem", lines(parts, digits(17)))
    });
    let usual = [
        Mem::new("edges.mem", lines(edges, digits(edge_bits + WIDTH_BITS))),
        Mem::new("pulse.mem", lines(pulse, digits(35))),
        Mem::new("hazard.mem", lines(hazard, digits(28))),
        Mem::new("log2.mem", lines(log, digits(7))),
        likelihood_solver(params.program()),
    ];
    usual.into_iter().chain(glass).collect()
}

/// Formats the ROM of the likelihood estimator's solver: its program, an instruction a line.
pub fn likelihood_solver(program: &Program) -> Mem {
    let words = program.instructions.iter().map(Instruction::word);
    Mem::new("solver.mem", lines(words, digits(Instruction::BITS)))
}

/// Concatenates words of `width` bits into one, the first in the low bits.
fn words(row: &[Weight], width: u32) -> String {
    let bits = row.iter().flat_map(|word| (0..width).map(|bit| (word.get() >> bit & 1) as u8));
    let bits: Vec<u8> = bits.collect();
    let digit = |bits: &[u8]| bits.iter().rev().fold(0, |digit, bit| 2 * digit + bit);
    let digits = bits.chunks(4).rev().map(|bits| format!("{:x}", digit(bits)));
    digits.chain(["\n".to_owned()]).collect()
}

/// Returns the low bits of a word in two's complement.
fn low_bits(word: i64, width: u32) -> u64 {
    word as u64 & (u64::MAX >> (u64::BITS - width))
}

/// Returns the number of hexadecimal digits of a word of `bits` bits.
pub fn digits(bits: u32) -> usize {
    bits.div_ceil(4) as usize
}

/// Formats words as lines of `digits` hexadecimal digits.
pub fn lines(words: impl IntoIterator<Item = u64>, digits: usize) -> String {
    words.into_iter().map(|word| format!("{word:0digits$x}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::carry_chain::TAPS;
    use crate::firmware::tdc_decoder::Encoder;
    use crate::firmware::tdc_decoder::TimeScale;
    use crate::kernel::{S, U};
    use crate::network::Network;

    #[test]
    fn the_last_neuron_is_in_the_top_16_bits() {
        let row: Vec<Weight> = (-1..7).map(S::new).collect();
        assert_eq!(words(&row, 16), "0006000500040003000200010000ffff\n");
        assert_eq!(words(&row[..3], 3), "047\n", "001 000 111");
    }

    #[test]
    fn each_file_has_its_lines_and_digits() {
        let network = Network::builtin("uniform").unwrap().unwrap();
        let params = network.params(&Default::default());
        let mut cal = vec![U::new(0x3abc); TAPS + 1];
        cal[0] = U::new(5);
        let decoder = tdc_decoder::Params {
            cal,
            count_stages: 3,
            scale: TimeScale::default(),
            encoder: Encoder::default(),
            calibrated: None,
        };
        let mut files = depth_estimator(&params);
        files.push(tdc_decoder(&decoder));
        let shape = |mem: &Mem| {
            let digits = mem.text.lines().next().map(str::len);
            assert!(mem.text.lines().all(|line| Some(line.len()) == digits));
            (mem.name.clone().into_owned(), mem.text.lines().count(), digits.unwrap_or(0))
        };
        let expected = [
            ("w1.mem", 256, 32),
            ("b1.mem", 1, 32),
            ("w2.mem", 1, 32),
            ("b2.mem", 1, 4),
            ("tansig.mem", 4096, 4),
            ("tdc_cal.mem", 801, 4),
        ];
        assert_eq!(
            files.iter().map(shape).collect::<Vec<_>>(),
            expected.map(|(name, lines, digits)| (name.to_owned(), lines, digits))
        );
        assert!(files[5].text.starts_with("0005\n3abc\n"));
        assert_eq!(files[4].text.lines().nth(2048), Some("8016"));
        assert_eq!(files[3].text, format!("{:04x}\n", network.fixed.b2));
    }
}
