//! Maximum likelihood in integers: a depth at the Cramér-Rao bound, its deviation, and whether to believe it.
//!
//! Of the R shots that still wait when a bin begins, n end in it, and n is binomial with the chance
//! 1 - exp(-lambda): lambda = b W + S G(mu), for a bin of width W into which the part G of a pulse around mu
//! falls. Bin 0 holds all of the pulse that came before its end: the SPAD is armed at the laser edge. The
//! residual and its variance need no logarithm and no division in a bin, as
//! k(lambda) = lambda / (1 - exp(-lambda)) comes from one table:
//!
//! - v = n k - R lambda, zero in the mean,
//! - w = R lambda (k - lambda), its variance and Fisher's information of log lambda.
//!
//! A scan with a box finds the start, and six steps of Fisher scoring in (mu, log S, log b) go on from there.
//! The unit of time is a 64th of a bin; words are as `docs/model.md` has them.

use std::sync::Arc;

use super::histogram_builder;

mod block;
mod params;
mod pulse;
mod tables;

pub use block::{In, LikelihoodEstimator, Registers, State, Wires};
pub use params::{Unfit, Wanted};
pub use pulse::{Pulse, PulseWord};
pub use tables::{LOG2, Tables, length, log2_64, reciprocal};

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
/// Fraction bits of a chi-square [1].
pub const CHI_FRACTION: u32 = 8;
/// Fisher steps of an estimation.
pub const STEPS: usize = 6;

/// What an estimation says beside its depth: each bit a reason not to believe it.
pub mod status {
    /// Nothing stands out, or not far enough.
    pub const NO_ECHO: u8 = 1;
    /// The pulse is cut by the begin or the end of the window.
    pub const CUT_OFF: u8 = 2;
    /// No shots were left when the echo came.
    pub const USED_UP: u8 = 4;
    /// Something else stands out too.
    pub const ANOTHER: u8 = 8;
    /// The last step was a long one.
    pub const NOT_SETTLED: u8 = 16;
    /// The histogram is not what the model makes.
    pub const NO_FIT: u8 = 32;
    /// The bits, and what each says.
    pub const ALL: [(u8, &str); 6] = [
        (NO_ECHO, "no echo"),
        (CUT_OFF, "cut off by the window"),
        (USED_UP, "shots used up"),
        (ANOTHER, "another echo"),
        (NOT_SETTLED, "not settled"),
        (NO_FIT, "no fit"),
    ];

    /// All that a status says, in words.
    pub fn words(status: u8) -> Vec<&'static str> {
        ALL.iter().filter(|(bit, _)| status & bit != 0).map(|&(_, words)| words).collect()
    }
}

/// Verilog parameters and what is in the ROMs.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// How large the histogram is.
    pub histogram: histogram_builder::Params,
    /// Shots of a histogram.
    pub shots: u64,
    /// Where bins begin, and last where the last one ends [half units].
    pub edges: Arc<[u32]>,
    /// The pulse, by the time from its middle.
    pub pulse: Arc<[PulseWord]>,
    /// Step of the pulse's ROM is 2 to the power of this [units].
    pub step_log2: u32,
    /// Bins of the fit before the one of the middle.
    pub before: usize,
    /// Bins of the fit after it.
    pub after: usize,
    /// Bins of the box that is slid over the histogram.
    pub box_bins: usize,
    /// 16 times the square of the pulse's deviation, which is 24 to 48 of what z counts.
    pub kappa: i64,
    /// The pulse's deviation [units].
    pub sigma: i64,
    /// Distance of a 16th of a unit, with `metres_shift` more fraction bits than a depth.
    pub metres: i64,
    /// See `metres`.
    pub metres_shift: u32,
}
