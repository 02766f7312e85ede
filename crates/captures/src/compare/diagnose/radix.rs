//! Diagnosis of a column that was read in the wrong radix.

use bitvec::prelude::*;

use crate::ila::Radix;
use crate::ila::read::digits;
use crate::ila::write::write_cell;

use super::super::plan::Plan;
use super::super::result::Finding;
use super::collect::{Collected, DiagnosedSignal};

/// Finds pairs that would be equal if one column were read in another radix.
pub(super) fn findings(plan: &Plan, collected: &Collected) -> Vec<Finding> {
    let mut findings = Vec::new();
    for columns in &collected.pairs {
        for side in [1, 0] {
            let (own, other) = (&columns[side], &columns[1 - side]);
            let Some(radix) = radix(plan, side, own) else { continue };
            if own.width == 1 || own.width > 64 {
                continue;
            }
            let fits =
                |&to: &Radix| to != radix && reread(own, radix, to) == Some(other.values.clone());
            let likely = self::radix(plan, 1 - side, other);
            if let Some(to) = likely.into_iter().chain(Radix::ALL.iter().copied()).find(fits) {
                let side = ["first", "second"][side];
                let text = format!(
                    "{} of the {side} side is the same if it is read as {to} and not as {radix}: wrong \
                     radix",
                    own.name
                );
                findings.push(Finding::new("wrong radix", &[&columns[0].name], text));
                break;
            }
        }
    }
    findings
}

/// Returns the radix that a column states.
fn radix(plan: &Plan, side: usize, column: &DiagnosedSignal) -> Option<Radix> {
    let part = plan.matching.pairs[column.pair?].sides[side].first()?;
    let id = plan.matching.slots[side].ids[part.signal];
    plan.sources[side].signals.iter().find(|signal| signal.id == id)?.radix
}

/// Returns the values that the digits of a column have in another radix.
fn reread(column: &DiagnosedSignal, from: Radix, to: Radix) -> Option<Vec<u64>> {
    let values = column.values.iter().map(|value| {
        let mut cell = Vec::new();
        write_cell(&mut cell, from, &value.view_bits()[..column.width as usize]).ok()?;
        let bits = digits::read(&cell, to, column.width).ok()?;
        bits.number().map(|number| number as u64)
    });
    values.collect()
}
