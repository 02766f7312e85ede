//! Value changes of an FST file, in sections that are compressed signal by signal.
//!
//! A section contains the initial values, the stream of each signal, the offsets of the streams, and the times.

use std::io::{self, Seek, Write};

use super::blocks::{Block, long, number, signed};
use super::header::Header;
use super::stream::Stream;
use super::times::Times;

/// Identifier of LZ4 compression of the streams.
const LZ4: u8 = b'4';
/// Amount of changes that are collected before compression [bytes].
const GATHERED: usize = 1 << 20;

/// Writer of the value changes.
pub(super) struct Changes<W> {
    file: W,
    header: Header,
    streams: Vec<Stream>,
    /// Values at the start of the section, one digit per bit.
    frame: Vec<u8>,
    times: Times,
    /// The last time [ps].
    at: u64,
    /// Start of the section [ps].
    start: u64,
    /// Approximate size of all streams [bytes].
    size: usize,
}

impl<W: Write + Seek> Changes<W> {
    /// Creates a writer that appends to `file`; `widths` are those of the signals, in order.
    pub(super) fn new(file: W, header: Header, widths: &[usize]) -> Self {
        let streams = widths.iter().map(|&width| Stream::new(width)).collect();
        let (frame, times) = (Vec::new(), Times::default());
        Changes { file, header, streams, frame, times, at: 0, start: 0, size: 0 }
    }

    /// Begins a time step, not earlier than the previous one [ps].
    pub(super) fn begin(&mut self, at: u64) -> io::Result<()> {
        if at <= self.at {
            return Ok(());
        }
        if self.size + self.times.steps.len() > GATHERED {
            self.write_section()?;
        }
        if self.times.steps.is_empty() {
            self.streams.iter().for_each(|stream| stream.spell(&mut self.frame));
        }
        self.times.push(at, self.at);
        self.at = at;
        Ok(())
    }

    /// Changes a signal of up to 64 bits.
    #[inline]
    pub(super) fn word(&mut self, signal: usize, value: u64) {
        let width = self.streams[signal].width;
        let bytes = width.div_ceil(8);
        let aligned = value << (8 * bytes - width);
        self.change(signal, &aligned.to_be_bytes()[8 - bytes..]);
    }

    /// Changes a signal; the most significant bit is the highest bit of the first byte.
    #[inline]
    pub(super) fn change(&mut self, signal: usize, value: &[u8]) {
        let stream = &mut self.streams[signal];
        stream.set(value);
        // The values of the first time step are the frame.
        if !self.times.steps.is_empty() {
            self.size += stream.note(self.times.last, value);
        }
    }

    /// Sets all signals to unknown.
    pub(super) fn unknown(&mut self) {
        for stream in &mut self.streams {
            stream.value = None;
            if !self.times.steps.is_empty() {
                stream.note_unknown(self.times.last);
                self.size += 2 + stream.width;
            }
        }
    }

    /// Writes the last section, and the header with the end time [ps].
    pub(super) fn finish(mut self, at: u64) -> io::Result<W> {
        self.begin(at)?;
        self.write_section()?;
        self.header.end = self.at;
        self.header.write(&mut self.file)?;
        Ok(self.file)
    }

    fn write_section(&mut self) -> io::Result<()> {
        let mut body = Vec::new();
        self.take_frame(&mut body);
        let length = self.take_streams(&mut body);
        self.times.take(&mut body);
        let mut head = Vec::new();
        for field in [self.start, self.at, length as u64] {
            long(&mut head, field);
        }
        Block::Changes.write(&mut self.file, &[&head, &body])?;
        self.header.sections += 1;
        (self.size, self.start) = (0, self.at);
        Ok(())
    }

    /// Appends the initial values. Their length is written twice, because they are not compressed.
    fn take_frame(&mut self, body: &mut Vec<u8>) {
        let length = self.frame.len() as u64;
        for count in [length, length, self.streams.len() as u64] {
            number(body, count);
        }
        body.append(&mut self.frame);
    }

    /// Appends all streams and their offsets, and returns their uncompressed size [bytes].
    fn take_streams(&mut self, body: &mut Vec<u8>) -> usize {
        number(body, self.streams.len() as u64);
        let (mut last, mut empty, mut length) = (body.len(), 0, 0);
        body.push(LZ4);
        let mut places = Vec::new();
        for stream in &mut self.streams {
            if stream.data.is_empty() {
                empty += 1;
                continue;
            }
            skip(&mut places, &mut empty);
            // The lowest bit says that it is a place.
            signed(&mut places, (2 * (body.len() - last) + 1) as u64);
            last = body.len();
            length += stream.take(body);
        }
        skip(&mut places, &mut empty);
        body.extend_from_slice(&places);
        long(body, places.len() as u64);
        length
    }
}

/// Appends the number of consecutive signals without a stream.
fn skip(places: &mut Vec<u8>, signals: &mut u64) {
    if *signals > 0 {
        number(places, 2 * std::mem::take(signals));
    }
}
