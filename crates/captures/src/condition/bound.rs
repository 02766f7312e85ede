//! A condition tied to the signals of a sample.

use super::literal::mask;
use super::tree::{Level, Node, Relation, Test};

/// A condition that can be asked sample by sample.
#[derive(Clone, Debug)]
pub struct Bound {
    node: Node,
    watched: Vec<Watched>,
    /// The outcome of each test at the present sample, `None` where unknown bits decide.
    outcomes: Vec<Option<bool>>,
}

/// The bits that a test looks at, and what they were.
#[derive(Clone, Debug)]
pub(super) struct Watched {
    index: usize,
    low: u32,
    mask: u128,
    check: Check,
    before: Option<Level>,
}

#[derive(Clone, Debug)]
enum Check {
    /// The bits that matter are these, or are not.
    Bits {
        equal: bool,
        value: u128,
        care: u128,
    },
    /// In the order of whole numbers. The sign bit is added to both sides, which makes two's
    /// complement run on from the lowest value.
    Order {
        relation: Relation,
        value: u128,
        sign: u128,
    },
    Rising,
    Falling,
    Changed,
}

impl Watched {
    pub(super) fn new(index: usize, low: u32, width: u32, signed: bool, test: &Test) -> Self {
        let check = match test {
            Test::High => Check::Bits { equal: true, value: 1, care: 1 },
            Test::Rising => Check::Rising,
            Test::Falling => Check::Falling,
            Test::Changed => Check::Changed,
            Test::Compare(relation, literal, _) => {
                let (value, care) = literal.bits(width);
                let sign = if signed { 1 << (width - 1) } else { 0 };
                match relation {
                    Relation::Equal => Check::Bits { equal: true, value, care },
                    Relation::Unequal => Check::Bits { equal: false, value, care },
                    &relation => Check::Order { relation, value: value ^ sign, sign },
                }
            }
        };
        Watched { index, low, mask: mask(width), check, before: None }
    }

    fn sample(&mut self, level: Level) -> Option<bool> {
        let unknown = level.unknown >> self.low & self.mask;
        let value = level.value >> self.low & self.mask & !unknown;
        let before = self.before.replace(Level { value, unknown });
        match self.check {
            Check::Bits { equal, value: wanted, care } => {
                if (value ^ wanted) & care & !unknown != 0 {
                    Some(!equal)
                } else {
                    (unknown & care == 0).then_some(equal)
                }
            }
            Check::Order { relation, value: wanted, sign } => {
                let value = value ^ sign;
                (unknown == 0).then_some(match relation {
                    Relation::Equal => value == wanted,
                    Relation::Unequal => value != wanted,
                    Relation::Less => value < wanted,
                    Relation::LessOrEqual => value <= wanted,
                    Relation::Greater => value > wanted,
                    Relation::GreaterOrEqual => value >= wanted,
                })
            }
            Check::Changed => Some(before.is_some_and(|b| b != Level { value, unknown })),
            Check::Rising | Check::Falling => match before {
                None => Some(false),
                Some(before) if before.unknown | unknown != 0 => None,
                Some(before) => {
                    let rising = matches!(self.check, Check::Rising);
                    Some(before.value != value && (value == 1) == rising)
                }
            },
        }
    }
}

impl Bound {
    pub(super) fn new(node: Node, watched: Vec<Watched>) -> Self {
        let outcomes = vec![None; watched.len()];
        Bound { node, watched, outcomes }
    }

    /// Whether it holds at this sample, where `value` gives the level of a [`Place`](super::Place) by its
    /// index.
    ///
    /// It remembers the levels for `rising`, `falling` and `changed`, none of which holds at the
    /// first sample. What hangs on an unknown bit does not hold, nor does its opposite.
    pub fn sample(&mut self, value: impl Fn(usize) -> Level) -> bool {
        for (watched, outcome) in self.watched.iter_mut().zip(&mut self.outcomes) {
            *outcome = watched.sample(value(watched.index));
        }
        self.outcome(&self.node) == Some(true)
    }

    fn outcome(&self, node: &Node) -> Option<bool> {
        match node {
            Node::Leaf(test) => self.outcomes[*test],
            Node::Not(node) => self.outcome(node).map(|holds| !holds),
            Node::All(nodes) => self.joined(nodes, false),
            Node::Any(nodes) => self.joined(nodes, true),
        }
    }

    /// `decides` as soon as one does; else the opposite if all are known.
    fn joined(&self, nodes: &[Node], decides: bool) -> Option<bool> {
        let mut joined = Some(!decides);
        for node in nodes {
            match self.outcome(node) {
                Some(outcome) if outcome == decides => return Some(decides),
                Some(_) => {}
                None => joined = None,
            }
        }
        joined
    }
}
