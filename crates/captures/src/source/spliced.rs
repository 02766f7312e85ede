//! Files of which parts are replaced before a library reads them.

use std::io::{Error, ErrorKind, Read, Result, Seek, SeekFrom};
use std::ops::Range;
use std::sync::Arc;

use super::bytes::Bytes;

/// A part of the file that the library sees.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Piece {
    /// Other bytes.
    New(Vec<u8>),
    /// Bytes of the file; what lies beyond its end is left out.
    Kept(Range<u64>),
}

/// Reader of the pieces, one after the other.
pub(super) struct Spliced {
    file: Bytes,
    pieces: Arc<[Piece]>,
    /// Offset at which each piece ends.
    ends: Vec<u64>,
    place: u64,
}

impl Spliced {
    /// Creates a reader of `pieces`; without any, it is the file itself.
    pub(super) fn open(mut file: Bytes, pieces: &Arc<[Piece]>) -> Result<Bytes> {
        if pieces.is_empty() {
            return Ok(file);
        }
        let whole = file.length()?;
        let length = |piece: &Piece| match piece {
            Piece::New(bytes) => bytes.len() as u64,
            Piece::Kept(range) => range.end.min(whole).saturating_sub(range.start),
        };
        let mut end = 0;
        let ends = pieces.iter().map(|piece| {
            end += length(piece);
            end
        });
        let ends = ends.collect();
        Ok(Bytes::new(Spliced { file, pieces: Arc::clone(pieces), ends, place: 0 }))
    }
}

impl Read for Spliced {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        let index = self.ends.partition_point(|&end| end <= self.place);
        let Some(piece) = self.pieces.get(index) else { return Ok(0) };
        let begin = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        let most = (self.ends[index] - self.place).min(into.len() as u64) as usize;
        let (into, offset) = (&mut into[..most], self.place - begin);
        let count = match piece {
            Piece::New(bytes) => (&bytes[offset as usize..]).read(into)?,
            Piece::Kept(range) => {
                self.file.seek(SeekFrom::Start(range.start + offset))?;
                self.file.read(into)?
            }
        };
        self.place += count as u64;
        Ok(count)
    }
}

impl Seek for Spliced {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::Current(by) => self.place.checked_add_signed(by),
            SeekFrom::End(by) => self.ends.last().unwrap_or(&0).checked_add_signed(by),
        };
        self.place = place.ok_or_else(|| Error::from(ErrorKind::InvalidInput))?;
        Ok(self.place)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    #[test]
    fn pieces_are_read_in_order_from_any_place() {
        let file = Bytes::new(Cursor::new(b"0123456789".to_vec()));
        let pieces = [Piece::New(b"ab".into()), Piece::Kept(3..6), Piece::Kept(8..u64::MAX)];
        let mut spliced = Spliced::open(file, &pieces.into()).unwrap();
        for place in 0..=7 {
            spliced.seek(SeekFrom::Start(place)).unwrap();
            let mut text = String::new();
            spliced.read_to_string(&mut text).unwrap();
            assert_eq!(text, "ab34589"[place as usize..]);
        }
        assert_eq!(spliced.length().unwrap(), 7);
    }
}
