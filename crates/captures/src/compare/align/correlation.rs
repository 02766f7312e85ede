//! Alignment for best agreement, over all offsets at once by Fourier transforms.

mod matcher;

use vcd::Value;

use tofsim::error::{Input, Result};

use crate::source::SourceState;

use super::super::pair::Pair;
use super::super::plan::Plan;
use super::super::samples::Sample;
use super::super::selection::{Piece, Selected};
use super::alignment::Alignment;
use super::survey::survey;
use crate::words::{Bits, listed};
pub(super) use matcher::{Candidate, KEPT};
use matcher::{Matcher, Rows};

/// Longest sequence that is searched for [samples].
const LONGEST: u64 = 1 << 17;
/// Largest number of bits per sample that are correlated.
const BITS: usize = 256;
/// Number of candidates that an error lists.
const LISTED: usize = 4;

/// Concatenated bits of some pairs.
pub(super) struct PairBits<'a> {
    pairs: Vec<&'a Pair>,
    pub(super) width: usize,
    scratch: Bits,
}

impl<'a> PairBits<'a> {
    pub(super) fn new(plan: &'a Plan, signals: &[String]) -> Result<Self> {
        let matching = &plan.matching;
        let named = |signal: &String| Ok(&matching.pairs[matching.pair(signal)?]);
        let pairs: Vec<&Pair> = match signals {
            [] => matching.pairs.iter().filter(|pair| !pair.is_event).collect(),
            _ => signals.iter().map(named).collect::<Result<_>>()?,
        };
        let width = pairs.iter().map(|pair| pair.width as usize).sum();
        Ok(PairBits { pairs, width: BITS.min(width), scratch: Bits::default() })
    }

    pub(super) fn row(&mut self, side: usize, state: &SourceState) -> Vec<i8> {
        let mut row = Vec::with_capacity(self.width);
        for pair in &self.pairs {
            pair.gather(side, state, &mut self.scratch);
            row.extend((0..pair.width).map(|bit| match self.scratch.level(bit) {
                Value::V0 => -1,
                Value::V1 => 1,
                _ => 0,
            }));
            if row.len() >= self.width {
                break;
            }
        }
        row.truncate(self.width);
        row
    }

    /// Reads the rest of a piece, up to the longest sequence that is searched.
    pub(super) fn rows(&mut self, side: usize, selected: &mut Selected) -> Result<Rows> {
        let mut rows = Rows::new();
        while (rows.len() as u64) < LONGEST
            && let Some(place) = selected.next()?
            && !place.sample.is_extended
        {
            rows.push(self.row(side, &selected.samples.state));
        }
        Ok(rows)
    }
}

/// Parameters of a search.
pub(super) struct Search {
    /// Side with the shorter sequence.
    pub(super) side: usize,
    /// Sequence to search for.
    pub(super) piece: Piece,
    /// Whether the sequence may overlap the start and end of the other side by half of its length.
    pub(super) overhangs: bool,
    /// First sample of the other side to search.
    pub(super) from: u64,
}

/// Returns the best offsets, best first.
pub(super) fn search(plan: &Plan, signals: &[String], search: &Search) -> Result<Vec<Candidate>> {
    let mut probe = PairBits::new(plan, signals)?;
    let template = template(plan, search, &mut probe)?;
    let length = template.len();
    let hang = if search.overhangs { length / 2 } else { 0 };
    let mut matcher = Matcher::new(template, probe.width);
    let unknown = vec![0; probe.width];
    let mut chunk = vec![unknown.clone(); hang];
    let other = 1 - search.side;
    let mut samples = plan.samples(other)?;
    let mut base = -(hang as i64);
    let mut best = Vec::new();
    let mut taken = 0u64;
    let mut first = None;
    let mut goes_on = true;
    let mut end = SearchEnd::new(plan, other, length)?;
    while goes_on {
        match samples.next()?.filter(|&sample| !sample.is_extended && end.takes(sample)) {
            Some(sample) if sample.index < search.from || !plan.is_looked_at(other, sample) => {}
            Some(sample) => {
                first.get_or_insert(sample.index);
                taken += 1;
                chunk.push(probe.row(other, &samples.state));
            }
            None if end.is_reached() => goes_on = false,
            None => {
                chunk.resize(chunk.len() + hang, unknown.clone());
                goes_on = false;
            }
        }
        while chunk.len() >= if goes_on { matcher.size } else { length } {
            matcher.scan(&chunk, base, &mut best);
            let step = (matcher.size - length + 1).min(chunk.len());
            chunk.drain(..step);
            base += step as i64;
        }
    }
    let (first, width) = (first.unwrap_or(0) as i64, probe.width as u64);
    for candidate in &mut best {
        let begin = candidate.offset.max(0);
        let end = (candidate.offset + length as i64).min(taken as i64);
        candidate.compared = (end - begin).max(0) as u64 * width;
        let outside = length as u64 * width - candidate.compared;
        candidate.differing = candidate.differing.saturating_sub(outside / 2);
        candidate.offset += first;
    }
    best.sort_by(|a, b| a.rate().total_cmp(&b.rate()).then(b.compared.cmp(&a.compared)));
    Ok(best)
}

