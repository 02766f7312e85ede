//! A file that is read a byte at a time without a call for each.

use std::fs::File;
use std::io::{BufRead, Error, ErrorKind, Read, Result, Seek, SeekFrom};

/// Bytes that are read at once.
const CHUNK: usize = 1 << 17;

/// A file whose single bytes come from a buffer, inlined where they are read: the waveform library
/// asks for each byte of a VCD on its own, and jumps about in an FST within a few bytes.
#[derive(Debug)]
pub(super) struct Bytes {
    /// Nothing where the buffer has all there is.
    file: Option<File>,
    buffer: Vec<u8>,
    at: usize,
    filled: usize,
    /// Place in the file behind the buffer.
    end: u64,
}

impl Bytes {
    pub(super) fn new(file: File) -> Bytes {
        Bytes { file: Some(file), buffer: vec![0; CHUNK], at: 0, filled: 0, end: 0 }
    }

    /// What is in memory already.
    pub(super) fn loaded(buffer: Vec<u8>) -> Bytes {
        let filled = buffer.len();
        Bytes { file: None, buffer, at: 0, filled, end: filled as u64 }
    }

    /// How many bytes there are.
    pub(super) fn length(&self) -> Result<u64> {
        self.file.as_ref().map_or(Ok(self.end), |file| Ok(file.metadata()?.len()))
    }

    /// So many bytes from a place on.
    pub(super) fn range(&mut self, place: u64, count: u64) -> Result<Vec<u8>> {
        self.seek(SeekFrom::Start(place))?;
        let mut bytes = Vec::new();
        self.take(count).read_to_end(&mut bytes)?;
        Ok(bytes)
    }
}

impl Read for Bytes {
    #[inline(always)]
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        if let [into] = into
            && self.at < self.filled
        {
            *into = self.buffer[self.at];
            self.at += 1;
            return Ok(1);
        }
        let count = self.fill_buf()?.read(into)?;
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Bytes {
    #[inline]
    fn fill_buf(&mut self) -> Result<&[u8]> {
        if self.at == self.filled
            && let Some(file) = &mut self.file
        {
            let count = loop {
                match file.read(&mut self.buffer) {
                    Err(error) if error.kind() == ErrorKind::Interrupted => {}
                    result => break result?,
                }
            };
            (self.at, self.filled) = (0, count);
            self.end += count as u64;
        }
        Ok(&self.buffer[self.at..self.filled])
    }

    #[inline]
    fn consume(&mut self, count: usize) {
        self.at = self.filled.min(self.at + count);
    }
}

impl Seek for Bytes {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::Current(by) => self.stream_position()?.checked_add_signed(by),
            SeekFrom::End(by) => self.length()?.checked_add_signed(by),
        };
        let place = place.ok_or_else(|| Error::from(ErrorKind::InvalidInput))?;
        let begin = self.end - self.filled as u64;
        match (&mut self.file, place.checked_sub(begin)) {
            (_, Some(at)) if at <= self.filled as u64 => self.at = at as usize,
            (Some(file), _) => {
                file.seek(SeekFrom::Start(place))?;
                (self.at, self.filled, self.end) = (0, 0, place);
            }
            (None, _) => self.at = self.filled,
        }
        Ok(place)
    }

    fn stream_position(&mut self) -> Result<u64> {
        Ok(self.end - (self.filled - self.at) as u64)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn a_jump_within_the_buffer_and_beyond_it_lands_where_it_says() {
        let whole: Vec<u8> = (0..3 * CHUNK as u32).map(|k| (k % 251) as u8).collect();
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&whole).unwrap();
        file.rewind().unwrap();
        for mut bytes in [Bytes::new(file), Bytes::loaded(whole.clone())] {
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
