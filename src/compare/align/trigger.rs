//! Alignment by trigger: a capture's marks against another's, or against what a logic analyser of
//! the same set-up would store of the waveform.

use crate::error::{Input, Result};
use crate::ila::core::{Core, Kept};
use crate::ila::storing::Shape;

use super::super::plan::{Plan, level};
use super::super::selection::Piece;
use super::Alignment;
use super::survey::{Window, survey};

/// Brings the samples that triggered together.
pub(super) fn alignment(plan: &Plan, time_from: Option<&str>) -> Result<Alignment> {
    match (plan.capture(), plan.sources[0].is_capture()) {
        (Some(side), _) => one_capture(plan, side, time_from),
        (None, true) => captures(plan),
        (None, false) => {
            let first = [first(plan, 0)?, first(plan, 1)?];
            let offset = first[1] as i64 - first[0] as i64;
            let found = format!("triggers at samples {} and {}", first[0], first[1]);
            Ok(Alignment::shifted(offset, found))
        }
    }
}

fn triggered(plan: &Plan, side: usize) -> Result<Vec<(Window, u64)>> {
    let source = plan.sources[side];
    let windows = survey(source)?.windows;
    let triggered: Vec<_> =
        windows.iter().filter_map(|window| Some((*window, window.trigger?))).collect();
    if triggered.is_empty() {
        let expected = "no sample is marked as trigger; align by correlation or an offset";
        return Err(Input::new(&source.name, expected).into());
    }
    Ok(triggered)
}

fn captures(plan: &Plan) -> Result<Alignment> {
    let (a, b) = (triggered(plan, 0)?, triggered(plan, 1)?);
    let mut differences = Vec::new();
    if a.len() != b.len() {
        differences.push(format!("the first has {} windows, the second {}", a.len(), b.len()));
    }
    let mut pieces = [Vec::new(), Vec::new()];
    let mut offsets = Vec::new();
    for (k, (&(window_a, at_a), &(window_b, at_b))) in a.iter().zip(&b).enumerate() {
        let before = [at_a - window_a.first, at_b - window_b.first];
        let common = before[0].min(before[1]);
        if before[0] != before[1] {
            differences.push(format!(
                "window {k}: trigger at sample {} of the first, {} of the second",
                before[0], before[1]
            ));
        }
        if let (Some(a), Some(b)) = (window_a.count, window_b.count)
            && a != b
        {
            differences.push(format!("window {k}: {a} samples in the first, {b} in the second"));
        }
        for (side, window, at) in [(0, window_a, at_a), (1, window_b, at_b)] {
            let left = window.count.map(|count| count - (at - common - window.first));
            pieces[side].push(Piece::Run(at - common, left));
        }
        offsets.push(at_b as i64 - at_a as i64);
    }
    offsets.dedup();
    let offset = if let [offset] = offsets[..] { Some(offset) } else { None };
    let count = pieces[0].len();
    let windows = if count == 1 { "window" } else { "windows" };
    let found = format!("by the trigger of {count} {windows}");
    Ok(Alignment { pieces, found, offset, differences })
}

/// The pieces of a capture's side and the waveform's, in the order of the sides.
fn ordered(side: usize, capture: Vec<Piece>, waveform: Vec<Piece>) -> [Vec<Piece>; 2] {
    if side == 0 { [capture, waveform] } else { [waveform, capture] }
}

fn one_capture(plan: &Plan, side: usize, time_from: Option<&str>) -> Result<Alignment> {
    let windows = triggered(plan, side)?;
    let (first, at) = windows[0];
    if let Some(counter) = time_from {
        let at_waveform = self::first(plan, 1 - side)?;
        return by_counter(plan, counter, at, at_waveform as i64);
    }
    let depth = first.count.map_or(usize::MAX / 2, |count| count as usize);
    let shape = Shape { depth, windows: windows.len(), position: (at - first.first) as usize };
    let kept = stored(plan, 1 - side, shape)?;
    let capture = windows.iter().map(|(window, _)| Piece::Run(window.first, window.count));
    let waveform: Vec<Piece> = (kept.into_iter().zip(&windows))
        .map(|(kept, (window, _))| piece(kept).part(0, window.count.unwrap_or(u64::MAX)))
        .collect();
    let samples: Vec<String> = (waveform.iter().take(3))
        .filter_map(|piece| piece.sample(shape.position as u64))
        .map(|sample| sample.to_string())
        .collect();
    let more = if waveform.len() > 3 { ", ..." } else { "" };
    let found = format!("trigger at sample {}{more} of the waveform", samples.join(", "));
    let offset = match (&waveform[..], side) {
        ([Piece::Run(begin, _)], 0) => Some(*begin as i64 - first.first as i64),
        ([Piece::Run(begin, _)], _) => Some(first.first as i64 - *begin as i64),
        _ => None,
    };
    let pieces = ordered(side, capture.collect(), waveform);
    Ok(Alignment { pieces, found, offset, differences: Vec::new() })
}

