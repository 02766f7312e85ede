//! Alignment by trigger: the marks of a capture with those of another, or with the samples that a logic analyser of
//! the same setup would store of the waveform.

use tofsim::error::{Input, Result};

use crate::ila::Capture;
use crate::ila::core::{Core, Shape};
use crate::words::listed;

use super::super::find;
use super::super::operands::SideCondition;
use super::super::parts::ordered;
use super::super::plan::Plan;
use super::super::result::Described;
use super::super::samples::Sample;
use super::super::selection::Piece;
use super::alignment::Alignment;
use super::edge::first_looked_at;
use super::survey::{Survey, counts_differ, survey, triggers_differ, windows_differ};

/// Number of windows whose first sample is listed.
const LISTED: usize = 3;

/// Aligns the samples that triggered.
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

/// Returns the structure of a capture, restricted to windows that triggered, and the samples that did.
fn triggered(plan: &Plan, side: usize) -> Result<(Survey, Vec<u64>)> {
    let source = plan.sources[side];
    let mut survey = survey(source)?;
    survey.windows.retain(|window| window.trigger.is_some());
    let triggers: Vec<u64> = survey.windows.iter().filter_map(|window| window.trigger).collect();
    if triggers.is_empty() {
        let expected = "no sample is marked as trigger; align by correlation or an offset";
        return Err(Input::new(&source.name, expected).into());
    }
    Ok((survey, triggers))
}

