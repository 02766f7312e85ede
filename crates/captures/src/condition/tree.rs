//! Syntax tree of conditions: tests of signals, and their combination.

use super::literal::Literal;

/// A signal that a name was bound to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operand {
    /// Index by which [`Bound::sample`] requests its level.
    pub index: usize,
    /// Width [bits].
    pub width: u32,
    /// Whether its value is in two's complement.
    pub signed: bool,
}

/// Level of a signal at a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Level {
    /// Bits; unknown ones are arbitrary.
    pub value: u128,
    /// Mask of the unknown bits.
    pub unknown: u128,
}

impl Level {
    /// Creates a level without unknown bits.
    pub const fn known(value: u128) -> Self {
        Level { value, unknown: 0 }
    }
}

/// A node of the tree.
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
    /// Name, possibly with a slice.
    pub(super) name: String,
    /// Column of the name.
    pub(super) column: usize,
    pub(super) test: Test,
}

/// Kind of test.
#[derive(Clone, Debug)]
pub(super) enum Test {
    /// A comparison with a value at the given column.
    Compare(Relation, Literal, usize),
    /// A test for 1.
    High,
    Rising,
    Falling,
    Changed,
}

/// Relation of a comparison.
#[derive(Clone, Copy, Debug)]
pub(super) enum Relation {
    /// Equality of the bits that matter, or inequality.
    Equal(bool),
    /// Order as integers.
    Order(fn(&u128, &u128) -> bool),
}
