//! The instruction set of the solver, and the words of its ROM.

use strum::VariantArray;

/// Operation of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Op {
    /// to = c +- (a b >> shift).
    Alu,
    /// to = the reciprocal of a, a mantissa of 17 bits; `bits` are those of a.
    Reciprocal,
    /// to = the root of a b as a variance, and `bits` what it is to be shifted by.
    Root,
    /// `exponent` = how many bits the largest marked result has above 16.
    Exponent,
    /// `cut` = how many above 14.
    Cut,
    /// The program ends.
    End,
}

/// Addition to a shift, in the order of its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, VariantArray)]
pub enum By {
    /// Nothing.
    Nothing,
    /// `bits`.
    Bits,
    /// `exponent`.
    Exponent,
    /// `cut`.
    Cut,
    /// `bits` and `exponent`.
    Both,
    /// Additional fraction bits of distances over those of a depth.
    Metres,
}

/// Limits within which a result is kept, in the order of their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, VariantArray)]
pub enum Clamp {
    /// Limits of the word.
    Word,
    /// 1 or more.
    Positive,
    /// Limits of S.
    Signal,
    /// Limits of b.
    Ambient,
    /// Limits of a probability.
    Chance,
    /// 0 to the end of the window.
    Window,
    /// Limits of a step in log b.
    Growth,
    /// Limits of a step in log C.
    Change,
}

/// Number of the mark of a magnitude.
pub const MAGNITUDE: u64 = 1;
/// Number of the mark of the first flag.
pub const FLAGS: u64 = 8;

/// Further property of a result that is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Nothing.
    Nothing,
    /// Its magnitude counts for `exponent`.
    Magnitude,
    /// Its sign is that flag.
    Flag(u8),
}

impl Mark {
    /// Its number.
    pub fn number(self) -> u64 {
        match self {
            Mark::Nothing => 0,
            Mark::Magnitude => MAGNITUDE,
            Mark::Flag(flag) => FLAGS + u64::from(flag),
        }
    }
}

/// An instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// Operation.
    pub op: Op,
    /// Location of the result.
    pub to: u8,
    /// Location of the first operand.
    pub a: u8,
    /// Location of the second operand.
    pub b: u8,
    /// Location of the third operand.
    pub c: u8,
    /// The product is subtracted.
    pub minus: bool,
    /// Shift of the product to the right, before `by` is added [bits].
    pub shift: u8,
    /// Addition to the shift.
    pub by: By,
    /// Limits of the result.
    pub clamp: Clamp,
    /// Further property that is stored.
    pub mark: Mark,
    /// Cycles until the next one begins.
    pub wait: u8,
}

impl Instruction {
    /// Bits of a word of the ROM.
    pub const BITS: u32 = 49;

    /// The word of the ROM: all fields in their order, the operation on top.
    pub fn word(&self) -> u64 {
        let fields = [
            (self.op as u64, 3),
            (self.to.into(), 6),
            (self.a.into(), 6),
            (self.b.into(), 6),
            (self.c.into(), 6),
            (self.minus.into(), 1),
            (self.shift.into(), 5),
            (self.by as u64, 3),
            (self.clamp as u64, 3),
            (self.mark.number(), 4),
            (self.wait.into(), 6),
        ];
        fields.into_iter().fold(0, |word, (field, bits)| word << bits | field)
    }
}
