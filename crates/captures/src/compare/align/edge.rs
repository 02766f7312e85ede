//! Alignment by the first edge of a signal, and by the begin.

use tofsim::error::{Input, Result};

use crate::source::Axis;

use super::super::plan::Plan;
use super::super::samples::Sample;
use super::super::selection::Piece;
use super::alignment::Alignment;
use super::survey::survey;
use crate::words::Bits;

/// The first edges of a signal belong together.
pub(super) fn alignment(plan: &Plan, signal: &str) -> Result<Alignment> {
    let pair = plan.matching.pair(signal)?;
    let edges = [first(plan, 0, pair)?, first(plan, 1, pair)?];
    let found = format!("{signal} first changes at samples {} and {}", edges[0], edges[1]);
    Ok(Alignment::shifted(edges[1] as i64 - edges[0] as i64, found))
}

/// Time between the first edges of a signal of two waveforms [fs].
pub(super) fn shift(plan: &Plan, signal: &str) -> Result<(i128, String)> {
    let pair = &plan.matching.pairs[plan.matching.pair(signal)?];
    let mut edges = [0, 0];
    for (side, edge) in edges.iter_mut().enumerate() {
        let source = plan.sources[side];
        let Axis::Time(tick) = source.axis else { continue };
        let mut cursor = source.read(&plan.matching.slots[side].ids)?;
        let (mut before, mut now) = (None::<Bits>, Bits::default());
        *edge = loop {
            let Some(at) = cursor.peek()? else {
                return Err(Input::new(&source.name, "never changes").field(&pair.name).into());
            };
            cursor.take(|_| ());
            pair.gather(side, &cursor.state, &mut now);
            let changed = before.is_some_and(|before| before != now && before.is_known());
            let at_fs = tick.femtoseconds(at);
            if changed && at_fs >= plan.terms.after.fs() as u128 {
                break at_fs as i128;
            }
            before = Some(now.clone());
        };
    }
    let found = edges.map(|edge| format!("{} ns", edge as f64 / 1e6)).join(" and ");
    Ok((edges[1] - edges[0], format!("{signal} first changes at {found}")))
}

fn first(plan: &Plan, side: usize, pair: usize) -> Result<u64> {
    let (mut samples, pair) = (plan.samples(side)?, &plan.matching.pairs[pair]);
    let (mut before, mut now) = (None::<Bits>, Bits::default());
    while let Some(sample) = samples.next()? {
        if sample.held {
            break;
        }
        pair.gather(side, samples.state(), &mut now);
        if plan.is_looked_at(side, sample)
            && before.as_ref().is_some_and(|before| *before != now && before.is_known())
        {
            return Ok(sample.index);
        }
        before = Some(now.clone());
    }
    let source = &plan.sources[side].name;
    Err(Input::new(source, "never changes").field(&pair.name).into())
}

/// The first samples belong together, window by window; of waveforms those of the same time.
pub(super) fn start(plan: &Plan) -> Result<Alignment> {
    let found = "from the first sample on".to_owned();
    match plan.sources.map(|source| source.axis) {
        [Axis::Time(a), Axis::Time(b)] => {
            let coarse = a.max(b);
            let mut first = [None, None];
            for (side, tick) in [(0, a), (1, b)] {
                let sample = first_looked_at(plan, side)?;
                first[side] = sample.map(|sample| (sample, tick.convert(sample.at, coarse)));
            }
            let [Some((sample_a, a)), Some((sample_b, b))] = first else {
                let side = usize::from(first[0].is_some());
                let expected = format!("the clock never rises after {}", plan.terms.after);
                return Err(Input::new(&plan.sources[side].name, expected).into());
            };
            let (side, at) = if a < b { (0, b) } else { (1, a) };
            let late = same_time(plan, side, [plan.sources[side].axis, Axis::Time(coarse)], at)?;
            let mut firsts = [sample_a.index, sample_b.index];
            firsts[side] = late;
            let pieces = firsts.map(|first| vec![Piece::Run(first, None)]);
            let found = "samples of the same time".to_owned();
            let offset = Some(firsts[1] as i64 - firsts[0] as i64);
            Ok(Alignment { pieces, found, offset, differences: Vec::new() })
        }
        [Axis::Samples, Axis::Samples] => {
            let windows = [survey(plan.sources[0])?.windows, survey(plan.sources[1])?.windows];
            let mut differences = Vec::new();
            let counts = [windows[0].len(), windows[1].len()];
            if counts[0] != counts[1] {
                let [a, b] = counts;
                differences.push(format!("the first has {a} windows, the second {b}"));
            }
            for (k, (a, b)) in windows[0].iter().zip(&windows[1]).enumerate() {
                if let (Some(a), Some(b)) = (a.count, b.count)
                    && a != b
                {
                    let text = format!("window {k}: {a} samples in the first, {b} in the second");
                    differences.push(text);
                }
                let marks = [a, b].map(|window| window.trigger.map(|at| at - window.first));
                if marks[0] != marks[1] {
                    let [a, b] = marks.map(|at| at.map_or("none".to_owned(), |at| at.to_string()));
                    differences.push(format!(
                        "window {k}: trigger at sample {a} of the first, {b} of the second"
                    ));
                }
            }
            let pieces = windows.map(|windows| {
                let windows = windows.iter().take(counts[0].min(counts[1]));
                windows.map(|window| Piece::Run(window.first, window.count)).collect()
            });
            Ok(Alignment { pieces, found, offset: Some(0), differences })
        }
        _ => Ok(Alignment::shifted(0, found)),
    }
}

/// The first sample that is looked at.
fn first_looked_at(plan: &Plan, side: usize) -> Result<Option<Sample>> {
    let mut samples = plan.samples(side)?;
    while let Some(sample) = samples.next()? {
        if plan.is_looked_at(side, sample) {
            return Ok(Some(sample));
        }
    }
    Ok(None)
}

/// Number of the sample of a side at a time.
fn same_time(plan: &Plan, side: usize, axes: [Axis; 2], at: u64) -> Result<u64> {
    let [Axis::Time(tick), Axis::Time(coarse)] = axes else { return Ok(0) };
    let mut samples = plan.samples(side)?;
    while let Some(sample) = samples.next()? {
        let now = tick.convert(sample.at, coarse);
        if now == at {
            return Ok(sample.index);
        }
        if now > at {
            break;
        }
    }
    let expected = "no edge of the clock is at the time of the other side's first; give --align";
    Err(Input::new(&plan.sources[side].name, expected).into())
}
