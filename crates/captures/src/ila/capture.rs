//! A capture in memory: what a logic analyser's buffer holds.

use std::ops::Range;

use bitvec::prelude::*;

/// How the digits of a value are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Radix {
    /// Hexadecimal, lower case, all digits
    Hex,
    /// Two's complement, decimal
    Signed,
    /// Decimal
    Unsigned,
    /// Bit by bit, all digits
    Binary,
    /// Three bits to a digit, all digits
    Octal,
}

impl Radix {
    /// All of them.
    pub const ALL: [Radix; 5] =
        [Radix::Hex, Radix::Signed, Radix::Unsigned, Radix::Binary, Radix::Octal];

    /// The word that Vivado writes.
    pub const fn word(self) -> &'static str {
        match self {
            Radix::Hex => "HEX",
            Radix::Signed => "SIGNED",
            Radix::Unsigned => "UNSIGNED",
            Radix::Binary => "BINARY",
            Radix::Octal => "OCTAL",
        }
    }
}

/// An input of the logic analyser.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Probe {
    /// Name without a range.
    pub name: String,
    /// Width [bits].
    pub width: u32,
    /// Index of its lowest bit.
    pub lsb: u32,
    /// Whether it has a range, even of one bit.
    pub vector: bool,
    /// How its values are shown.
    pub radix: Radix,
}

impl Probe {
    /// Name and range, as the head of a column has them: `count[15:0]`.
    pub fn head(&self) -> String {
        match self.vector {
            true => format!("{}[{}:{}]", self.name, self.lsb + self.width - 1, self.lsb),
            false => self.name.clone(),
        }
    }
}

/// Samples of some probes, in windows that each may have a trigger.
///
/// In a sample the probes stand side by side, the lowest bit of the first at bit 0.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Capture {
    /// The probes.
    pub probes: Vec<Probe>,
    /// Words of a sample.
    pub stride: usize,
    /// The samples, one after the other.
    pub words: Vec<u64>,
    /// Sample with which each window begins.
    pub windows: Vec<usize>,
    /// Samples that triggered, one for each window but perhaps the last.
    pub triggers: Vec<usize>,
}

impl Capture {
    /// No samples of `probes` yet.
    pub fn new(probes: Vec<Probe>) -> Self {
        let bits: usize = probes.iter().map(|probe| probe.width as usize).sum();
        Capture { probes, stride: bits.div_ceil(64).max(1), ..Capture::default() }
    }

    /// Bits of a sample.
    pub fn width(&self) -> usize {
        self.probes.iter().map(|probe| probe.width as usize).sum()
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.words.len() / self.stride
    }

    /// A sample.
    pub fn sample(&self, sample: usize) -> &BitSlice<u64, Lsb0> {
        self.words[sample * self.stride..(sample + 1) * self.stride].view_bits()
    }

    /// Each probe's place in a sample.
    pub fn places(&self) -> impl Iterator<Item = Range<usize>> {
        let widths = self.probes.iter().map(|probe| probe.width as usize);
        widths.scan(0, |low, width| {
            *low += width;
            Some(*low - width..*low)
        })
    }
}
