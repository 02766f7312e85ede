//! Sequence of the words that a side accepts.

use std::collections::HashMap;
use std::ops::Range;

use tofsim::error::Result;

use crate::words::Bits;

use super::super::align::SearchEnd;
use super::super::operands::SideCondition;
use super::super::pair::Pair;
use super::super::plan::Plan;
use super::super::result::BeatPlace;
use super::super::samples::Samples;

/// Largest number of beats of a side.
const MOST_BEATS: usize = 1 << 22;

/// Beats of a side.
#[derive(Debug, Default)]
pub(super) struct Stream {
    pub(super) beats: Vec<BeatPlace>,
    /// Number of each beat's word in [`BeatWords`].
    pub(super) words: Vec<u32>,
    /// Beats of each window.
    pub(super) windows: Vec<Range<usize>>,
    /// Number of samples read.
    pub(super) samples: usize,
}

/// Distinct words of both sides.
#[derive(Debug, Default)]
pub(super) struct BeatWords {
    numbers: HashMap<Box<[u64]>, u32>,
    texts: Vec<String>,
}

impl BeatWords {
    /// Returns the number of a side's present word, in the first side's form.
    fn number(&mut self, pairs: &[&Pair], side: usize, samples: &Samples) -> u32 {
        let mut key = Vec::new();
        let mut bits = Bits::default();
        for pair in pairs {
            pair.gather(side, &samples.state, &mut bits);
            pair.mask(&mut bits);
            key.extend_from_slice(&bits.value);
            key.extend_from_slice(&bits.unknown);
        }
        let next = self.texts.len() as u32;
        let number = *self.numbers.entry(key.into()).or_insert(next);
        if number == next {
            self.texts.push(text(pairs, side, samples));
        }
        number
    }

    /// Returns a word as text.
    pub(super) fn text(&self, number: u32) -> &str {
        &self.texts[number as usize]
    }
}

/// Formats the values of a word, with names if there are several signals.
fn text(pairs: &[&Pair], side: usize, samples: &Samples) -> String {
    let mut bits = Bits::default();
    let values = pairs.iter().map(|pair| {
        pair.gather(side, &samples.state, &mut bits);
        let value = pair.text(&bits);
        let last = pair.name.rsplit(['.', '/']).next().unwrap_or(&pair.name);
        if pairs.len() == 1 { value } else { format!("{last}={value}") }
    });
    values.collect::<Vec<_>>().join(" ")
}

/// Reads all beats of a side. From a side of unlimited length, it reads `count` samples beyond its first part.
///
/// # Errors
/// If the side cannot be read or has too many beats.
pub(super) fn stream(
    plan: &Plan,
    side: usize,
    condition: &SideCondition,
    pairs: &[&Pair],
    words: &mut BeatWords,
    more: usize,
) -> Result<Stream> {
    let mut stream = Stream::default();
    let mut holds = condition.clone();
    let mut samples = plan.samples(side)?;
    let mut end = SearchEnd::new(plan, side, more)?;
    while let Some(sample) = samples.next()?
        && !sample.is_extended
        && plan.is_reached(side, sample) != Some(true)
        && end.takes(sample)
    {
        let count = stream.beats.len();
        if sample.marks.window || stream.windows.is_empty() {
            stream.windows.push(count..count);
            holds = condition.clone();
        }
        stream.samples += 1;
        let is_beat = holds.sample(&samples.state);
        if !is_beat || sample.marks.gap || !plan.is_looked_at(side, sample) {
            continue;
        }
        if count == MOST_BEATS {
            let expected = format!("has more than {MOST_BEATS} beats; take part of it (--until)");
            return Err(plan.fault(side, expected).into());
        }
        let place = BeatPlace { beat: count as u64, sample: sample.index, at: sample.at };
        stream.beats.push(place);
        stream.words.push(words.number(pairs, side, &samples));
        if let Some(window) = stream.windows.last_mut() {
            window.end = count + 1;
        }
    }
    Ok(stream)
}
