//! Number formats and status bits of the likelihood estimator.

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
/// Fraction bits of quotients and steps [1].
pub const QUOTIENT_FRACTION: u32 = 14;
/// Fraction bits of depth and deviation [m].
pub const DEPTH_FRACTION: u32 = 29;
/// Chi-square of a fit [1].
pub type ChiSquare = FixedU64<U8>;
/// Fraction bits of a chi-square [1].
pub const CHI_FRACTION: u32 = ChiSquare::FRAC_NBITS;
/// Fisher steps of an estimation.
pub const STEPS: usize = 6;
/// Shots that have to wait at the fit's first bin.
pub const LEAST_WAITING: u64 = 32;
/// Score of the box that an echo has at least, 64 log2 of 25 squared deviations.
pub const LEAST_SCORE: i64 = 297;
/// Score of one that is sure, of 100.
pub const SURE_SCORE: i64 = 425;
/// Score above which something else is another echo, of 36.
pub const ANOTHER_SCORE: i64 = 331;
