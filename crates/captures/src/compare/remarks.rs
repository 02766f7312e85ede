//! Remarks of a result on the sides, apart from their values.

use crate::source::{SignalKind, SourceFormat};

use super::differences::PairCount;
use super::matching::UnmatchedReason;
use super::plan::Plan;
use super::result::Comparison;

/// Ordinal of each side, for sentences.
const SIDES: [&str; 2] = ["first", "second"];

/// Adds the pairs that were never compared, the signals without a partner, and the limits of the formats. With `all`,
/// a signal without a partner is a difference.
pub(super) fn add(plan: &Plan, counts: &[PairCount], all: bool, result: &mut Comparison) {
    let (differences, notes) = (&mut result.differences, &mut result.notes);
    for (pair, count) in plan.matching.pairs.iter().zip(counts) {
        match count.compared {
            0 if pair.latency != 0 => {
                differences
                    .push(format!("{}: no sample has both sides with that latency", pair.name));
            }
            0 if pair.valid.is_some() => {
                notes.push(format!("{} is compared nowhere: it is never valid", pair.name));
            }
            _ => {}
        }
    }
    for unmatched in &plan.matching.unmatched {
        let source = &plan.sources[unmatched.side];
        let (name, reason) = (&unmatched.name, &unmatched.reason);
        let text = format!("{}: {name} is not compared: {reason}", source.name);
        // A note says more of words whose values are not known.
        let is_noted = source.signals[unmatched.signal].kind == SignalKind::Other;
        if reason.is_skipped() && !is_noted {
            result.skipped.push(text.clone());
        }
        match reason {
            UnmatchedReason::Ignored => {}
            _ if !all && !source.is_capture() => {}
            UnmatchedReason::Text => notes.push(text),
            _ => differences.push(text),
        }
    }
    result.unmatched = plan.matching.unmatched.clone();
    if plan.matching.swapped {
        notes.push("the map's names are found with the sides exchanged".to_owned());
    }
    for (side, source) in plan.sources.iter().enumerate() {
        let name = SIDES[side];
        notes.extend(source.notes.iter().map(|note| format!("{}: {note}", source.name)));
        let is_vcd = source.format == SourceFormat::IlaVcd;
        if is_vcd && !plan.sources[1 - side].is_capture() {
            let note = "does not say how many samples it has; compared up to its last change";
            notes.push(format!("the {name} side {note}"));
        }
        if source.is_capture() && !source.radix_stated && !is_vcd {
            notes.push(format!("the {name} side does not say in which radix its values are"));
        }
    }
}
