//! Verilog parameters of the centroid estimator, and the cycles and widths that follow from them.

use fixed::FixedU32;
use fixed::types::extra::{U12, U24};

use crate::firmware::forward2::Depth;
use crate::firmware::histogram_builder;
use crate::firmware::tof_top::slot::DepthM;
use crate::kernel::{S, U};

/// Largest W [bins].
pub const MOST_HALF_WIDTH: u64 = 31;
/// Cycles from the one of a word to the one that lets it into the sums.
pub(super) const SUMS: u64 = 2;
/// Bits of the quotient: 6 before the point, 12 after it.
pub(super) const QUOTIENT_BITS: u32 = 18;
/// Fraction bits of quotient and position.
pub const POSITION_FRACTION: u32 = Position::FRAC_NBITS;

/// Distance of a bin, 24 fraction bits [m].
pub type Slope = U<17>;
/// Fraction bits of [`Slope`].
pub const SLOPE_FRACTION: u32 = SlopeM::FRAC_NBITS;
/// [`Slope`] as a number [m].
pub type SlopeM = FixedU32<U24>;
/// Position in a histogram from the begin of bin 0 [bins].
pub type Position = FixedU32<U12>;
/// Distance that is added [m].
pub type Offset = S<30, 29>;

/// Verilog parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// Size of the histogram.
    pub histogram: histogram_builder::Params,
    /// W: words of the window to either side of its centre, 1 to 31 [bins].
    pub half_width: u64,
    /// True if height is counted from the window's first word and not from zero.
    pub background: bool,
    /// Distance of a bin.
    pub slope: Slope,
    /// Distance that is added.
    pub offset: Offset,
}

impl Default for Params {
    /// As the Verilog: W = 23, above the background, c/2 for 25 ps a bin, no offset.
    fn default() -> Self {
        Params {
            histogram: histogram_builder::Params::default(),
            half_width: 23,
            background: true,
            slope: U::new(62_871),
            offset: S::new(0),
        }
    }
}

/// Width of the position in a histogram: 12 fraction bits, and a bin's number, which has 7 bits at least, so
/// that one multiplier never takes all of it [bits].
pub fn position_bits(histogram: &histogram_builder::Params) -> u32 {
    histogram.bins.ilog2().max(7) + POSITION_FRACTION
}

impl Params {
    /// Distance of a bin [m].
    pub fn slope_m(&self) -> SlopeM {
        SlopeM::from_bits(self.slope.get() as u32)
    }

    /// Distance that is added [m].
    pub fn offset_m(&self) -> DepthM {
        DepthM::from_bits(self.offset.get())
    }

    /// Distance of a position, the bits past the last of a depth word dropped.
    pub fn depth(&self, position: Position) -> Depth {
        let metres = DepthM::from_num(position.wide_mul(self.slope_m()));
        Depth::new((metres + self.offset_m()).to_bits())
    }

    /// First cycle of the division, when the last centre has been looked at with any W.
    pub fn divide(&self) -> u64 {
        self.histogram.bins as u64 + MOST_HALF_WIDTH + 1 + SUMS
    }

    /// Cycle before the edge that makes the position.
    pub fn place(&self) -> u64 {
        self.divide() + QUOTIENT_BITS as u64
    }

    /// Cycle before the edge that makes the depth.
    pub(super) fn last(&self) -> u64 {
        self.done() - 1
    }

    /// Cycle in which the depth is ready: the estimator's latency [cycles of clk_sys].
    pub fn done(&self) -> u64 {
        self.place() + 4
    }
}
