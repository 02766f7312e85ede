//! Conditions over the signals of a source.

use tofsim::error::Result;
use tofsim::kernel::signals::SignalFormat as Shape;

use crate::condition::{Bound, Condition, Level, Operand};
use crate::source::{Name, Source, SourceState, known_shape};
use crate::words::{Bits, lowest};

use super::find;
use super::matching::Matching;
use super::parts::{Part, gather};

/// A condition bound to the signals of one side.
#[derive(Clone)]
pub(super) struct SideCondition {
    bound: Bound,
    /// Parts of each operand, highest first.
    operands: Vec<Vec<Part>>,
}

impl SideCondition {
    /// Binds a condition to the signals of a side, by their names on either side.
    ///
    /// Whether a signal is in two's complement is determined by the map, or else by the firmware's signal of that
    /// name, as in a capture, regardless of the radix of its column.
    ///
    /// # Errors
    /// If a signal is not found, or a value does not fit.
    pub(super) fn new(
        source: &Source,
        side: usize,
        matching: &mut Matching,
        condition: &Condition,
    ) -> Result<SideCondition> {
        let mut operands = Vec::new();
        let bound = condition.bind(&mut |text| {
            let index = operands.len();
            let pair = matching.pairs.iter().find(|pair| pair.name == text || pair.other == text);
            if let Some(pair) = pair {
                let whole = pair.sides[side].iter().all(|part| part.whole);
                let signed = pair.signed.unwrap_or_else(|| {
                    whole && [&pair.name, &pair.other].iter().any(|name| is_signed(name))
                });
                operands.push(pair.sides[side].clone());
                return Ok(Operand { index, width: pair.width, signed });
            }
            let found = find::signal(source, text)?;
            let signal = &source.signals[found];
            operands.push(vec![Part::whole(&mut matching.slots[side], signal)]);
            Ok(Operand { index, width: signal.width, signed: is_signed(&signal.name.text) })
        })?;
        Ok(SideCondition { bound, operands })
    }

    /// Evaluates the condition at a sample.
    pub(super) fn sample(&mut self, state: &SourceState) -> bool {
        let operands = &self.operands;
        self.bound.sample(|operand| level(state, &operands[operand]))
    }

    /// Evaluates the condition at a sample before power-up, where all signals are 0.
    pub(super) fn sample_nothing(&mut self) -> bool {
        self.bound.sample(|_| Level::known(0))
    }
}

fn is_signed(name: &str) -> bool {
    matches!(known_shape(&[&Name::new(name)]), Some(Shape::Signed { .. }))
}

fn level(state: &SourceState, parts: &[Part]) -> Level {
    let mut bits = Bits::default();
    gather(parts, state, &mut bits);
    Level { value: lowest(&bits.value), unknown: lowest(&bits.unknown) }
}
