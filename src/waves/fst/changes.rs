//! Value changes of an FST file, in sections that are compressed signal by signal.

use std::io::{self, Seek, Write};

use super::header::Header;
use super::section::{FIRST_LARGE, LARGE, Section};
use super::sections::Sections;
use super::signal_stream::SignalStream;
use super::stream::Stream;

/// Least amount of changes that are collected before compression [bytes].
const GATHERED: usize = 1 << 20;
/// Least amount of changes per byte of the initial values, which each section has.
const PER_FRAME: usize = 4;

/// Writer of the value changes.
pub(super) struct Changes<W, S = Stream> {
    sections: Sections<W>,
    header: Header,
    pub(super) streams: Vec<S>,
    /// The section that is gathered; the streams have its changes.
    section: Section,
    /// The last time, in units of the file.
    at: u64,
    /// Start of the section, in units of the file.
    start: u64,
    /// Approximate size of all streams [bytes].
    size: usize,
    /// Size from which a section is written [bytes].
    most: usize,
}

impl<W: Write + Seek + Send + 'static, S: SignalStream> Changes<W, S> {
    /// Creates a writer that appends to `file`; `streams` are those of the signals, in order.
    pub(super) fn new(file: W, header: Header, streams: Vec<S>) -> Self {
        let sections = Sections::new(file, streams.len());
        let section = Section::new(streams.len());
        Changes { sections, header, streams, section, at: 0, start: 0, size: 0, most: GATHERED }
    }

    /// Begins the file at a time, whose values are changes instead of the initial values of the first section.
    pub(super) fn open(&mut self, at: u64) {
        self.spell();
        self.section.times.push(at, 0);
        (self.at, self.start, self.header.start) = (at, at, at);
    }

    /// Returns the number of the present time step within its section.
    pub(super) fn step(&self) -> u64 {
        self.section.times.last
    }

    /// Counts the bytes by which a signal's stream has grown.
    pub(super) fn grown(&mut self, bytes: usize) {
        self.size += bytes;
    }

    /// Begins a time step, not earlier than the previous one, in units of the file.
    pub(super) fn begin(&mut self, at: u64) -> io::Result<()> {
        if at <= self.at {
            return Ok(());
        }
        if self.size + self.section.times.steps.len() > self.most {
            self.write_section()?;
        }
        if self.section.times.steps.is_empty() {
            self.spell();
        }
        self.section.times.push(at, self.at);
        self.at = at;
        Ok(())
    }

    /// Writes the last section, and the header with the end time, in units of the file.
    pub(super) fn finish(mut self, at: u64) -> io::Result<W> {
        self.begin(at)?;
        self.write_section()?;
        self.header.end = self.at;
        let mut file = self.sections.finish()?;
        self.header.write(&mut file)?;
        Ok(file)
    }

    /// Sets the initial values of a section.
    fn spell(&mut self) {
        self.streams.iter().for_each(|stream| stream.spell(&mut self.section.frame));
        self.most = GATHERED.max(PER_FRAME * self.section.frame.len());
    }

    fn write_section(&mut self) -> io::Result<()> {
        let section = &mut self.section;
        section.span = [self.start, self.at];
        section.large = if self.header.sections == 0 { FIRST_LARGE } else { LARGE };
        for (stream, data) in self.streams.iter_mut().zip(&mut section.streams) {
            stream.hand_over(data);
        }
        self.sections.write(section)?;
        self.header.sections += 1;
        (self.size, self.start) = (0, self.at);
        Ok(())
    }
}

impl<W: Write + Seek + Send + 'static> Changes<W> {
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
        if !self.section.times.steps.is_empty() {
            self.size += stream.note(self.section.times.last, value);
        }
    }

    /// Sets all signals to unknown.
    pub(super) fn unknown(&mut self) {
        for stream in &mut self.streams {
            stream.value = None;
            if !self.section.times.steps.is_empty() {
                stream.note_unknown(self.section.times.last);
                self.size += 2 + stream.width;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// Number of sections of a file with a signal of this width, all of whose bits change 64 times.
    fn sections(width: usize) -> u64 {
        let file = Cursor::new(Vec::new());
        let mut changes = Changes::new(file, Header::default(), vec![Stream::new(width)]);
        let value = vec![0x5a; width / 8];
        for at in 1..=64 {
            changes.begin(at).unwrap();
            changes.change(0, &value);
        }
        changes.write_section().unwrap();
        changes.header.sections
    }

    #[test]
    fn a_section_has_several_times_as_many_changes_as_initial_values() {
        // Digits of the initial values take eight times as much as the bits of a change.
        assert_eq!((sections(1 << 10), sections(1 << 20), sections(1 << 21)), (1, 2, 2));
    }
}
