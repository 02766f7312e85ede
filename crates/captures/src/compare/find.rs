//! Lookup of a signal by a user's name for it.

use tofsim::error::{Input, Result, nearest};

use crate::condition::slice;
use crate::source::{Name, Signal, SignalKind, Source};
use crate::words::listed;

use super::parts::{Part, Slots};

/// Number of names suggested in an error.
const OFFERED: usize = 4;

/// Returns the index of the signal whose name is or ends with `text`; the one nearest to the top if there are
/// several.
///
/// # Errors
/// If there is none, or several at the same level that are different signals.
pub(super) fn signal(source: &Source, text: &str) -> Result<usize> {
    let wanted = Name::new(text);
    let rank = |signal: &Signal| {
        if signal.name.is(&wanted) {
            Some(0)
        } else {
            let is_end = signal.name.common(&wanted) == Some(wanted.depth());
            is_end.then(|| signal.name.depth() + 1)
        }
    };
    let called = source.called(wanted.last()).iter();
    let ranked: Vec<_> = called.filter_map(|&k| Some((rank(&source.signals[k])?, k))).collect();
    let best = ranked.iter().map(|(rank, _)| rank).min();
    let found: Vec<usize> =
        ranked.iter().filter(|(rank, _)| Some(rank) == best).map(|(_, k)| *k).collect();
    let id = |&k: &usize| source.signals[k].id;
    match found.first() {
        Some(&first) if found.iter().all(|k| id(k) == id(&first)) => Ok(first),
        Some(_) => {
            let names: Vec<_> =
                found.iter().map(|&k| source.signals[k].name.text.clone()).collect();
            let names = listed(&names, OFFERED, "");
            let expected = format!("several signals are called so: {names}");
            Err(Input::new(&source.name, expected).field(text).into())
        }
        None => {
            let names = source.signals.iter().map(|signal| signal.name.text.as_str());
            let expected = format!("no such signal{}", near(text, names));
            Err(Input::new(&source.name, expected).field(text).into())
        }
    }
}

/// Returns a suggestion of the most similar names, for an error.
pub(super) fn near<'a>(text: &str, names: impl Iterator<Item = &'a str>) -> String {
    nearest(text, names).map(|name| format!("; near it: {name}")).unwrap_or_default()
}

/// Returns the bits that `text` names: a signal, or a slice of one such as `x[7:4]` or `x[3]`.
///
/// # Errors
/// If there is no such signal, it does not consist of bits, or the slice is out of range.
pub(super) fn part(source: &Source, text: &str, slots: &mut Slots) -> Result<(usize, Part)> {
    let whole = match signal(source, text) {
        Ok(found) => return bits(source, found, None, slots, text),
        Err(error) => error,
    };
    let slice = slice(text);
    let column = || {
        let (name, high, low) = slice?;
        let wanted = Name::new(name);
        source.called(wanted.last()).iter().copied().find(|&k| {
            let signal = &source.signals[k];
            signal.lsb == i64::from(low)
                && i64::from(high) == signal.lsb + i64::from(signal.width) - 1
                && signal.name.common(&wanted) == Some(wanted.depth())
        })
    };
    if let Some(found) = widest(source, text).or_else(column) {
        return bits(source, found, None, slots, text);
    }
    let Some((name, high, low)) = slice else { return Err(whole) };
    let Ok(found) = signal(source, name) else { return Err(whole) };
    bits(source, found, Some((high, low)), slots, text)
}

/// Returns the signal with all bits, if slices of it have their own names.
fn widest(source: &Source, text: &str) -> Option<usize> {
    let wanted = Name::new(text);
    let begin = format!("{}[", wanted.parts());
    let is_part = |(_, signal): &(usize, &Signal)| {
        let name = signal.name.parts();
        name.strip_prefix(&begin).is_some_and(|range| range.contains(':'))
    };
    let called = source.called(wanted.last()).iter().map(|&k| (k, &source.signals[k]));
    let parts: Vec<_> = called.filter(is_part).collect();
    let (found, whole) = *parts.iter().max_by_key(|(_, signal)| signal.width)?;
    let top = |signal: &Signal| signal.lsb + i64::from(signal.width);
    let holds_all = parts.iter().all(|(k, part)| {
        *k == found
            || (part.lsb >= whole.lsb && top(part) <= top(whole) && part.width < whole.width)
    });
    holds_all.then_some(found)
}

fn bits(
    source: &Source,
    found: usize,
    slice: Option<(u32, u32)>,
    slots: &mut Slots,
    text: &str,
) -> Result<(usize, Part)> {
    let signal = &source.signals[found];
    let fault = |expected: String| Err(Input::new(&source.name, expected).field(text).into());
    if signal.kind == SignalKind::Other {
        return fault("has words whose values are not known, which are not compared".into());
    }
    let Some((high, low)) = slice else { return Ok((found, Part::whole(slots, signal))) };
    let (high, low) = (i64::from(high), i64::from(low));
    let top = signal.lsb + i64::from(signal.width) - 1;
    if high < low || high > top || low < signal.lsb {
        return fault(format!("expected a slice within [{top}:{}]", signal.lsb));
    }
    let (width, low) = ((high - low + 1) as u32, (low - signal.lsb) as u32);
    let place = slots.place(signal.id);
    Ok((found, Part { signal: place, low, width, whole: width == signal.width }))
}
