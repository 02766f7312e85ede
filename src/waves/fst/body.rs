//! The body of an FST file: sections of value changes, each compressed signal by signal.
//!
//! As GTKWave's `fstapi` has it, a section holds the values at its begin, the stream of each signal
//! (LZ4), where each stream is, and the times (zlib). A change is how many times have passed since
//! the one before and the value. Numbers are big-endian, or seven bits to a byte, lowest first.

use std::io::{self, Seek, SeekFrom, Write};

/// Type of a section of changes.
pub(super) const SECTION: u8 = 8;
/// That streams are compressed with LZ4.
const LZ4: u8 = b'4';
/// Level of zlib: times repeat so much that more brings nothing.
const ZLIB: u8 = 3;
/// Shortest stream that is compressed [bytes].
const SHORT: usize = 32;
/// Changes gathered before they are compressed [bytes].
const BLOCK: usize = 1 << 20;
/// Place of the time of the end in the header [bytes].
const END: u64 = 17;
/// Place of the number of sections in the header [bytes].
const SECTIONS: u64 = 65;

/// Where changes go.
pub(super) struct Changes<W> {
    file: W,
    streams: Vec<Stream>,
    /// Values at the begin of the section, a digit for each bit.
    frame: Vec<u8>,
    /// Times of the section, each as what it is more than the one before it.
    times: Vec<u8>,
    /// Number of the last time, from 0 in each section.
    time: u64,
    /// The last time [ps].
    at: u64,
    /// Begin of the section [ps].
    start: u64,
    /// Bytes in all streams.
    size: usize,
    sections: u64,
}

/// One signal.
struct Stream {
    /// [bits].
    width: usize,
    data: Vec<u8>,
    /// Number of the time of the last change.
    time: u64,
    /// The value, its highest bit the highest of the first byte; `None` is unknown.
    value: Option<Box<[u8]>>,
}

impl<W: Write + Seek> Changes<W> {
    /// Writes behind a header to `file`; `widths` are those of the signals, in their order.
    pub(super) fn new(file: W, widths: &[usize]) -> Self {
        let stream = |&width| Stream { width, data: Vec::new(), time: 0, value: None };
        let streams = widths.iter().map(stream).collect();
        let (frame, times) = (Vec::new(), Vec::new());
        Changes { file, streams, frame, times, time: 0, at: 0, start: 0, size: 0, sections: 0 }
    }

    /// A time step begins, later than those before it or at the same time [ps].
    pub(super) fn begin(&mut self, at: u64) -> io::Result<()> {
        if at <= self.at {
            return Ok(());
        }
        if self.size + self.times.len() > BLOCK {
            self.flush()?;
        }
        if self.times.is_empty() {
            self.frame.clear();
            self.streams.iter().for_each(|stream| stream.spell(&mut self.frame));
            number(&mut self.times, at);
        } else {
            self.time += 1;
            number(&mut self.times, at - self.at);
        }
        self.at = at;
        Ok(())
    }

    /// A signal changes to a value of up to 64 bits.
    #[inline]
    pub(super) fn word(&mut self, signal: usize, value: u64) {
        let stream = &mut self.streams[signal];
        let bytes = stream.width.div_ceil(8);
        let aligned = value << (8 * bytes - stream.width);
        self.change(signal, &aligned.to_be_bytes()[8 - bytes..]);
    }

    /// A signal changes to a value, its highest bit the highest of the first byte, or becomes
    /// unknown.
    #[inline]
    pub(super) fn change(&mut self, signal: usize, value: &[u8]) {
        let stream = &mut self.streams[signal];
        match &mut stream.value {
            Some(kept) => kept.copy_from_slice(value),
            kept => *kept = Some(value.into()),
        }
        // The values of the first time step are the frame.
        if !self.times.is_empty() {
            let (before, delta) = (stream.data.len(), self.time - stream.time);
            stream.time = self.time;
            if stream.width == 1 {
                number(&mut stream.data, delta << 2 | u64::from(value[0] >> 7) << 1);
            } else {
                number(&mut stream.data, delta << 1);
                stream.data.extend_from_slice(value);
            }
            self.size += stream.data.len() - before;
        }
    }

    /// All signals become unknown.
    pub(super) fn unknown(&mut self) {
        for stream in &mut self.streams {
            stream.value = None;
            if !self.times.is_empty() {
                let delta = self.time - stream.time;
                stream.time = self.time;
                if stream.width == 1 {
                    number(&mut stream.data, delta << 4 | 1);
                } else {
                    number(&mut stream.data, delta << 1 | 1);
                    stream.data.resize(stream.data.len() + stream.width, b'x');
                }
                self.size += 2 + stream.width;
            }
        }
    }

