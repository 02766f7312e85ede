//! Conditions bound to signals.

use super::literal::mask;
use super::tree::{Level, Node, Relation, Test};

/// A condition that can be evaluated sample by sample.
#[derive(Clone, Debug)]
pub struct Bound {
    node: Node,
    watched: Vec<Watched>,
    /// Outcome of each test at the present sample; `None` if it depends on unknown bits.
    outcomes: Vec<Option<bool>>,
}

/// Bits of a test, with their last level.
#[derive(Clone, Debug)]
pub(super) struct Watched {
    index: usize,
    low: u32,
    width: u32,
    signed: bool,
    test: Test,
    before: Option<Level>,
}

impl Watched {
    pub(super) fn new(index: usize, low: u32, width: u32, signed: bool, test: &Test) -> Self {
        Watched { index, low, width, signed, test: test.clone(), before: None }
    }

    fn sample(&mut self, level: Level) -> Option<bool> {
        let mask = mask(self.width);
        let unknown = level.unknown >> self.low & mask;
        let value = level.value >> self.low & mask & !unknown;
        let before = self.before.replace(Level { value, unknown });
        let equal = |wanted: u128, care: u128| match (value ^ wanted) & care & !unknown {
            0 => (unknown & care == 0).then_some(true),
            _ => Some(false),
        };
        match &self.test {
            Test::High => equal(1, 1),
            Test::Compare(relation, literal, _) => {
                let (wanted, care) = literal.bits(self.width);
                match relation {
                    Relation::Equal(wish) => equal(wanted, care).map(|equal| equal == *wish),
                    Relation::Order(order) => {
                        // With the sign bit turned, two's complement runs on from the lowest value.
                        let sign = u128::from(self.signed) << (self.width - 1);
                        (unknown == 0).then(|| order(&(value ^ sign), &(wanted ^ sign)))
                    }
                }
            }
            Test::Changed => Some(before.is_some_and(|before| before != Level { value, unknown })),
            Test::Rising | Test::Falling => match before {
                None => Some(false),
                Some(before) if before.unknown | unknown != 0 => None,
                Some(before) => {
                    let rising = matches!(self.test, Test::Rising);
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

    /// Evaluates the condition at the next sample, where `value` returns the level of a [`Operand`](super::Operand) by
    /// its index.
    ///
    /// Levels are stored for `rising`, `falling` and `changed`, which are false at the first sample. A test that
    /// depends on an unknown bit is false, and so is its negation.
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

    /// Combines outcomes: `decides` if any outcome is that, otherwise the opposite if all are known.
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