/// Reads the sequence to search for.
fn template(plan: &Plan, search: &Search, probe: &mut PairBits) -> Result<Rows> {
    let pieces = [search.piece.clone()];
    let mut selected = Selected::new(plan.samples(search.side)?, &pieces);
    let template = probe.rows(search.side, &mut selected)?;
    if template.len() < 2 {
        let expected = "expected at least two samples to align by";
        return Err(plan.fault(search.side, expected).into());
    }
    Ok(template)
}

/// End of the search on a side of unlimited length.
pub(crate) struct SearchEnd {
    /// Last place at which a match may begin.
    last: u64,
    /// Number of samples read after that place.
    left: usize,
}

impl SearchEnd {
    pub(crate) fn new(plan: &Plan, side: usize, length: usize) -> Result<Self> {
        Ok(SearchEnd { last: plan.sources[side].searched()?, left: length.saturating_sub(1) })
    }

    /// Returns whether a sample is still within the search.
    pub(crate) fn takes(&mut self, sample: Sample) -> bool {
        if sample.at <= self.last {
            return true;
        }
        let is_taken = self.left > 0;
        self.left = self.left.saturating_sub(1);
        is_taken
    }

    /// Returns whether the side continues after the search.
    fn is_reached(&self) -> bool {
        self.left == 0
    }
}

/// Returns the best candidate, if it is unique: the second must differ in more than twice as many bits.
///
/// # Errors
/// If there is none, or another is nearly as good.
pub(super) fn decide(
    candidates: &[Candidate],
    side: usize,
    what: &str,
) -> Result<(Candidate, String)> {
    let Some(best) = candidates.first() else {
        return Err(Input::new("--align", format!("{what}: one side is too short")).into());
    };
    let describe = |candidate: &Candidate| {
        let Candidate { differing, compared, .. } = candidate;
        let offset = candidate.later(side);
        format!("{offset} ({differing} of {compared} bits differ)")
    };
    let near: Vec<_> = candidates.iter().filter(|c| c.rate() <= 2.0 * best.rate()).collect();
    if near.len() > 1 {
        let near: Vec<_> = near.into_iter().map(describe).collect();
        let expected = format!(
            "ambiguous, {what} fits at several offsets: {}; align by trigger, an edge or an \
            offset, or by other signals",
            listed(&near, LISTED, " and more")
        );
        return Err(Input::new("--align", expected).into());
    }
    if best.rate() > 0.25 {
        let expected = format!("{what} fits nowhere; the best offset is {}", describe(best));
        return Err(Input::new("--align", expected).into());
    }
    let next = candidates.get(1).map(|next| format!("next best {}", describe(next)));
    let next = next.unwrap_or("no other is near".to_owned());
    Ok((*best, format!("correlation: offset {}; {next}", describe(best))))
}

/// Aligns both sides by one constant offset.
pub(super) fn alignment(plan: &Plan, signals: &[String]) -> Result<Alignment> {
    let (side, overhangs) = (plan.capture().unwrap_or(0), plan.capture().is_none());
    let (windows, longest, what) = if overhangs {
        (1, Some(LONGEST), "the first side")
    } else {
        (survey(plan.sources[side])?.windows.len(), None, "the capture")
    };
    if windows > 1 {
        let expected = format!(
            "the time between the {windows} windows is not known; align each alone (windows)"
        );
        return Err(Input::new("--align", expected).into());
    }
    let piece = Piece::Run(0, longest);
    let found = search(plan, signals, &Search { side, piece, overhangs, from: 0 })?;
    let (best, text) = decide(&found, side, what)?;
    Ok(Alignment::shifted(best.later(side), text))
}
