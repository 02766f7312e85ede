//! Values of a window in memory, for diagnosis.

use std::hash::{DefaultHasher, Hash, Hasher};

use tofsim::error::Result;

use crate::source::SourceState;

use super::super::align::Alignment;
use super::super::parts::gather;
use super::super::plan::Plan;
use super::super::result::Comparison;
use super::super::selection::Selected;
use crate::words::Bits;

/// Longest section of a window that is diagnosed [samples].
const LONGEST: u64 = 1 << 17;
/// Largest number of signals that are diagnosed individually.
const COLUMNS: usize = 32;

/// Values of a signal.
pub(super) struct DiagnosedSignal {
    /// Name on its side.
    pub(super) name: String,
    /// Index of its pair, if it has one.
    pub(super) pair: Option<usize>,
    pub(super) width: u32,
    /// Values, or hashes of values that are unknown or wide.
    pub(super) values: Vec<u64>,
}

/// Values of a window.
pub(super) struct Collected {
    /// Description of the window, for a sentence; empty without windows.
    pub(super) window: String,
    /// Number of the first sample.
    pub(super) first: u64,
    /// Both sides of the pairs that differ.
    pub(super) pairs: Vec<[DiagnosedSignal; 2]>,
    /// Signals of each side without a partner.
    pub(super) unpaired: [Vec<DiagnosedSignal>; 2],
    /// For each side and sample, a hash of the values of all pairs.
    pub(super) rows: [Vec<u64>; 2],
}

/// Returns the value if it has at most 64 bits, all known; otherwise a hash.
pub(super) fn key(bits: &Bits) -> u64 {
    if let ([value], true) = (&bits.value[..], bits.is_known()) {
        return *value;
    }
    let mut hasher = DefaultHasher::new();
    bits.hash(&mut hasher);
    hasher.finish()
}

/// Reads the window of the first difference or, without a difference, the first window.
pub(super) fn collect(
    plan: &Plan,
    alignment: &Alignment,
    result: &Comparison,
) -> Result<Collected> {
    let first = result.differing().filter_map(|pair| pair.first.as_ref()).min_by_key(|f| f.order);
    let window = first.map_or(0, |first| first.window);
    let pieces = [0, 1].map(|side| alignment.pieces[side].get(window).cloned());
    let mut collected = empty(plan, result, window);
    let [Some(a), Some(b)] = pieces else { return Ok(collected) };
    let before: u64 = (alignment.pieces[0][..window].iter())
        .zip(&alignment.pieces[1])
        .map(|(a, b)| a.count().unwrap_or(0).min(b.count().unwrap_or(0)))
        .sum();
    let position = first.map_or(0, |first| first.order.saturating_sub(before));
    let skip = position.saturating_sub(LONGEST / 2);
    collected.first = skip;
    let (a, b) = ([a.part(skip, LONGEST)], [b.part(skip, LONGEST)]);
    let mut sides = [Selected::new(plan.samples(0)?, &a), Selected::new(plan.samples(1)?, &b)];
    while let [Some(a), Some(b)] = [sides[0].next()?, sides[1].next()?] {
        if a.sample.is_extended && b.sample.is_extended {
            break;
        }
        for (side, selected) in sides.iter().enumerate() {
            push(plan, side, &selected.samples.state, &mut collected);
        }
    }
    Ok(collected)
}

fn empty(plan: &Plan, result: &Comparison, window: usize) -> Collected {
    let differing: Vec<&str> = result.differing().map(|pair| pair.name.as_str()).collect();
    let pairs = plan.matching.pairs.iter().enumerate();
    let pairs = pairs.filter(|(_, pair)| differing.contains(&pair.name.as_str())).take(COLUMNS);
    let column = |name: &String, pair, width| DiagnosedSignal {
        name: name.clone(),
        pair,
        width,
        values: Vec::new(),
    };
    let in_windows = plan.sources.iter().any(|source| source.is_capture());
    Collected {
        window: if in_windows { format!("window {window}: ") } else { String::new() },
        first: 0,
        pairs: pairs
            .map(|(k, pair)| {
                [&pair.name, &pair.other].map(|name| column(name, Some(k), pair.width))
            })
            .collect(),
        unpaired: [0, 1].map(|side| {
            let unpaired = plan.unpaired[side].iter();
            unpaired.map(|(name, part)| column(name, None, part.width)).collect()
        }),
        rows: Default::default(),
    }
}

fn push(plan: &Plan, side: usize, state: &SourceState, collected: &mut Collected) {
    let mut bits = Bits::default();
    for column in &mut collected.pairs {
        if let Some(pair) = column[side].pair {
            plan.matching.pairs[pair].gather(side, state, &mut bits);
            column[side].values.push(key(&bits));
        }
    }
    for (column, (_, part)) in collected.unpaired[side].iter_mut().zip(&plan.unpaired[side]) {
        gather(&[*part], state, &mut bits);
        column.values.push(key(&bits));
    }
    let mut row = DefaultHasher::new();
    for pair in plan.matching.pairs.iter().filter(|pair| !pair.is_event) {
        pair.gather(side, state, &mut bits);
        bits.hash(&mut row);
    }
    collected.rows[side].push(row.finish());
}
