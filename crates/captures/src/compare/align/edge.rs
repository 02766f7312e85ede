//! Alignment by the first edge of a signal, or by the first sample.

use tofsim::error::{Input, Result};

use crate::source::{Axis, SourceState, Tick};

use super::super::pair::Pair;
use super::super::plan::Plan;
use super::super::samples::Sample;
use super::super::selection::Piece;
use super::alignment::Alignment;
use super::survey::{counts_differ, survey, triggers_differ, windows_differ};
use crate::words::Bits;

/// Aligns the first edges of a signal.
pub(super) fn alignment(plan: &Plan, signal: &str) -> Result<Alignment> {
    let pair = plan.matching.pair(signal)?;
    let edges = [first(plan, 0, pair)?, first(plan, 1, pair)?];
    let found = format!("{signal} first changes at samples {} and {}", edges[0], edges[1]);
    Ok(Alignment::shifted(edges[1] as i64 - edges[0] as i64, found))
}

/// Returns the time between the first edges of a signal on both sides [fs].
pub(super) fn shift(plan: &Plan, signal: &str) -> Result<(i128, String)> {
    let pair = &plan.matching.pairs[plan.matching.pair(signal)?];
    let mut edges = [0, 0];
    for (side, edge) in edges.iter_mut().enumerate() {
        let source = plan.sources[side];
        let Axis::Time(tick) = source.axis else { continue };
        let mut cursor = source.read(&plan.matching.slots[side].ids)?;
        let mut changes = changes(pair, side);
        *edge = loop {
            let Some(at) = cursor.peek()? else {
                return Err(Input::new(&source.name, "never changes").field(&pair.name).into());
            };
            cursor.take(|_| ());
            let at_fs = tick.femtoseconds(at);
            if changes(&cursor.state) && at_fs >= plan.terms.after.fs() as u128 {
                break at_fs as i128;
            }
        };
    }
    let found = edges.map(|edge| format!("{} ns", edge as f64 / 1e6)).join(" and ");
    Ok((edges[1] - edges[0], format!("{signal} first changes at {found}")))
}

fn first(plan: &Plan, side: usize, pair: usize) -> Result<u64> {
    let pair = &plan.matching.pairs[pair];
    let mut changes = changes(pair, side);
    let edge = find(plan, side, |sample, state| {
        let changed = changes(state);
        changed && plan.is_looked_at(side, sample)
    })?;
    let never = || plan.fault(side, "never changes").field(&pair.name);
    Ok(edge.ok_or_else(never)?.index)
}

/// Returns a detector of changes between known values of a pair on one side.
fn changes(pair: &Pair, side: usize) -> impl FnMut(&SourceState) -> bool {
    let mut before = None::<Bits>;
    move |state| {
        let mut now = Bits::default();
        pair.gather(side, state, &mut now);
        let changed = before.as_ref().is_some_and(|before| *before != now && before.is_known());
        before = Some(now);
        changed
    }
}

/// Aligns the first samples of each window; waveforms by time.
pub(super) fn start(plan: &Plan) -> Result<Alignment> {
    let found = "from the first sample on".to_owned();
    match plan.sources.map(|source| source.axis) {
        [Axis::Time(a), Axis::Time(b)] => same_time(plan, [a, b]),
        [Axis::Samples, Axis::Samples] => {
            let windows = [survey(plan.sources[0])?.windows, survey(plan.sources[1])?.windows];
            let mut differences =
                Vec::from_iter(windows_differ(windows[0].len(), windows[1].len()));
            for (k, (a, b)) in windows[0].iter().zip(&windows[1]).enumerate() {
                differences.extend(counts_differ(k, a, b));
                differences.extend(triggers_differ(k, a, b));
            }
            let count = windows[0].len().min(windows[1].len());
            let pieces = windows.map(|windows| {
                let windows = windows.iter().take(count);
                windows.map(|window| Piece::Run(window.first, window.count)).collect()
            });
            Ok(Alignment { pieces, found, offset: Some(0), differences, doubts: Vec::new() })
        }
        _ => Ok(Alignment::shifted(0, found)),
    }
}

/// Aligns two waveforms from the first sample of each that is not before the other's.
fn same_time(plan: &Plan, ticks: [Tick; 2]) -> Result<Alignment> {
    let coarse = ticks[0].max(ticks[1]);
    let time = |side: usize, sample: Sample| ticks[side].convert(sample.at, coarse);
    let mut firsts = [0, 0];
    let mut times = [0, 0];
    for side in 0..2 {
        let Some(sample) = first_looked_at(plan, side)? else {
            let expected = format!("the clock never rises after {}", plan.terms.after);
            return Err(plan.fault(side, expected).into());
        };
        (firsts[side], times[side]) = (sample.index, time(side, sample));
    }
    let early = if times[0] < times[1] { 0 } else { 1 };
    let begin = times[1 - early];
    let first = find(plan, early, |sample, _| time(early, sample) >= begin)?;
    let Some(first) = first.filter(|&sample| time(early, sample) == begin) else {
        let expected =
            "no edge of the clock is at the time of the other side's first; give --align";
        return Err(plan.fault(early, expected).into());
    };
    firsts[early] = first.index;
    let pieces = firsts.map(|first| vec![Piece::Run(first, None)]);
    let offset = Some(firsts[1] as i64 - firsts[0] as i64);
    let found = "samples of the same time".to_owned();
    Ok(Alignment { pieces, found, offset, ..Alignment::default() })
}

/// Returns the first sample in the range of the comparison.
pub(super) fn first_looked_at(plan: &Plan, side: usize) -> Result<Option<Sample>> {
    find(plan, side, |sample, _| plan.is_looked_at(side, sample))
}

/// Returns the first sample of a side that satisfies a predicate.
fn find(
    plan: &Plan,
    side: usize,
    mut wanted: impl FnMut(Sample, &SourceState) -> bool,
) -> Result<Option<Sample>> {
    let mut samples = plan.samples(side)?;
    while let Some(sample) = samples.next()?.filter(|sample| !sample.is_extended) {
        if wanted(sample, &samples.state) {
            return Ok(Some(sample));
        }
    }
    Ok(None)
}
