//! Comparison of words on one side with bits on the other, and of enumerations whose values differ. The values of the
//! words come from the map, or else from the side with the bits. If both sides have words, these are compared directly;
//! if both have bits with names, those of the second side become the first's values of the same names.

use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

use tofsim::error::Result;

use crate::choice::SignalChoice;
use crate::source::{Name, Signal, SignalKind, Source, Translation, WordValues};

use crate::ila::read::{MOST_STATES, NamedValue, word};
use crate::words::listed;

use super::map::SignalMap;
use super::matching::{Matching, matching};
use super::pair::Pair;

/// Number of names listed in a note.
const LISTED: usize = 6;
/// Words for the values of one bit.
const BOOLEANS: [(&str, u64); 4] = [("false", 0), ("true", 1), ("FALSE", 0), ("TRUE", 1)];

/// Sources whose words have been replaced by bits, with notes.
#[derive(Debug, Default)]
pub(super) struct Resolved {
    pub(super) sources: Option<[Source; 2]>,
    /// Ids of the signals of each side that had words.
    words: [BTreeSet<usize>; 2],
    pub(super) notes: Vec<String>,
}

/// Finds the pairs of words and bits, and replaces the words by bits.
///
/// # Errors
/// If the map names a signal that does not exist, or a pattern is invalid.
pub(super) fn resolve(
    sides: [&Source; 2],
    map: &SignalMap,
    choice: &SignalChoice,
) -> Result<Resolved> {
    let mut resolved = Resolved::default();
    let has = |side: &&Source, is_it: fn(&Signal) -> bool| side.signals.iter().any(is_it);
    if !sides.iter().any(|side| has(side, is_text)) && !sides.iter().all(|side| has(side, is_named))
    {
        return Ok(resolved);
    }
    let bare = sides.map(as_bits);
    let known = sides.map(by_ids);
    let found = matching([&bare[0], &bare[1]], map, choice, fits_by_name)?;
    let mut sources = sides.map(Source::clone);
    let mut translations: [HashMap<usize, Translation>; 2] = Default::default();
    // What a capture says of its words is of the samples that it has.
    let are_types = !sides.iter().any(|side| side.is_capture());
    // A signal of several pairs has the same values in all of them.
    let mut uses: HashMap<usize, usize> = HashMap::new();
    let of_pairs = found.pairs.iter().flat_map(|pair| ids(&found, pair, 1));
    of_pairs.for_each(|id| *uses.entry(id).or_default() += 1);
    for pair in &found.pairs {
        let ids = [0, 1].map(|side| ids(&found, pair, side));
        let texts = [0, 1].map(|side| text(&known[side], &ids[side]));
        let (side, signal) = match texts {
            [Some(signal), None] => (0, signal),
            [None, Some(signal)] => (1, signal),
            [None, None] => {
                let whole = |side: usize| match &ids[side][..] {
                    [id] if pair.sides[side][0].whole => known[side].get(id).copied(),
                    _ => None,
                };
                if let [Some(a), Some(b)] = [whole(0), whole(1)]
                    && are_types
                    && uses[&b.id] == 1
                    && !pair.invert
                    && let Some(codes) = codes(a, b)
                {
                    translations[1].insert(b.id, Translation::Codes(a.width, codes));
                }
                continue;
            }
            _ => continue,
        };
        let other = ids[1 - side].first().and_then(|id| known[1 - side].get(id).copied());
        let width = match signal.words.width {
            0 => other.map_or(0, |other| other.width),
            width => width,
        };
        let states = states(pair, map, other, width);
        let names = names(sides[side], signal)?;
        let missing = names.iter().map(String::as_str).filter(|name| !states.contains_key(*name));
        let missing: Vec<&str> = missing.collect();
        let is_known = missing.len() < names.len() || signal.words.mixed;
        let is_whole = pair.sides.iter().all(|parts| parts.len() == 1 && parts[0].whole);
        if is_known && is_whole {
            let radix = signal.radix;
            resolved.words[side].insert(signal.id);
            let words = WordValues { width, radix, states };
            translations[side].insert(signal.id, Translation::Words(words));
        } else {
            for side in 0..2 {
                let is_it = |signal: &&mut Signal| ids[side].contains(&signal.id);
                sources[side].signals.iter_mut().filter(is_it).for_each(leave_out);
            }
        }
        if !missing.is_empty() {
            resolved.notes.push(note(&pair.name, side, is_known, &missing));
        }
    }
    let [a, b] = sources;
    let [of_a, of_b] = translations;
    resolved.sources = Some([a.translated(of_a), b.translated(of_b)]);
    Ok(resolved)
}

impl Resolved {
    /// Marks the pairs of which a side has words.
    pub(super) fn mark(&self, matching: &mut Matching) {
        let Matching { pairs, slots, .. } = matching;
        for pair in pairs {
            pair.has_words = (0..2).any(|side| {
                let mut parts = pair.sides[side].iter();
                parts.any(|part| self.words[side].contains(&slots[side].ids[part.signal]))
            });
        }
    }
}

fn is_text(signal: &Signal) -> bool {
    signal.kind == SignalKind::Text
}

fn is_named(signal: &Signal) -> bool {
    signal.kind == SignalKind::Bits && !signal.words.states.is_empty()
}

/// Returns whether the values of two signals can be compared, those of enumerations by name.
fn fits_by_name(a: &Signal, b: &Signal) -> bool {
    a.fits(b) || (is_named(a) && is_named(b))
}

