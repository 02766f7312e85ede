//! Alignment of each window separately for best agreement, for all windows in one pass over the waveform.
//!
//! Sections of the windows are searched for in the waveform by their hashes; at each hit, the whole window is
//! compared. A window that differs in so many samples that none of its sections may be intact is compared at all
//! positions, in a second pass.

mod recent;
mod template;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use tofsim::error::{Input, Result};

use super::super::parts::ordered;
use super::super::plan::Plan;
use super::super::selection::{Piece, Selected};
use super::alignment::Alignment;
use super::correlation::{KEPT, PairBits, Search, decide, search};
use super::survey::survey;
use recent::{hash, pass, power};
use template::{Template, packed};

/// Number of windows that are listed individually.
const LISTED: usize = 8;

/// Determines an offset for each window, in order of time.
pub(super) fn alignment(plan: &Plan, signals: &[String]) -> Result<Alignment> {
    let Some(side) = plan.capture() else {
        let expected = "windows: expected a capture on one side and a waveform on the other";
        return Err(Input::new("--align", expected).into());
    };
    let windows = survey(plan.sources[side])?.windows;
    let capture: Vec<Piece> =
        windows.iter().map(|window| Piece::Run(window.first, window.count)).collect();
    let mut bits = PairBits::new(plan, signals)?;
    let mut templates = templates(plan, side, &capture, &mut bits)?;
    lay_over_seeds(plan, 1 - side, &mut templates, &mut bits)?;
    lay_over_all(plan, 1 - side, &mut templates, &mut bits)?;
    let (mut found, mut waveform, mut from) = (Vec::new(), Vec::new(), 0);
    for (k, (template, window)) in templates.iter().zip(&windows).enumerate() {
        let candidates = match template.candidates(from, bits.width) {
            Some(candidates) => candidates,
            None => {
                let piece = Piece::Run(window.first, window.count);
                search(plan, signals, &Search { side, piece, overhangs: false, from })?
            }
        };
        let (best, text) = decide(&candidates, side, &format!("window {k}"))?;
        found.push(format!("window {k}: {text}"));
        let begin = best.offset.unsigned_abs();
        from = begin + window.count.unwrap_or(1);
        waveform.push(Piece::Run(begin, window.count));
    }
    if found.len() > LISTED {
        let more = found.split_off(LISTED - 1).len();
        found.push(format!("... and {more} more windows"));
    }
    let pieces = ordered(side, capture, waveform);
    Ok(Alignment { pieces, found: found.join("\n"), ..Alignment::default() })
}

fn templates(
    plan: &Plan,
    side: usize,
    windows: &[Piece],
    bits: &mut PairBits,
) -> Result<Vec<Template>> {
    let mut selected = Selected::new(plan.samples(side)?, windows);
    let stride = 2 * bits.width.div_ceil(64);
    let mut templates = Vec::new();
    loop {
        let rows = bits.rows(side, &mut selected)?;
        if rows.len() < 2 {
            let expected = "expected at least two samples of each window to align by";
            return Err(plan.fault(side, expected).into());
        }
        let rows = rows.iter().flat_map(|row| packed(row)).collect();
        templates.push(Template::new(rows, stride));
        if !selected.next_piece() {
            return Ok(templates);
        }
    }
}

fn longest(templates: &[Template]) -> usize {
    templates.iter().map(Template::length).max().unwrap_or(0)
}

/// For each hash, the windows with such a section, and the number of samples after it.
type Seeds = HashMap<u64, Vec<(usize, usize)>>;

/// Compares each window at the positions where one of its sections occurs.
fn lay_over_seeds(
    plan: &Plan,
    side: usize,
    templates: &mut [Template],
    bits: &mut PairBits,
) -> Result<()> {
    let stride = 2 * bits.width.div_ceil(64);
    let mut by_length: BTreeMap<usize, Seeds> = BTreeMap::new();
    for (k, template) in templates.iter_mut().enumerate() {
        for (rows, behind) in template.seeds() {
            let seeds = by_length.entry(rows.len() / stride).or_default();
            seeds.entry(hash(rows, stride)).or_default().push((k, behind));
        }
    }
    let by_length: Vec<(usize, u64, Seeds)> =
        by_length.into_iter().map(|(length, seeds)| (length, power(length), seeds)).collect();
    // Windows that are to be laid over once their last sample is there.
    let mut waiting: BTreeSet<(u64, usize)> = BTreeSet::new();
    pass(plan, side, bits, longest(templates), |recent| {
        for (length, power, seeds) in &by_length {
            let found = recent.hash(*length, *power).and_then(|hash| seeds.get(&hash));
            waiting.extend(
                found.into_iter().flatten().map(|&(k, behind)| (recent.last() + behind as u64, k)),
            );
        }
        while let Some(&(end, k)) = waiting.first().filter(|(end, _)| *end <= recent.last()) {
            waiting.pop_first();
            let length = templates[k].length();
            if let Some(first) = recent.first_of(end, length) {
                templates[k].lay_over(recent.samples(first, length), first);
            }
        }
    })
}

/// Compares the windows without a unique best position at all positions.
fn lay_over_all(
    plan: &Plan,
    side: usize,
    templates: &mut [Template],
    bits: &mut PairBits,
) -> Result<()> {
    let longest = longest(templates);
    let width = bits.width;
    let unclear = |template: &&mut Template| template.candidates(0, width).is_none();
    let mut templates: Vec<&mut Template> = templates.iter_mut().filter(unclear).collect();
    if templates.is_empty() {
        return Ok(());
    }
    templates.iter_mut().for_each(|template| template.begin_anew());
    pass(plan, side, bits, longest, |recent| {
        for template in &mut templates {
            let length = template.length();
            // Nothing moves where all samples are alike: the first KEPT places say it all.
            if recent.steady < length + KEPT
                && let Some(first) = recent.first_of(recent.last(), length)
            {
                template.lay_over(recent.samples(first, length), first);
            }
        }
    })
}
