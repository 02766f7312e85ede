//! What a condition is made of: tests of signals, and how they are joined.

use super::literal::Literal;

/// Where the signal of a name is found among the levels of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Number that [`Bound::sample`] asks for.
    pub index: usize,
    /// Width [bits].
    pub width: u32,
    /// Whether its value is two's complement.
    pub signed: bool,
}

/// What a signal is at a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Level {
    /// The bits; an unknown one may be either.
    pub value: u128,
    /// The bits that are not known.
    pub unknown: u128,
}

impl Level {
    /// A level without unknown bits.
    pub const fn known(value: u128) -> Self {
        Level { value, unknown: 0 }
    }
}

/// How tests are joined.
#[derive(Clone, Debug)]
pub(super) enum Node {
    /// A test, by its number.
    Leaf(usize),
    Not(Box<Node>),
    All(Vec<Node>),
    Any(Vec<Node>),
}

/// A test of one signal.
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    /// Name, perhaps with a slice.
    pub(super) name: String,
    /// Column of the name.
    pub(super) column: usize,
    pub(super) test: Test,
}

/// What a signal is tested for.
#[derive(Clone, Debug)]
pub(super) enum Test {
    /// Compared with a value, which stands at a column.
    Compare(Relation, Literal, usize),
    /// Is 1.
    High,
    Rising,
    Falling,
    Changed,
}

/// How a signal is compared with a value.
#[derive(Clone, Copy, Debug)]
pub(super) enum Relation {
    /// The bits that matter are the same, or are not.
    Equal(bool),
    /// By their order as whole numbers.
    Order(fn(&u128, &u128) -> bool),
}
