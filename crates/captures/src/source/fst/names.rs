//! Check of the names and widths of an FST file's signals.

use super::super::signals::WIDEST;
use super::super::span::{Checked, Fault, Span, at_most};
use super::unpack::{gzip, lz4, zlib};

/// Parses the width of each signal's initial value in the geometry block [bytes].
pub(super) fn widths(body: &[u8]) -> Checked<Vec<u64>> {
    let mut span = Span::new(body, "geometry");
    let (size, count) = (span.word(8)?, span.word(8)?);
    let bytes = zlib(span.take(span.left())?, size, "geometry's size")?;
    let count = at_most("geometry's signals", count, bytes.len() as u64)?;
    let mut span = Span::new(&bytes, "geometry");
    let width = |_| match span.number()? {
        0 => Ok(8),
        0xffff_ffff => Ok(0),
        width => at_most("a signal's width", width, WIDEST.into()),
    };
    (0..count).map(width).collect()
}

/// Checks that every name in a hierarchy block belongs to one of the first `signals` signals. The block's kind is 4 if it
/// is compressed by gzip, 6 for LZ4, or 7 for LZ4 twice.
pub(super) fn check(body: &[u8], kind: u8, signals: u64) -> Checked<()> {
    const SIZE: &str = "names' size";
    let mut span = Span::new(body, "names");
    let size = span.word(8)?;
    let bytes = match kind {
        4 => gzip(span.take(span.left())?, size, SIZE)?,
        6 => lz4(span.take(span.left())?, size, SIZE)?,
        _ => {
            let once = span.number()?;
            lz4(&lz4(span.take(span.left())?, once, SIZE)?, size, SIZE)?
        }
    };
    let mut span = Span::new(&bytes, "names");
    let mut own = 0;
    while span.left() > 0 {
        match span.byte()? {
            SCOPE => {
                span.byte()?;
                span.text()?;
                span.text()?;
            }
            0..=LAST_KIND => {
                span.byte()?;
                span.text()?;
                at_most("a signal's width", span.number()?, u32::MAX.into())?;
                if at_most("a name's signal", span.number()?, signals)? == 0 {
                    own = at_most("names' signals", own + 1, signals)?;
                }
            }
            ATTRIBUTE => {
                let kind = [span.byte()?, span.byte()?];
                if SOURCES.contains(&kind) {
                    span.number()?;
                }
                span.text()?;
                span.number()?;
            }
            ATTRIBUTE_END | SCOPE_END => {}
            kind => return Err(Fault::value("a name's kind", kind.into(), "is none")),
        }
    }
    Ok(())
}

/// Kinds of entries in the hierarchy: the last kind of a variable, and the starts and ends of attributes and scopes.
const LAST_KIND: u8 = 29;
const ATTRIBUTE: u8 = 252;
const ATTRIBUTE_END: u8 = 253;
const SCOPE: u8 = 254;
const SCOPE_END: u8 = 255;
/// Attributes that have a number in place of their text: source stems.
const SOURCES: [[u8; 2]; 2] = [[0, 4], [0, 5]];
