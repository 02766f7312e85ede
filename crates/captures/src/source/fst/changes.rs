//! Check of a value change block in an FST file: initial values, changes of each signal, their offsets, and times.

use std::io::{Read, Seek, SeekFrom};

use super::super::bytes::Bytes;
use super::super::span::{Checked, Fault, Span, at_most};
use super::unpack::{lz4, most, zlib};

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
        let parts = self.parts(file, signals)?;
        sizes(file, &parts)
    }

    /// Unpacks all parts; `name` is the name of a signal by index.
    pub(super) fn unpack(self, file: &mut Bytes, name: &dyn Fn(usize) -> String) -> Checked<()> {
        let parts = self.parts(file, u64::MAX)?;
        let [size, packed] = parts.times;
        let place = self.begin + self.length - TAIL - packed;
        zlib(&file.range(place, packed)?, size, "times' size")?;
        let ends = parts.places.iter().skip(1).map(|place| place.at).chain([parts.length]);
        for (place, end) in parts.places.iter().zip(ends) {
            let bytes = file.range(parts.values + place.at, end - place.at)?;
            let mut span = Span::new(&bytes, "changes");
            let size = span.number()?;
            let packed = span.take(span.left())?;
            let what = || format!("changes of {}", name(place.signal as usize));
            match parts.method {
                _ if size == 0 => {}
                b'4' => drop(lz4(packed, size, &what())?),
                b'F' => {}
                _ => drop(zlib(packed, size, &what())?),
            }
        }
        Ok(())
    }

    /// Locates the parts of the block.
    fn parts(self, file: &mut Bytes, signals: u64) -> Checked<Parts> {
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
        let method = file.range(values, 1)?.first().copied().unwrap_or_default();
        let length = chain_begin - values;
        Ok(Parts { times: [size, packed], values, length, places, method })
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

/// Parts of a block.
struct Parts {
    /// Uncompressed and compressed size of the times [bytes].
    times: [u64; 2],
    /// Offset of the compressed changes, and their length [bytes].
    values: u64,
    length: u64,
    places: Vec<Place>,
    /// Compression of the changes: `4` is LZ4, `F` is FastLZ, others are deflate.
    method: u8,
}

/// Changes of a signal.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Index of the signal.
    signal: u64,
    /// Offset relative to the first compressed byte.
    at: u64,
}

/// Parses where each signal's changes are, in ascending order.
fn places(chain: &[u8], signals: u64) -> Checked<Vec<Place>> {
    let (mut span, mut places) = (Span::new(chain, "places"), Vec::new());
    let mut count = 0;
    while span.left() > 0 {
        count += match span.number()? {
            0 => {
                at_most("a signal that another is like", span.number()?, signals)?;
                1
            }
            number if number % 2 == 1 => {
                add(&mut places, count, number / 2)?;
                1
            }
            number => at_most("signals without changes", number / 2, signals)?,
        };
        at_most("places", count, signals)?;
    }
    Ok(places)
}

/// Parses the offsets in the format since 2014.
fn signed_places(chain: &[u8], signals: u64) -> Checked<Vec<Place>> {
    let (mut span, mut places) = (Span::new(chain, "places"), Vec::new());
    let mut count = 0;
    while span.left() > 0 {
        let is_place = span.clone().byte()? % 2 == 1;
        count += if is_place {
            let number = span.signed()? >> 1;
            match u64::try_from(number) {
                Ok(0) => {}
                Ok(further) => add(&mut places, count, further)?,
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

fn add(places: &mut Vec<Place>, signal: u64, further: u64) -> Checked<()> {
    let last = places.last().map_or(0, |place| place.at);
    let at = last.checked_add(further).filter(|_| further > 0);
    let at = at.ok_or_else(|| Fault::value("a place", further, "is none"))?;
    places.push(Place { signal, at });
    Ok(())
}

/// Checks the uncompressed size of each signal's changes against their compressed size.
fn sizes(file: &mut Bytes, parts: &Parts) -> Checked<()> {
    let &Parts { values, length, ref places, method, .. } = parts;
    let is_deflated = !matches!(method, b'4' | b'F');
    let ends = places.iter().skip(1).map(|place| place.at).chain([length]);
    let mut total = 0;
    for (&Place { at, .. }, end) in places.iter().zip(ends) {
        at_most("a place", at, length)?;
        let packed = at_most("a place", end, length)?.saturating_sub(at);
        file.seek(SeekFrom::Start(values + at))?;
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
