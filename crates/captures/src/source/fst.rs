//! Check of an FST file before the library reads it, because fst-reader 0.17.1 allocates memory by the lengths, sizes
//! and counts that the file states, and seeks by its lengths; wellen 0.25.7 prints VHDL's types on standard output,
//! and gets the names without them.
//!
//! The format is described in GTKWave's `block_format.txt` and `fstapi.c`.

mod changes;
mod comments;
mod names;
mod unpack;

use std::fs::File;
use std::io::{Cursor, Seek};
use std::path::Path;

use tofsim::error::{Error, Result};

use changes::Section;
pub(super) use comments::Comments;
use unpack::{gzip_prefix, most};

use super::bytes::Bytes;
use super::span::{Checked, Fault, Span, at_most};
use super::spliced::Piece;

/// First byte of a file that begins with its header.
pub(super) const HEADER: u8 = 0;
/// First byte of a file that is compressed as a whole.
pub(super) const WRAPPED: u8 = 254;

/// Size of a header including its length, and the offsets of its end time and timescale after the length [bytes].
const HEADER_LENGTH: u64 = 329;
const END: usize = 8;
const TIMESCALE: usize = 64;
/// Range of the timescale's power of ten.
const EXPONENTS: std::ops::RangeInclusive<i8> = -21..=2;
/// Size of a block's length field [bytes].
const LENGTH: u64 = 8;

/// Opens a file of any format. An FST file that is compressed as a whole is decompressed.
pub(super) fn open(path: &Path) -> Result<Bytes> {
    let file = File::open(path).map_err(Error::io(path, "read"))?;
    let mut bytes = Bytes::new(file);
    if bytes.range(0, 1).map_err(Error::io(path, "read"))? == [WRAPPED] {
        let unpacked = unwrapped(&mut bytes).map_err(|fault| fault.of_file(path))?;
        return Ok(Bytes::new(Cursor::new(unpacked)));
    }
    bytes.rewind().map_err(Error::io(path, "read"))?;
    Ok(bytes)
}

/// Returns the comments on a file, given its contents.
pub(super) fn comments_of(contents: &[u8]) -> Checked<Vec<String>> {
    let mut file = Bytes::new(Cursor::new(contents.to_vec()));
    match contents.first() {
        Some(&WRAPPED) => file = Bytes::new(Cursor::new(unwrapped(&mut file)?)),
        Some(&HEADER) => {}
        _ => return Ok(Vec::new()),
    }
    Ok(check(&mut file)?.comments.on_file)
}

/// Decompresses a file that is compressed as a whole.
fn unwrapped(file: &mut Bytes) -> Checked<Vec<u8>> {
    let head = file.range(1, 2 * LENGTH)?;
    let mut span = Span::new(&head, "packed file");
    let (length, size) = (span.word(LENGTH)?, span.word(LENGTH)?);
    if length == 0 {
        return Err(Fault::of("packed file", "was not packed to its end"));
    }
    let packed = file.length()? - 1 - 2 * LENGTH;
    at_most("size of the packed file", size, most(packed, true))?;
    gzip_prefix(&file.range(1 + 2 * LENGTH, packed)?, size, "size of the packed file")
}

/// Contents of a file.
pub(super) struct Contents {
    /// End time, in ticks.
    pub(super) end: Option<u64>,
    /// The file as the library sees it.
    pub(super) pieces: Vec<Piece>,
    pub(super) comments: Comments,
    sections: Vec<Section>,
}

impl Contents {
    /// Returns the first part that cannot be unpacked; `name` is the name of a signal by index.
    pub(super) fn fault(&self, file: &mut Bytes, name: impl Fn(usize) -> String) -> Option<Fault> {
        self.sections.iter().find_map(|section| {
            let block = format!("block at byte {}", section.begin - 1);
            Some(section.unpack(file, &name).err()?.within(&block))
        })
    }

    /// Returns the fault of changes that can be unpacked and have no meaning.
    pub(super) fn undecoded(&self) -> Option<Fault> {
        let block = format!("block at byte {}", self.sections.first()?.begin - 1);
        let later = if self.sections.len() > 1 { " or a later one" } else { "" };
        Some(Fault::of(&(block + later), "changes cannot be decoded"))
    }
}

/// Checks a file, and returns its contents.
pub(super) fn check(file: &mut Bytes) -> Checked<Contents> {
    let whole = file.length()?;
    let (mut end, mut signals) = (None, None);
    let (mut sections, mut hierarchies) = (Vec::new(), Vec::new());
    let mut place = 0;
    while place < whole {
        let block = format!("block at byte {place}");
        let within = |fault: Fault| fault.within(&block);
        let head = file.range(place, 1 + LENGTH)?;
        let mut span = Span::new(&head, "length");
        let kind = span.byte()?;
        let length = span.word(LENGTH).map_err(within)?;
        if kind == 255 && length == 0 {
            // A file that was not finished; what follows are changes on their way.
            break;
        }
        let most = whole - place - 1;
        if !(LENGTH..=most).contains(&length) {
            let expected = format!("expected {LENGTH} to {most}");
            return Err(within(Fault::value("length", length, expected)));
        }
        let begin = place + 1;
        let mut body = || file.range(begin + LENGTH, length - LENGTH);
        match kind {
            HEADER => end = Some(header(&body()?).map_err(within)?),
            1 | 5 | 8 => sections.push(Section { kind, begin, length }),
            2 => drop(Span::new(&body()?, "pauses").count("number").map_err(within)?),
            3 => signals = Some(names::widths(&body()?).map_err(within)?.len() as u64),
            4 | 6 | 7 => hierarchies.push((body()?, kind, place..begin + length)),
            255 => {}
            _ => return Err(within(Fault::value("kind", kind.into(), "is none of FST's"))),
        }
        place = begin + length;
    }
    let Some(signals) = signals else {
        return Err(Fault::of("geometry", "is missing: the file was not written to its end"));
    };
    let (mut pieces, mut kept, mut comments) = (Vec::new(), 0, Comments::default());
    for (body, kind, block) in hierarchies {
        let place = block.start;
        let names = names::check(&body, kind, signals, &mut comments);
        let names = names.map_err(|fault| fault.within(&format!("block at byte {place}")))?;
        if let Some(names) = names {
            pieces.extend([Piece::Kept(kept..place), Piece::New(names)]);
            kept = block.end;
        }
    }
    if !pieces.is_empty() {
        pieces.push(Piece::Kept(kept..u64::MAX));
    }
    for section in &sections {
        let block = format!("block at byte {}", section.begin - 1);
        section.check(file, signals).map_err(|fault| fault.within(&block))?;
    }
    Ok(Contents { end, pieces, comments, sections })
}

/// Parses the end time in the header.
fn header(body: &[u8]) -> Checked<u64> {
    let length = body.len() as u64 + LENGTH;
    if length != HEADER_LENGTH {
        let expected = format!("expected {HEADER_LENGTH} of a header");
        return Err(Fault::value("length", length, expected));
    }
    let exponent = body[TIMESCALE] as i8;
    if !EXPONENTS.contains(&exponent) {
        let expected = format!("expected 10 to the -21 to 2 seconds, not to the {exponent}");
        return Err(Fault::value("timescale", body[TIMESCALE].into(), expected));
    }
    Span::new(&body[END..], "end").word(8)
}
