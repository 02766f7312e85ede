//! Number formats and status bits of the likelihood estimator.

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
/// Shots that have to wait at the fit's first bin.
pub const LEAST_WAITING: u64 = 32;
/// Score of the box that an echo has at least, 64 log2 of 25 squared deviations.
pub const LEAST_SCORE: i64 = 297;
/// Score of one that is sure, of 100.
pub const SURE_SCORE: i64 = 425;
/// Score above which something else is another echo, of 36.
pub const ANOTHER_SCORE: i64 = 331;

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
    /// Some shots were not armed at the laser edge: MODE 1 has no closed form of which those are.
    pub const UNARMED: u8 = 64;
    /// The bits, and what each says.
    pub const ALL: [(u8, &str); 7] = [
        (NO_ECHO, "no echo"),
        (CUT_OFF, "cut off by the window"),
        (USED_UP, "shots used up"),
        (ANOTHER, "another echo"),
        (NOT_SETTLED, "not settled"),
        (NO_FIT, "no fit"),
        (UNARMED, "shots not armed"),
    ];

    /// All that a status says, in words.
    pub fn words(status: u8) -> Vec<&'static str> {
        ALL.iter().filter(|(bit, _)| status & bit != 0).map(|&(_, words)| words).collect()
    }
}