    /// Ends the file at that time [ps].
    pub(super) fn finish(mut self, at: u64) -> io::Result<W> {
        self.begin(at)?;
        self.flush()?;
        let Changes { mut file, at, sections, .. } = self;
        for (place, number) in [(END, at), (SECTIONS, sections)] {
            file.seek(SeekFrom::Start(place))?;
            file.write_all(&number.to_be_bytes())?;
        }
        Ok(file)
    }

    /// Writes the section.
    fn flush(&mut self) -> io::Result<()> {
        let (mut body, mut places, mut length) = (Vec::new(), Vec::new(), 0);
        let signals = self.streams.len() as u64;
        for count in [self.frame.len() as u64, self.frame.len() as u64, signals] {
            number(&mut body, count);
        }
        body.append(&mut self.frame);
        number(&mut body, signals);
        let (mut last, mut empty) = (body.len(), 0);
        body.push(LZ4);
        for Stream { data, time, .. } in &mut self.streams {
            if data.is_empty() {
                empty += 1;
            } else {
                skip(&mut places, &mut empty);
                // The lowest bit says that it is a place.
                signed(&mut places, (2 * (body.len() - last) + 1) as u64);
                (last, length) = (body.len(), length + data.len() as u64);
                pack(&mut body, data);
                data.clear();
            }
            *time = 0;
        }
        skip(&mut places, &mut empty);
        body.extend_from_slice(&places);
        body.extend_from_slice(&(places.len() as u64).to_be_bytes());
        let times = miniz_oxide::deflate::compress_to_vec_zlib(&self.times, ZLIB);
        let packed = if times.len() < self.times.len() { &times } else { &self.times };
        body.extend_from_slice(packed);
        for count in [self.times.len(), packed.len(), self.time as usize + 1] {
            body.extend_from_slice(&(count as u64).to_be_bytes());
        }
        self.file.write_all(&[SECTION])?;
        for field in [body.len() as u64 + 32, self.start, self.at, length] {
            self.file.write_all(&field.to_be_bytes())?;
        }
        self.file.write_all(&body)?;
        self.times.clear();
        (self.time, self.size, self.start) = (0, 0, self.at);
        self.sections += 1;
        Ok(())
    }
}

impl Stream {
    /// Appends a digit for each bit.
    fn spell(&self, text: &mut Vec<u8>) {
        match &self.value {
            None => text.resize(text.len() + self.width, b'x'),
            Some(value) => text.extend(
                (0..self.width).map(|place| b'0' + (value[place / 8] >> (7 - place % 8) & 1)),
            ),
        }
    }
}

/// Appends a stream, compressed if that makes it shorter.
fn pack(body: &mut Vec<u8>, data: &[u8]) {
    if data.len() >= SHORT {
        let packed = lz4_flex::block::compress(data);
        if packed.len() < data.len() {
            number(body, data.len() as u64);
            return body.extend_from_slice(&packed);
        }
    }
    number(body, 0);
    body.extend_from_slice(data);
}

/// Appends that so many signals have no stream.
fn skip(places: &mut Vec<u8>, signals: &mut u64) {
    if *signals > 0 {
        number(places, 2 * std::mem::take(signals));
    }
}

/// Appends a number.
#[inline]
fn number(bytes: &mut Vec<u8>, mut value: u64) {
    while value > 0x7f {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}

/// Appends a number that is read as a signed one: the highest of its seven bits is the sign.
fn signed(bytes: &mut Vec<u8>, value: u64) {
    let mut rest = value;
    while rest > 0x3f {
        bytes.push(rest as u8 | 0x80);
        rest >>= 7;
    }
    bytes.push(rest as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(append: impl Fn(&mut Vec<u8>, u64), value: u64) -> Vec<u8> {
        let mut bytes = Vec::new();
        append(&mut bytes, value);
        bytes
    }

    #[test]
    fn numbers_take_seven_bits_a_byte_and_signed_ones_a_bit_more() {
        assert_eq!(bytes(number, 0x7f), [0x7f]);
        assert_eq!(bytes(number, 0x80), [0x80, 1]);
        assert_eq!(bytes(number, 624_485), [0xe5, 0x8e, 0x26]);
        assert_eq!(bytes(signed, 0x3f), [0x3f]);
        assert_eq!(bytes(signed, 0x40), [0xc0, 0]);
        assert_eq!(bytes(signed, 0x1fff), [0xff, 0x3f]);
        assert_eq!(bytes(signed, 0x2000), [0x80, 0xc0, 0]);
    }

    #[test]
    fn a_stream_is_spelled_from_its_highest_bit() {
        let value = Some([0b1010_0000, 0b1000_0000].into());
        let mut stream = Stream { width: 9, data: Vec::new(), time: 0, value };
        let mut text = Vec::new();
        stream.spell(&mut text);
        assert_eq!(text, b"101000001");
        stream.value = None;
        stream.spell(&mut text);
        assert_eq!(text, b"101000001xxxxxxxxx");
    }
}