fn captures(plan: &Plan) -> Result<Alignment> {
    let ((a, triggers_a), (b, triggers_b)) = (triggered(plan, 0)?, triggered(plan, 1)?);
    let mut differences = Vec::from_iter(windows_differ(a.windows.len(), b.windows.len()));
    let mut pieces = [Vec::new(), Vec::new()];
    let mut offsets = Vec::new();
    let windows = a.windows.into_iter().zip(b.windows);
    let triggers = triggers_a.into_iter().zip(triggers_b);
    for (k, ((window_a, window_b), (at_a, at_b))) in windows.zip(triggers).enumerate() {
        let common = (at_a - window_a.first).min(at_b - window_b.first);
        differences.extend(triggers_differ(k, &window_a, &window_b));
        differences.extend(counts_differ(k, &window_a, &window_b));
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
    Ok(Alignment { pieces, found, offset, differences, doubts: Vec::new() })
}

fn one_capture(plan: &Plan, side: usize, time_from: Option<&str>) -> Result<Alignment> {
    let (Survey { windows, last, .. }, triggers) = triggered(plan, side)?;
    let (first, at) = (windows[0], triggers[0]);
    if let Some(counter) = time_from {
        let at_waveform = self::first(plan, 1 - side)?;
        return by_counter(plan, counter, at, at_waveform as i64);
    }
    let depth = first.count.or(last.map(|last| last + 1)).unwrap_or(1) as usize;
    let shape = Shape { depth, windows: windows.len(), position: (at - first.first) as usize };
    let (mut capture, mut waveform) = (Vec::new(), Vec::new());
    let Stored { pieces, early } = stored(plan, 1 - side, shape)?;
    for (window, (piece, lead)) in windows.iter().zip(pieces) {
        let count = window.count.map(|count| count.saturating_sub(lead));
        capture.push(Piece::Run(window.first + lead, count));
        waveform.push(piece.part(0, count.unwrap_or(u64::MAX)));
    }
    let samples = waveform.iter().filter_map(|piece| Some(piece.sample(0)?.to_string()));
    let samples = listed(&samples.collect::<Vec<_>>(), LISTED, ", ...");
    let found = format!("by the trigger; from sample {samples} of the waveform");
    let offset = match (&waveform[..], &capture[..]) {
        ([Piece::Run(waveform, _)], [Piece::Run(capture, _)]) => {
            let later = *waveform as i64 - *capture as i64;
            Some(if side == 0 { later } else { -later })
        }
        _ => None,
    };
    let pieces = ordered(side, capture, waveform);
    let doubts = Vec::from_iter(early);
    Ok(Alignment { pieces, found, offset, doubts, ..Alignment::default() })
}

fn never(plan: &Plan, side: usize, last: Option<Sample>, found: usize, windows: usize) -> String {
    let after = plan.terms.after;
    let end = last.map(|last| format!(" (it ends at {})", describe(plan, side, last)));
    let end = end.unwrap_or_default();
    match found {
        0 => format!("the trigger never comes after {after}{end}"),
        _ => format!("the trigger comes {found} times after {after}, not {windows} times{end}"),
    }
}

fn describe(plan: &Plan, side: usize, sample: Sample) -> String {
    Described::new(plan.sources[side]).place(sample.at)
}

/// Samples that a logic analyser would store of a waveform.
struct Stored {
    /// Samples of each window, and the number of its samples before the waveform's first.
    pieces: Vec<(Piece, u64)>,
    /// Remark that a trigger came too early to count.
    early: Option<String>,
}

/// Determines the samples that a logic analyser of this shape would store of a waveform.
fn stored(plan: &Plan, side: usize, shape: Shape) -> Result<Stored> {
    let Some(mut trigger) = plan.trigger[side].clone() else {
        let expected =
            "expected a condition (--trigger, or in the map) that the waveform triggers on";
        return Err(plan.fault(side, expected).into());
    };
    let mut qualifier = plan.qualifier[side].clone();
    let first = first_looked_at(plan, side)?.map_or(u64::MAX, |sample| sample.index);
    let stages = plan.terms.stages;
    let (skipped, missing) = (first.saturating_sub(stages), stages.saturating_sub(first));
    let mut core = Core::new(shape, 1);
    for number in 0..missing {
        let qualifies = qualifier.as_mut().is_none_or(SideCondition::sample_nothing);
        core.sample(&[number], trigger.sample_nothing(), qualifies);
    }
    let mut samples = plan.samples(side)?;
    let (mut last, mut early, mut lost) = (None, None, None);
    while !core.is_full()
        && let Some(sample) = samples.next()?
    {
        last = Some(sample);
        if sample.index < skipped {
            continue;
        }
        let triggers = trigger.sample(&samples.state);
        if core.triggers().is_empty() {
            if !triggers {
                lost = lost.or(early);
            } else if core.is_filling() {
                early = early.or(Some(sample));
            }
        }
        let qualifies = qualifier.as_mut().is_none_or(|term| term.sample(&samples.state));
        core.sample(&[sample.index - skipped + missing], triggers, qualifies);
    }
    let capture = core.finish(Vec::new());
    let found = capture.triggers.len();
    let early = lost.or(early.filter(|_| found == 0)).map(|sample| {
        let (position, before) = (shape.position, sample.index - skipped + missing);
        format!(
            "the window would begin too early: the trigger at sample {} ({}) does not count, \
             because the capture has {position} samples before its trigger, and there are {before}",
            sample.index,
            describe(plan, side, sample),
        )
    });
    if found < shape.windows {
        let never = never(plan, side, last, found, shape.windows);
        let expected = early.map_or(never.clone(), |early| format!("{never}; {early}"));
        return Err(plan.fault(side, expected).into());
    }
    let pieces = stored_pieces(&capture, skipped, missing, qualifier.is_some());
    Ok(Stored { pieces, early })
}

/// Returns the samples of each window, and the number of its samples before the waveform's first. The words of
/// `capture` number the samples, of which `missing` precede the waveform and `skipped` were left out at its start.
fn stored_pieces(
    capture: &Capture,
    skipped: u64,
    missing: u64,
    is_qualified: bool,
) -> Vec<(Piece, u64)> {
    let ends = capture.windows.iter().skip(1).copied().chain([capture.samples()]);
    let windows = capture.windows.iter().zip(ends).map(|(&begin, end)| {
        let numbers = &capture.words[begin..end];
        let lead = numbers.partition_point(|&number| number < missing);
        let kept = numbers[lead..].iter().map(|number| number - missing + skipped);
        let piece = match kept.clone().next() {
            Some(first) if !is_qualified => Piece::Run(first, Some(kept.len() as u64)),
            _ => Piece::Kept(kept.collect()),
        };
        (piece, lead as u64)
    });
    windows.collect()
}

/// Returns the first sample of a waveform that triggers.
fn first(plan: &Plan, side: usize) -> Result<u64> {
    let shape = Shape { depth: 1, windows: 1, position: 0 };
    let stored = stored(plan, side, shape)?;
    let first = stored.pieces.first().and_then(|(piece, _)| piece.sample(0));
    let never = || plan.fault(side, never(plan, side, None, 0, 1));
    first.ok_or_else(|| never().into())
}

/// Aligns a capture with a column that counts clock cycles, given that its sample `at` is the waveform's sample
/// `at_waveform`.
pub(super) fn by_counter(
    plan: &Plan,
    counter: &str,
    at: u64,
    at_waveform: i64,
) -> Result<Alignment> {
    let Some(side) = plan.capture() else {
        return Err(Input::new("--time-from", "expected one capture").into());
    };
    let source = plan.sources[side];
    let signal = find::signal(source, counter)?;
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
                    format!("does not change at sample {row}, so it does not count a clock");
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
    Ok(Alignment { pieces, found, ..Alignment::default() })
}
