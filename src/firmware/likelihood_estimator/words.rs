//! Number formats and limits of the likelihood estimator.

use fixed::FixedU64;
use fixed::types::extra::U8;

/// Units of time in a bin [1].
pub const UNITS: i64 = 64;
/// Fraction bits of the signal S [photons a shot].
pub const SIGNAL_FRACTION: u32 = 14;
/// Fraction bits of the ambient hazard b [1 / unit].
pub const AMBIENT_FRACTION: u32 = 30;
/// Fraction bits of a bin's hazard lambda [1].
pub const HAZARD_FRACTION: u32 = 22;
/// Fraction bits of a residual v [counts].
pub const RESIDUAL_FRACTION: u32 = 4;
/// Fraction bits of a weight w [counts].
pub const WEIGHT_FRACTION: u32 = 6;
/// Ridge of the information on log S, and half of that on mu: a 16th of a count, with the fraction bits of a weight.
pub const RIDGE: i64 = (1 << WEIGHT_FRACTION) / 16;
/// Ridge of the information on log b: a quarter of a count, with the fraction bits of a weight. Where ambient light is
/// hardly seen, a larger one would claim that it is known.
pub const AMBIENT_RIDGE: i64 = (1 << WEIGHT_FRACTION) / 4;
/// Fraction bits of quotients and steps [1].
pub const QUOTIENT_FRACTION: u32 = 14;
/// Fraction bits of depth and deviation [m].
pub const DEPTH_FRACTION: u32 = 29;
/// Chi-square of a fit [1].
pub type ChiSquare = FixedU64<U8>;
/// Fraction bits of a chi-square [1].
pub const CHI_FRACTION: u32 = ChiSquare::FRAC_NBITS;
/// Fraction bits of an excess over the ambient light [counts].
pub const EXCESS_FRACTION: u32 = 8;
/// Blocks of bins that show the ambient light.
pub const BLOCKS: usize = 8;
/// A block counts with a 64th of the first one's exposure, in 64ths of powers of two.
pub const LEAST_EXPOSURE: i64 = 6 * 64;
/// Largest chance that a block is taken to show: a half, 24 fraction bits.
pub const MOST_CHANCE: i64 = 1 << 23;
/// Addition to the expected count of a bin while shots wait: a tenth, 8 fraction bits.
pub const ADDED: i64 = 26;
/// Score of a box in which less than expected ended.
pub const NO_SCORE: i64 = -4096;
/// Smallest hazard of a bin, 2^-20.
pub const LEAST_HAZARD: i64 = 1 << (HAZARD_FRACTION - 20);
/// Largest hazard of a bin, just below 16.
pub const MOST_HAZARD: i64 = (16 << HAZARD_FRACTION) - 1;
/// The whole of a hazard is signal: 12 fraction bits.
pub const WHOLE: i64 = 4096;
/// Smallest S.
pub const LEAST_SIGNAL: i64 = 16;
/// Largest S or b.
pub const MOST_LEVEL: i64 = (1 << 24) - 1;
/// A residual of so many squared deviations is no chance.
pub const FAR: i64 = 25;
/// The part of a chi-square's term that is kept: 16 bits and its fraction.
pub const MOST_TERM: i64 = (1 << 24) - 1;
/// Fisher steps of an estimation.
pub const STEPS: usize = 6;
/// Steps before them that fit a pedestal without an echo.
pub const GLASS_STEPS: usize = 2;
/// Shots that have to wait at the fit's first bin.
pub const LEAST_WAITING: u64 = 32;
/// Part of the shots that has to be left at the end of the window for the absence of an echo to show that there is no
/// target: a 64th.
pub const LEAST_LEFT_LOG2: u32 = 6;
/// Score of the box that an echo has at least, 64 log2 of 25 squared deviations.
pub const LEAST_SCORE: i64 = 297;
/// Score of one that is sure, of 100.
pub const SURE_SCORE: i64 = 425;
/// Score of a certain echo, of 10,000 squared deviations: its signal may be uncertain.
pub const CERTAIN_SCORE: i64 = 850;
/// Information on log b below which a step does not lower b: 8 counts, 6 fraction bits. Below it the sums round away
/// how the depth depends on b, so that sigma would be too small.
pub const SCARCE: i64 = 8 << WEIGHT_FRACTION;
/// Score above which something else is another echo, of 36.
pub const ANOTHER_SCORE: i64 = 331;
