//! Places of the operands and results of the solver's instructions.

/// Words of the solver's memory; from [`ONE`] on they are constants.
pub const ARRIVAL: u8 = 0;
/// S.
pub const SIGNAL: u8 = 1;
/// b.
pub const AMBIENT: u8 = 2;
pub const F1: u8 = 3;
pub const F2: u8 = 4;
pub const F3: u8 = 5;
pub const A11: u8 = 6;
pub const A12: u8 = 7;
pub const A22: u8 = 8;
pub const X1: u8 = 9;
pub const X2: u8 = 10;
pub const DET: u8 = 11;
pub const N1: u8 = 12;
pub const N2: u8 = 13;
pub const D1: u8 = 14;
pub const D2: u8 = 15;
pub const T: u8 = 16;
pub const R: u8 = 17;
/// The first constant.
pub const ONE: u8 = 18;
pub const KAPPA: u8 = 19;
pub const STRIDE: u8 = 20;
pub const METRES: u8 = 21;
pub const THIRD: u8 = 22;
pub const NINETEEN: u8 = 23;
pub const POWER: u8 = 24;
pub const ZERO: u8 = 25;
pub const WIDE: u8 = 26;
pub const MARGIN: u8 = 27;
pub const END: u8 = 28;
pub const VARIANCE: u8 = 29;
pub const UNSURE: u8 = 30;
pub const TWO: u8 = 31;

/// Operands from other blocks: of `a` ..
pub const SUM_13: u8 = 32;
pub const SUM_23: u8 = 33;
pub const SUM_33: u8 = 34;
pub const SCORE_3: u8 = 35;
pub const ENDED: u8 = 36;
pub const EXPOSURE: u8 = 37;
pub const EXCESS: u8 = 38;
pub const MIDDLE: u8 = 39;
pub const LENGTH: u8 = 40;
pub const BOX: u8 = 41;
pub const SCORE_4: u8 = 43;
pub const SUM_14: u8 = 44;
pub const SUM_24: u8 = 45;
pub const SUM_34: u8 = 46;
pub const SUM_44: u8 = 47;
/// .. and of `c`.
pub const SUM_11: u8 = 32;
pub const SUM_12: u8 = 33;
pub const SUM_22: u8 = 34;
pub const SCORE_1: u8 = 35;
pub const SCORE_2: u8 = 36;
pub const OTHER_13: u8 = 40;
pub const OTHER_23: u8 = 41;
pub const OTHER_33: u8 = 42;
pub const OTHER_SCORE_3: u8 = 43;

/// Location of the depth.
pub const DEPTH: u8 = 32;
/// Location of sigma.
pub const SIGMA: u8 = 33;

/// The cover glass's light C, behind the operands from other blocks, as what follows.
pub const GLASS: u8 = 48;
/// C when it was calibrated.
pub const CALIBRATED: u8 = 49;
pub const G1: u8 = 50;
pub const G2: u8 = 51;
pub const G3: u8 = 52;
pub const G4: u8 = 53;
pub const A13: u8 = 54;
pub const A23: u8 = 55;
/// Information on log b that is left without log C.
pub const A33: u8 = 56;
pub const Y3: u8 = 57;
/// Arrival of the other echo.
pub const OTHER_ARRIVAL: u8 = 58;
/// S of the other echo.
pub const OTHER_SIGNAL: u8 = 59;

/// Returns whether a place is a word of the solver, which all but operands from other blocks are.
pub fn is_own(place: u8) -> bool {
    !(32..48).contains(&place)
}
