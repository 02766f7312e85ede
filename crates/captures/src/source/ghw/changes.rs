//! Values of a GHW file: a snapshot, and cycles with the signals that change.

use super::super::span::{Checked, Fault, Span};
use super::super::stream::Feed;
use super::types::Scalar;
use crate::words::{Bits, ones};

/// Time after the last step of a section [fs].
const END_OF_CYCLE: i64 = -1;

/// Receiver of values.
pub(super) trait Sink {
    /// Receives the value of a signal, by index.
    fn value(&mut self, signal: usize, scalar: Scalar, value: u64);

    /// Ends a step at `time` [fs]; returns whether to go on.
    fn step(&mut self, time: u64) -> bool;
}

/// Sink for a check of the file.
impl Sink for () {
    fn value(&mut self, _: usize, _: Scalar, _: u64) {}

    fn step(&mut self, _: u64) -> bool {
        true
    }
}

/// Parses the sections after the header, and returns the time of the last step [fs].
pub(super) fn read(
    file: &mut Span,
    scalars: &[Scalar],
    sink: &mut impl Sink,
) -> Checked<Option<u64>> {
    let mut reader = Reader { scalars, sink, last: None };
    loop {
        let place = file.place();
        let name = file.take(4)?;
        let goes_on = match name {
            b"SNP\0" => reader.snapshot(file),
            b"CYC\0" => reader.cycle(file),
            b"DIR\0" => directory(file),
            b"TAI\0" => Ok(false),
            _ => Err(Fault::of("name", "expected SNP, CYC, DIR or TAI")),
        };
        if !goes_on.map_err(|fault| fault.within_section(name, place))? {
            return Ok(reader.last);
        }
    }
}

/// Parses the directory of sections.
fn directory(file: &mut Span) -> Checked<bool> {
    file.take(4)?;
    let count = file.items("sections")?;
    for _ in 0..count {
        file.take(8)?;
    }
    end(file, b"EOD\0")
}

/// Parses the mark at the end of a section; true, as there are more sections.
fn end(file: &mut Span, mark: &[u8]) -> Checked<bool> {
    if file.take(4)? == mark {
        Ok(true)
    } else {
        let expected = format!("expected {}", String::from_utf8_lossy(&mark[..3]));
        Err(Fault::of("end", &expected))
    }
}

struct Reader<'a, S> {
    scalars: &'a [Scalar],
    sink: &'a mut S,
    last: Option<u64>,
}

impl<S: Sink> Reader<'_, S> {
    fn snapshot(&mut self, file: &mut Span) -> Checked<bool> {
        file.take(4)?;
        let time = file.word(8)?;
        for signal in 0..self.scalars.len() {
            self.value(file, signal)?;
        }
        Ok(self.step(time)? && end(file, b"ESN\0")?)
    }

    fn cycle(&mut self, file: &mut Span) -> Checked<bool> {
        let mut time = file.word(8)?;
        loop {
            let mut number = 0u64;
            loop {
                match file.number()? {
                    0 => break,
                    further => number = number.saturating_add(further),
                }
                if number > self.scalars.len() as u64 {
                    let expected = format!("expected {} at most", self.scalars.len());
                    return Err(Fault::value("signal", number, expected));
                }
                self.value(file, number as usize - 1)?;
            }
            if !self.step(time)? {
                return Ok(false);
            }
            match file.signed()? {
                END_OF_CYCLE => return end(file, b"ECY\0"),
                further => time = time.saturating_add_signed(further),
            }
        }
    }

    fn value(&mut self, file: &mut Span, signal: usize) -> Checked<()> {
        let scalar = self.scalars[signal];
        let value = match scalar {
            Scalar::Nine | Scalar::Literal(_) => file.byte()?.into(),
            Scalar::Number(width) => file.signed()? as u64 & ones(width, 0),
            Scalar::Real => file.word(8)?,
        };
        self.sink.value(signal, scalar, value);
        Ok(())
    }

    /// Ends a step; time does not go back.
    fn step(&mut self, time: u64) -> Checked<bool> {
        if let Some(last) = self.last.filter(|&last| time < last) {
            let expected = format!("time goes back from {last} fs");
            return Err(Fault::value("time", time, expected));
        }
        self.last = Some(time);
        Ok(self.sink.step(time))
    }
}

/// Sink that sends the values of some names to a feed.
pub(super) struct Values<'a> {
    feed: &'a mut Feed,
    /// Names that a signal belongs to, each with the signal's lowest bit.
    names: Vec<Vec<(usize, u32)>>,
    values: Vec<Bits>,
    /// Names with changes in the present step, without repetition.
    changed: Vec<usize>,
    is_changed: Vec<bool>,
}

impl<'a> Values<'a> {
    /// Creates a sink for the names with the given signals, highest bit first; `count` is the number of all signals.
    pub(super) fn new(feed: &'a mut Feed, wanted: &[&[u32]], count: usize) -> Values<'a> {
        let mut names = vec![Vec::new(); count];
        let mut values = Vec::new();
        for (name, signals) in wanted.iter().enumerate() {
            for (bit, &number) in signals.iter().rev().enumerate() {
                names[number as usize - 1].push((name, bit as u32));
            }
            let mut bits = Bits::default();
            bits.clear(feed.words(name));
            values.push(bits);
        }
        Values { feed, names, values, changed: Vec::new(), is_changed: vec![false; wanted.len()] }
    }
}

impl Sink for Values<'_> {
    fn value(&mut self, signal: usize, scalar: Scalar, value: u64) {
        let (width, value, unknown) = match scalar {
            Scalar::Nine => nine(value),
            Scalar::Literal(width) => (width, value & ones(width, 0), 0),
            Scalar::Number(width) => (width, value, 0),
            Scalar::Real => (64, value, 0),
        };
        for &(name, bit) in &self.names[signal] {
            let (word, place) = (bit as usize / 64, bit % 64);
            let (mask, bits) = (ones(width, 0) << place, &mut self.values[name]);
            bits.value[word] = bits.value[word] & !mask | value << place;
            bits.unknown[word] = bits.unknown[word] & !mask | unknown << place;
            if !std::mem::replace(&mut self.is_changed[name], true) {
                self.changed.push(name);
            }
        }
    }

    fn step(&mut self, time: u64) -> bool {
        if self.changed.is_empty() {
            return true;
        }
        if self.feed.at(time).is_err() {
            return false;
        }
        for name in self.changed.drain(..) {
            self.is_changed[name] = false;
            self.feed.change(name, &self.values[name].value, &self.values[name].unknown);
        }
        true
    }
}

/// Returns width, value and unknown bits for a position in `std_ulogic`: U, X, 0, 1, Z, W, L, H or -.
fn nine(position: u64) -> (u32, u64, u64) {
    match position {
        2 | 6 => (1, 0, 0),
        3 | 7 => (1, 1, 0),
        4 => (1, 1, 1),
        _ => (1, 0, 1),
    }
}
