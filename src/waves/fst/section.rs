//! A section of value changes: the initial values, the stream of each signal, the offsets of the streams, and the
//! times. Streams are compressed one by one.

use std::io::{self, Write};

use miniz_oxide::deflate::compress_to_vec_zlib;

use super::blocks::{Block, long, number, signed};
use super::times::Times;

/// Identifier of LZ4 compression of the streams.
const LZ4: u8 = b'4';
/// Length from which a stream is compressed [bytes].
const SHORT: usize = 32;
/// Lengths from which initial values are compressed: of the first section, which may be small, and of others [bytes].
pub(super) const FIRST_LARGE: usize = 1 << 8;
pub(super) const LARGE: usize = 1 << 14;
/// Compression level of zlib for initial values, most of which are alike.
const ZLIB: u8 = 1;

/// A section, until it is written.
pub(super) struct Section {
    /// Start and end, in units of the file.
    pub(super) span: [u64; 2],
    /// Values at the start, one digit per bit.
    pub(super) frame: Vec<u8>,
    /// Length from which they are compressed [bytes].
    pub(super) large: usize,
    /// Changes of each signal.
    pub(super) streams: Vec<Vec<u8>>,
    pub(super) times: Times,
}

impl Section {
    /// Creates an empty section of so many signals.
    pub(super) fn new(signals: usize) -> Self {
        let streams = vec![Vec::new(); signals];
        let (frame, times) = (Vec::new(), Times::default());
        Section { span: [0, 0], frame, large: LARGE, streams, times }
    }

    /// Compresses the section, appends it to a file, and clears it.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub(super) fn write(&mut self, file: &mut impl Write) -> io::Result<()> {
        let mut body = Vec::new();
        self.take_frame(&mut body);
        let length = self.take_streams(&mut body);
        self.times.take(&mut body);
        let mut head = Vec::new();
        for field in [self.span[0], self.span[1], length as u64] {
            long(&mut head, field);
        }
        Block::Changes.write(file, &[&head, &body])
    }

    /// Appends the initial values, compressed if there are many. Two equal lengths say that they are not.
    fn take_frame(&mut self, body: &mut Vec<u8>) {
        let packed =
            (self.frame.len() >= self.large).then(|| compress_to_vec_zlib(&self.frame, ZLIB));
        let packed = packed.filter(|packed| packed.len() < self.frame.len());
        let written = packed.as_ref().unwrap_or(&self.frame);
        for count in [self.frame.len(), written.len(), self.streams.len()] {
            number(body, count as u64);
        }
        body.extend_from_slice(written);
        self.frame.clear();
    }

    /// Appends all streams and their offsets, and returns their uncompressed size [bytes].
    fn take_streams(&mut self, body: &mut Vec<u8>) -> usize {
        number(body, self.streams.len() as u64);
        let (mut last, mut empty, mut length) = (body.len(), 0, 0);
        body.push(LZ4);
        let mut places = Vec::new();
        for stream in &mut self.streams {
            if stream.is_empty() {
                empty += 1;
                continue;
            }
            skip(&mut places, &mut empty);
            // The lowest bit says that it is a place.
            signed(&mut places, (2 * (body.len() - last) + 1) as u64);
            last = body.len();
            length += stream.len();
            pack(stream, body);
            stream.clear();
        }
        skip(&mut places, &mut empty);
        body.extend_from_slice(&places);
        long(body, places.len() as u64);
        length
    }
}

/// Appends a stream, compressed with LZ4 if that is shorter.
fn pack(stream: &[u8], body: &mut Vec<u8>) {
    let packed = (stream.len() >= SHORT).then(|| lz4_flex::block::compress(stream));
    match packed.filter(|packed| packed.len() < stream.len()) {
        Some(packed) => {
            number(body, stream.len() as u64);
            body.extend_from_slice(&packed);
        }
        None => {
            let as_it_is = 0;
            number(body, as_it_is);
            body.extend_from_slice(stream);
        }
    }
}

/// Appends the number of consecutive signals without a stream.
fn skip(places: &mut Vec<u8>, signals: &mut u64) {
    if *signals > 0 {
        number(places, 2 * std::mem::take(signals));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_initial_values_are_packed_and_few_are_as_they_are() {
        let body = |length: usize| {
            let mut section = Section { large: FIRST_LARGE, ..Section::new(3) };
            section.frame.resize(length, b'x');
            let mut body = Vec::new();
            section.take_frame(&mut body);
            assert!(section.frame.is_empty());
            body
        };
        assert_eq!(body(4), [4, 4, 3, b'x', b'x', b'x', b'x']);
        assert!(body(FIRST_LARGE).len() < FIRST_LARGE / 8);
        let many = LARGE;
        let packed = body(many);
        let mut lengths = Vec::new();
        number(&mut lengths, many as u64);
        assert!(packed.starts_with(&lengths) && packed.len() < many / 50, "{}", packed.len());
        let from = packed.len() - usize::from(packed[lengths.len()]);
        let frame = miniz_oxide::inflate::decompress_to_vec_zlib(&packed[from..]).unwrap();
        assert_eq!(frame, vec![b'x'; many]);
    }
}