fn piece(kept: Kept) -> Piece {
    match kept {
        Kept::Range(range) => Piece::Run(range.start, Some(range.end - range.start)),
        Kept::List(samples) => Piece::Kept(samples),
    }
}

fn no_condition(plan: &Plan, side: usize) -> Input {
    let expected = "expected a condition (--trigger, or in the map) that the waveform triggers on";
    Input::new(&plan.sources[side].name, expected)
}

fn never(plan: &Plan, side: usize, found: usize, windows: usize) -> Input {
    let expected = match found {
        0 => format!("the trigger never comes after {}", plan.after),
        _ => format!("the trigger comes {found} times after {}, not {windows} times", plan.after),
    };
    Input::new(&plan.sources[side].name, expected)
}

/// What a logic analyser would store of a waveform.
fn stored(plan: &Plan, side: usize, shape: Shape) -> Result<Vec<Kept>> {
    let mut trigger = plan.trigger[side].clone().ok_or_else(|| no_condition(plan, side))?;
    let mut qualifier = plan.qualifier[side].clone();
    let mut core = Core::numbers(shape, qualifier.is_some());
    let mut samples = plan.samples(side)?;
    let skipped = begin(plan, side)?;
    while let Some(sample) = samples.next()? {
        if sample.index < skipped {
            continue;
        }
        let value = |signal| level(samples.state(), signal);
        let triggers = trigger.sample(value);
        let qualifies = qualifier.as_mut().is_none_or(|qualifier| qualifier.sample(value));
        core.sample(&(), triggers, qualifies);
        if core.is_full() {
            break;
        }
    }
    let found = core.triggers().len();
    if found < shape.windows {
        return Err(never(plan, side, found, shape.windows).into());
    }
    let moved = |kept| match kept {
        Kept::Range(range) => Kept::Range(range.start + skipped..range.end + skipped),
        Kept::List(list) => Kept::List(list.into_iter().map(|sample| sample + skipped).collect()),
    };
    Ok(core.windows().into_iter().map(moved).collect())
}

/// The first sample that a logic analyser looks at.
fn begin(plan: &Plan, side: usize) -> Result<u64> {
    let mut samples = plan.samples(side)?;
    let mut first = 0;
    while let Some(sample) = samples.next()? {
        if plan.is_looked_at(side, sample) {
            break;
        }
        first = sample.index + 1;
    }
    Ok(first.saturating_sub(plan.stages))
}

/// The first sample of a waveform that triggers.
fn first(plan: &Plan, side: usize) -> Result<u64> {
    let shape = Shape { depth: 1, windows: 1, position: 0 };
    match stored(plan, side, shape)?.first() {
        Some(Kept::Range(range)) => Ok(range.start),
        Some(Kept::List(list)) => Ok(list[0]),
        None => Err(never(plan, side, 0, 1).into()),
    }
}

/// The samples of a capture that has a column that counts the clock, the first of them `offset`
/// samples after the waveform's.
pub(super) fn counted(plan: &Plan, counter: &str, offset: i64) -> Result<Alignment> {
    by_counter(plan, counter, 0, offset)
}

/// As the counter says, where sample `at` of the capture is sample `at_waveform` of the waveform.
fn by_counter(plan: &Plan, counter: &str, at: u64, at_waveform: i64) -> Result<Alignment> {
    let Some(side) = plan.capture() else {
        return Err(Input::new("--time-from", "expected one capture").into());
    };
    let source = plan.sources[side];
    let signal = super::super::find::signal(source, counter)?;
    let signal = &source.signals[signal];
    let fault = |expected: &str| Input::new(&source.name, expected).field(counter);
    if signal.width > 64 {
        return Err(fault("expected a counter of 64 bits at most").into());
    }
    let mut cursor = source.read(&[signal.id])?;
    let mask = u64::MAX >> (64 - signal.width);
    let (mut counts, mut last, mut total) = (Vec::new(), None, 0u64);
    while let Some(row) = cursor.peek()? {
        cursor.take(|_| ());
        if cursor.state.unknown(0)[0] != 0 {
            return Err(fault("is unknown").at(row as usize + 1, 1).into());
        }
        let now = cursor.state.value(0)[0];
        if let Some(last) = last {
            let step = now.wrapping_sub(last) & mask;
            if step == 0 {
                let expected =
                    format!("stands still at sample {row}, so it does not count a clock");
                return Err(fault(&expected).into());
            }
            total = total.saturating_add(step);
        }
        last = Some(now);
        counts.push(total);
    }
    let Some(&base) = counts.get(at as usize) else { return Err(fault("has no sample").into()) };
    let place = |count: u64| at_waveform + (count as i64 - base as i64);
    let before = counts.iter().take_while(|&&count| place(count) < 0).count();
    let samples = counts[before..].iter().map(|&count| place(count) as u64).collect();
    let own = Piece::Run(before as u64, Some((counts.len() - before) as u64));
    let pieces = ordered(side, vec![own], vec![Piece::Kept(samples)]);
    let found = format!("sample {at} of the capture at {at_waveform}, the others by {counter}");
    Ok(Alignment { pieces, found, offset: None, differences: Vec::new() })
}
