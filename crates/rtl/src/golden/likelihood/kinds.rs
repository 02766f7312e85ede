//! Kinds of histograms, each of which shows one way in which an estimation ends.

/// How many there are.
pub(super) const KINDS: u64 = 17;
pub(super) const EXTREME: u64 = 1;
pub(super) const AT_END: u64 = 2;
pub(super) const AT_BEGIN: u64 = 3;
pub(super) const TWO: u64 = 4;
pub(super) const FAINT: u64 = 5;
pub(super) const USED_UP: u64 = 6;
pub(super) const RISING: u64 = 7;
pub(super) const FALLING: u64 = 8;
pub(super) const ODD: u64 = 9;
/// Without an echo, on either side of the least number of shots that are left at the end of the window.
pub(super) const DARK: u64 = 10;
pub(super) const UNARMED: u64 = 11;
/// On either side of a limit: the least score of any echo, the least of an unsure one, the highest of another, the least
/// shots that wait, the least score of an echo whose signal is uncertain.
pub(super) const LEAST: u64 = 12;
pub(super) const SURE: u64 = 13;
pub(super) const ANOTHER: u64 = 14;
pub(super) const WAITS: u64 = 15;
pub(super) const CERTAIN: u64 = 16;

/// Ends of a fit of two echoes, in the place of the limits: two targets; two of which one has a status; two that are too
/// near each other; one that may be two; one that a faint echo far from it leaves as it is; two of which the second takes
/// all shots that are left, so that its signal is not known.
pub(super) const FATES: u64 = 6;
pub(super) const FOUND: u64 = 0;
pub(super) const REJECTED: u64 = 1;
pub(super) const TOO_NEAR: u64 = 2;
pub(super) const MOVED: u64 = 3;
pub(super) const ALONE: u64 = 4;
pub(super) const UNCERTAIN: u64 = 5;
