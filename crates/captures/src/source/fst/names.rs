//! Check of the names and widths of an FST file's signals.

use super::super::signals::WIDEST;
use super::super::span::{Checked, Fault, Span, at_most};
use super::comments::Comments;
use super::unpack::{gzip, gzipped, lz4, zlib};

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
/// is compressed by gzip, 6 for LZ4, or 7 for LZ4 twice. If there are VHDL types among the names, the block is returned
/// without them. The comments in it are added to `comments`.
pub(super) fn check(
    body: &[u8],
    kind: u8,
    signals: u64,
    comments: &mut Comments,
) -> Checked<Option<Vec<u8>>> {
    const SIZE: &str = "names' size";
    let mut span = Span::new(body, "names");
    let size = span.word(8)?;
    let bytes = match kind {
        GZIP_NAMES => gzip(span.take(span.left())?, size, SIZE)?,
        6 => lz4(span.take(span.left())?, size, SIZE)?,
        _ => {
            let once = span.number()?;
            lz4(&lz4(span.take(span.left())?, once, SIZE)?, size, SIZE)?
        }
    };
    let mut span = Span::new(&bytes, "names");
    let (mut own, mut kept) = (0, Vec::new());
    while span.left() > 0 {
        let begin = span.place();
        let mut is_kept = true;
        match span.byte()? {
            SCOPE => {
                span.byte()?;
                comments.enter(span.text()?);
                span.text()?;
            }
            0..=LAST_KIND => {
                span.byte()?;
                comments.variable(span.text()?);
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
                let text = span.text()?;
                let value = span.number()?;
                if kind == COMMENT {
                    comments.add(text);
                }
                // The library prints some of VHDL's types, which have numbers.
                is_kept = kind != VHDL_TYPE || value == 0;
            }
            ATTRIBUTE_END => {}
            SCOPE_END => comments.leave(),
            kind => return Err(Fault::value("a name's kind", kind.into(), "is none")),
        }
        if is_kept {
            kept.extend_from_slice(&bytes[begin..span.place()]);
        }
    }
    Ok((kept.len() < bytes.len()).then(|| block(&kept)))
}

/// Returns a block of names.
fn block(names: &[u8]) -> Vec<u8> {
    let packed = gzipped(names);
    let length = 2 * 8 + packed.len() as u64;
    let size = names.len() as u64;
    [&[GZIP_NAMES][..], &length.to_be_bytes(), &size.to_be_bytes(), &packed].concat()
}

/// Kind of a block of names that is compressed by gzip.
const GZIP_NAMES: u8 = 4;

/// Kinds of entries in the hierarchy: the last kind of a variable, and the starts and ends of attributes and scopes.
const LAST_KIND: u8 = 29;
const ATTRIBUTE: u8 = 252;
const ATTRIBUTE_END: u8 = 253;
const SCOPE: u8 = 254;
const SCOPE_END: u8 = 255;
/// Attribute with a comment.
const COMMENT: [u8; 2] = [0, 0];
/// Attribute with the type of the next variable.
const VHDL_TYPE: [u8; 2] = [0, 2];
/// Attributes that have a number in place of their text: source stems.
const SOURCES: [[u8; 2]; 2] = [[0, 4], [0, 5]];
