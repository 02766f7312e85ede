//! A capture in memory: the contents of a logic analyser's buffer.

use std::ops::Range;

use bitvec::prelude::*;
use strum::{Display, EnumString, IntoStaticStr, VariantArray};

/// Radix in which values are written. Its text is Vivado's name of it.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, Display, EnumString, IntoStaticStr, VariantArray,
)]
#[strum(serialize_all = "UPPERCASE")]
pub enum Radix {
    /// Hexadecimal, lower case, all digits
    Hex,
    /// Two's complement, decimal
    Signed,
    /// Decimal
    Unsigned,
    /// Binary, all digits
    Binary,
    /// Octal, all digits
    Octal,
}

impl Radix {
    /// All radices.
    pub const ALL: &[Radix] = Radix::VARIANTS;
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
    /// Whether its name has a range, even for one bit.
    pub vector: bool,
    /// Radix in which its values are shown.
    pub radix: Radix,
}

impl Probe {
    /// Returns name and range as in the head of a column: `count[15:0]`.
    pub fn head(&self) -> String {
        if self.vector {
            format!("{}[{}:{}]", self.name, self.lsb + self.width - 1, self.lsb)
        } else {
            self.name.clone()
        }
    }
}

/// Samples of some probes, in windows with at most one trigger each.
///
/// A sample is the concatenation of all probes, with the lowest bit of the first probe at bit 0.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Capture {
    /// The probes.
    pub probes: Vec<Probe>,
    /// Words per sample.
    pub stride: usize,
    /// Words of all samples.
    pub words: Vec<u64>,
    /// First sample of each window.
    pub windows: Vec<usize>,
    /// Sample that triggered in each window; the last window may have none.
    pub triggers: Vec<usize>,
}

impl Capture {
    /// Creates an empty capture of `probes`.
    pub fn new(probes: Vec<Probe>) -> Self {
        let bits: usize = probes.iter().map(|probe| probe.width as usize).sum();
        Capture { probes, stride: bits.div_ceil(64).max(1), ..Capture::default() }
    }

    /// Returns the number of bits per sample.
    pub fn width(&self) -> usize {
        self.probes.iter().map(|probe| probe.width as usize).sum()
    }

    /// Returns the number of samples.
    pub fn samples(&self) -> usize {
        self.words.len() / self.stride
    }

    /// Returns the bits of a sample.
    pub fn sample(&self, sample: usize) -> &BitSlice<u64, Lsb0> {
        self.words[sample * self.stride..(sample + 1) * self.stride].view_bits()
    }

    /// Returns the bit range of each probe in a sample.
    pub fn places(&self) -> impl Iterator<Item = Range<usize>> {
        let widths = self.probes.iter().map(|probe| probe.width as usize);
        widths.scan(0, |low, width| {
            *low += width;
            Some(*low - width..*low)
        })
    }
}
