//! Buffered reader with fast access to single bytes.

use std::io::{BufRead, BufReader, Error, ErrorKind, Read, Result, Seek, SeekFrom};

/// Buffer size [bytes].
const CHUNK: usize = 1 << 17;

/// Buffered file whose byte access is inlined: the waveform library reads a VCD byte by byte, and seeks within an FST
/// by few bytes.
pub(super) struct Bytes(BufReader<Placed>);

/// A file, or bytes in memory.
pub(super) trait Store: Read + Seek + Send + Sync {}

impl<T: Read + Seek + Send + Sync> Store for T {}

/// Origin of the bytes, and the position of the next read.
struct Placed {
    store: Box<dyn Store>,
    place: u64,
}

impl Bytes {
    pub(super) fn new(store: impl Store + 'static) -> Bytes {
        Bytes(BufReader::with_capacity(CHUNK, Placed { store: Box::new(store), place: 0 }))
    }

    /// Returns the number of bytes.
    pub(super) fn length(&mut self) -> Result<u64> {
        let Placed { store, place } = self.0.get_mut();
        let length = store.seek(SeekFrom::End(0))?;
        store.seek(SeekFrom::Start(*place))?;
        Ok(length)
    }

    /// Reads `count` bytes from a position on.
    pub(super) fn range(&mut self, place: u64, count: u64) -> Result<Vec<u8>> {
        self.seek(SeekFrom::Start(place))?;
        let mut bytes = Vec::new();
        self.take(count).read_to_end(&mut bytes)?;
        Ok(bytes)
    }
}

impl Read for Placed {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        let count = self.store.read(into)?;
        self.place += count as u64;
        Ok(count)
    }
}

impl Seek for Placed {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        self.place = self.store.seek(to)?;
        Ok(self.place)
    }
}

impl Read for Bytes {
    #[inline(always)]
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        if let [into] = into
            && let [byte, ..] = self.0.buffer()
        {
            *into = *byte;
            self.0.consume(1);
            return Ok(1);
        }
        self.0.read(into)
    }
}

impl BufRead for Bytes {
    fn fill_buf(&mut self) -> Result<&[u8]> {
        self.0.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.0.consume(count);
    }
}

impl Seek for Bytes {
    /// Seeks; within the buffer, nothing is read again.
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        let now = self.stream_position()?;
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::Current(by) => now.checked_add_signed(by),
            SeekFrom::End(by) => self.length()?.checked_add_signed(by),
        };
        let place = place.ok_or_else(|| Error::from(ErrorKind::InvalidInput))?;
        match i64::try_from(i128::from(place) - i128::from(now)) {
            Ok(by) => self.0.seek_relative(by)?,
            Err(_) => drop(self.0.seek(SeekFrom::Start(place))?),
        }
        Ok(place)
    }

    fn stream_position(&mut self) -> Result<u64> {
        Ok(self.0.get_ref().place - self.0.buffer().len() as u64)
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Write};

    use super::*;

    #[test]
    fn a_jump_within_the_buffer_and_beyond_it_lands_where_it_says() {
        let whole: Vec<u8> = (0..3 * CHUNK as u32).map(|k| (k % 251) as u8).collect();
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&whole).unwrap();
        file.rewind().unwrap();
        for mut bytes in [Bytes::new(file), Bytes::new(Cursor::new(whole.clone()))] {
            let last = whole.len() as u64 - 1;
            for place in [0, 5, 3, CHUNK as u64 + 7, CHUNK as u64, 1, last, 2] {
                assert_eq!(bytes.seek(SeekFrom::Start(place)).unwrap(), place);
                let mut byte = [0];
                bytes.read_exact(&mut byte).unwrap();
                assert_eq!(byte[0], whole[place as usize]);
                assert_eq!(bytes.stream_position().unwrap(), place + 1);
            }
            assert_eq!(bytes.range(9, 1 << 18).unwrap(), whole[9..9 + (1 << 18)]);
            assert_eq!(bytes.seek(SeekFrom::End(-1)).unwrap(), last);
            assert_eq!(bytes.read_to_end(&mut Vec::new()).unwrap(), 1);
            assert!(bytes.seek(SeekFrom::Current(-1 - last as i64 - 1)).is_err());
        }
    }
}
