//! Check of a value change block in an FST file: initial values, changes of each signal, their offsets, and times.

use std::io::{Read, Seek, SeekFrom};

use super::super::bytes::Bytes;
use super::super::span::{Checked, Fault, Span, at_most};
use super::unpack::most;

/// Size of the fields before the initial values: length, start, end and memory [bytes].
const HEAD: u64 = 4 * 8;
/// Size of the fields after the times: their uncompressed and compressed size, and their number [bytes].
const TAIL: u64 = 3 * 8;
/// Largest size of a variable-length integer [bytes].
const NUMBER: u64 = 10;
/// Kind of a block whose offsets are signed integers, the format since 2014.
const SIGNED: u8 = 8;

/// Position of a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    pub(super) kind: u8,
    /// Offset of its length field, from which the length counts [bytes].
    pub(super) begin: u64,
    pub(super) length: u64,
}

impl Section {
    /// Checks that all parts lie within the block, and that no count or size exceeds its contents.
    pub(super) fn check(self, file: &mut Bytes, signals: u64) -> Checked<()> {
        let end = self.begin + self.length;
        let least = HEAD + 3 + 2 + 8 + TAIL;
        if self.length < least {
            let expected = format!("expected {least} bytes or more");
            return Err(Fault::value("length", self.length, expected));
        }
        let tail = file.range(end - TAIL, TAIL)?;
        let mut tail = Span::new(&tail, "times");
        let (size, packed, count) = (tail.word(8)?, tail.word(8)?, tail.word(8)?);
        at_most("packed times", packed, self.length - least)?;
        at_most("times' size", size, most(packed, true).max(packed))?;
        at_most("number of times", count, size)?;
        let chain_end = end - TAIL - packed - 8;
        let length = Span::new(&file.range(chain_end, 8)?, "places").word(8)?;
        let values = self.values(file, chain_end, signals)?;
        at_most("the length of the places", length, (chain_end - values).saturating_sub(1))?;
        let chain_begin = chain_end - length;
        let chain = file.range(chain_begin, length)?;
        let places = if self.kind == SIGNED {
            signed_places(&chain, signals)?
        } else {
            places(&chain, signals)?
        };
        let is_deflated = !matches!(file.range(values, 1)?[..], [b'4' | b'F']);
        sizes(file, values, &places, chain_begin - values, is_deflated)
    }

    /// Returns the offset of the compressed changes, after the initial values.
    fn values(self, file: &mut Bytes, chain_end: u64, signals: u64) -> Checked<u64> {
        let begin = self.begin + HEAD;
        let head = file.range(begin, (3 * NUMBER).min(chain_end - begin))?;
        let mut span = Span::new(&head, "first values");
        let (_, packed, count) = (span.number()?, span.number()?, span.number()?);
        at_most("first values' signals", count, signals)?;
        let behind = begin + span.place() as u64;
        let most = (chain_end - behind).saturating_sub(2);
        let place = behind + at_most("first values' length", packed, most)?;
        let head = file.range(place, NUMBER.min(chain_end - place))?;
        let mut span = Span::new(&head, "changes");
        at_most("signals of a block", span.number()?, signals)?;
        Ok(place + span.place() as u64)
    }
}

/// Parses the offset of each signal's changes, relative to the first compressed byte, in ascending order.
fn places(chain: &[u8], signals: u64) -> Checked<Vec<u64>> {
    let (mut span, mut places) = (Span::new(chain, "places"), Vec::new());
    let mut count = 0;
    while span.left() > 0 {
        count += match span.number()? {
            0 => {
                at_most("a signal that another is like", span.number()?, signals)?;
                1
            }
            number if number % 2 == 1 => {
                add(&mut places, number / 2)?;
                1
            }
            number => at_most("signals without changes", number / 2, signals)?,
        };
        at_most("places", count, signals)?;
    }
    Ok(places)
}

/// Parses the offsets in the format since 2014.
fn signed_places(chain: &[u8], signals: u64) -> Checked<Vec<u64>> {
    let (mut span, mut places) = (Span::new(chain, "places"), Vec::new());
    let mut count = 0;
    while span.left() > 0 {
        let is_place = span.clone().byte()? % 2 == 1;
        count += if is_place {
            let number = span.signed()? >> 1;
            match u64::try_from(number) {
                Ok(0) => {}
                Ok(further) => add(&mut places, further)?,
                Err(_) => {
                    at_most("a signal that another is like", number.unsigned_abs(), signals)?;
                }
            }
            1
        } else {
            at_most("signals without changes", span.number()? / 2, signals)?
        };
        at_most("places", count, signals)?;
    }
    Ok(places)
}

fn add(places: &mut Vec<u64>, further: u64) -> Checked<()> {
    let place = places.last().unwrap_or(&0).checked_add(further).filter(|_| further > 0);
    places.push(place.ok_or_else(|| Fault::value("a place", further, "is none"))?);
    Ok(())
}

/// Checks the uncompressed size of each signal's changes against their compressed size.
fn sizes(
    file: &mut Bytes,
    values: u64,
    places: &[u64],
    length: u64,
    is_deflated: bool,
) -> Checked<()> {
    let ends = places.iter().skip(1).chain([&length]);
    let mut total = 0;
    for (&place, &end) in places.iter().zip(ends) {
        at_most("a place", place, length)?;
        let packed = at_most("a place", end, length)?.saturating_sub(place);
        file.seek(SeekFrom::Start(values + place))?;
        let mut head = [0; NUMBER as usize];
        let head = &mut head[..packed.min(NUMBER) as usize];
        file.read_exact(head)?;
        let mut span = Span::new(head, "changes of a signal");
        let size = match span.number()? {
            0 => packed - span.place() as u64,
            size => {
                let body = packed - span.place() as u64;
                at_most("size of a signal's changes", size, most(body, is_deflated))?
            }
        };
        total += size;
    }
    at_most("size of all changes of a block", total, u32::MAX.into())?;
    Ok(())
}