/// Returns the first signal's value for each value of the second with the same name, if both have such names and
/// some of these values differ.
fn codes(a: &Signal, b: &Signal) -> Option<HashMap<u64, u64>> {
    if !is_named(a)
        || !is_named(b)
        || (Arc::ptr_eq(&a.words.states, &b.words.states) && a.width == b.width)
    {
        return None;
    }
    let states = a.words.states.iter();
    let exact: HashMap<&str, u64> =
        states.filter_map(|state| Some((state.name.as_str(), state.bits?))).collect();
    let [folded_a, folded_b] = [a, b].map(|signal| folded(&signal.words.states));
    let by_fold = |name: &str| {
        let name = name.to_lowercase();
        folded_b.get(&name).copied().flatten()?;
        folded_a.get(&name).copied().flatten()
    };
    let value = |name: &str| exact.get(name).copied().or_else(|| by_fold(name));
    let codes = b.words.states.iter();
    let codes: HashMap<u64, u64> =
        codes.filter_map(|state| Some((state.bits?, value(&state.name)?))).collect();
    let differs = a.width != b.width || codes.iter().any(|(b, a)| a != b);
    (differs && !codes.is_empty()).then_some(codes)
}

/// Returns values by their names in lower case, as VHDL and Verilog have them in common; none for a name that several
/// share. VHDL tells 'Z' from 'z', and \Run\ from \run\.
fn folded(states: &[NamedValue]) -> HashMap<String, Option<u64>> {
    let mut folded = HashMap::new();
    for state in states.iter().filter(|state| !state.name.starts_with(['\'', '\\'])) {
        let name = folded.entry(state.name.to_lowercase());
        name.and_modify(|bits| *bits = None).or_insert(state.bits);
    }
    folded
}

fn leave_out(signal: &mut Signal) {
    signal.kind = SignalKind::Other;
}

/// Returns the source as if its words were already bits, to match its signals.
fn as_bits(source: &Source) -> Source {
    let mut source = source.clone();
    for signal in source.signals.iter_mut() {
        if is_text(signal) {
            (signal.kind, signal.width) = (SignalKind::Bits, signal.words.width);
        }
    }
    source
}

/// Returns the ids of a side's signals in a pair.
fn ids(matching: &Matching, pair: &Pair, side: usize) -> Vec<usize> {
    pair.sides[side].iter().map(|part| matching.slots[side].ids[part.signal]).collect()
}

/// Returns the first name of each signal by its id.
fn by_ids(source: &Source) -> HashMap<usize, &Signal> {
    source.signals.iter().rev().map(|signal| (signal.id, signal)).collect()
}

/// Returns the first of some signals that has words.
fn text<'a>(known: &HashMap<usize, &'a Signal>, ids: &[usize]) -> Option<&'a Signal> {
    ids.iter().filter_map(|id| known.get(id).copied()).find(|signal| is_text(signal))
}

/// Returns the words of a signal; those of a waveform are read.
fn names(source: &Source, signal: &Signal) -> Result<Vec<String>> {
    if source.is_capture() {
        return Ok(signal.words.states.iter().map(|state| state.name.clone()).collect());
    }
    let (mut cursor, mut names) = (source.read(&[signal.id])?, Vec::new());
    while cursor.peek()?.is_some() && names.len() < MOST_STATES {
        cursor.take(|_| ());
        let name = word(cursor.state.value(0));
        if !names.contains(&name) {
            names.push(name);
        }
    }
    Ok(names)
}

/// Returns the values of a pair's words: those of the map, or else those that the side with the bits states. The words
/// of a single bit are VHDL's booleans.
fn states(pair: &Pair, map: &SignalMap, bits: Option<&Signal>, width: u32) -> HashMap<String, u64> {
    let learned = bits.iter().flat_map(|signal| signal.words.states.iter());
    let learned = learned.filter_map(|state| Some((state.name.clone(), state.bits?)));
    let booleans = BOOLEANS.map(|(name, bits)| (name.to_owned(), bits));
    let booleans = booleans.into_iter().filter(|_| width == 1);
    let called = |name: &String| {
        let wanted = Name::new(name.clone());
        let is_it = |own: &String| Name::new(own.clone()).common(&wanted) == Some(wanted.depth());
        is_it(&pair.name) || is_it(&pair.other)
    };
    let rules = map.signal.iter().filter(|rule| rule.a.iter().chain(&rule.b).any(called));
    let configured =
        rules.flat_map(|rule| rule.states.iter().map(|(name, bits)| (name.clone(), *bits)));
    let fits = |(_, bits): &(String, u64)| width >= 64 || bits >> width == 0;
    booleans.chain(learned).chain(configured).filter(fits).collect()
}

/// Formats a note on words whose values are unknown.
fn note(name: &str, side: usize, is_known: bool, missing: &[&str]) -> String {
    let list: Vec<_> = missing.iter().map(|name| format!("`{name}`")).collect();
    let more = format!(" and {} more", missing.len().saturating_sub(LISTED));
    let first = if missing[0].bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_') {
        missing[0].to_owned()
    } else {
        format!("{:?}", missing[0])
    };
    let [own, other] = if side == 0 { ["first", "second"] } else { ["second", "first"] };
    let what = if is_known { "where the words are" } else { "because its words are" };
    format!(
        "{name} is not compared {what} {}: the {own} side has words, the {other} bits; a map \
         says what they stand for: [[signal]] a = [{name:?}], states = {{ {first} = 0 }}",
        listed(&list, LISTED, &more),
    )
}
