//! Layout of ports in a line of bits, and a line of outputs.

use tofsim::hierarchy::IDS;
use tofsim::kernel::Thermometer;
use tofsim::kernel::signals::Sink;
use tofsim::waves::{Bits, TapDigits};

use crate::golden::inputs::bits;
use crate::golden::ports::Port;

/// Bits of a port in its line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PortBits {
    /// The port.
    pub name: String,
    /// Its lowest bit.
    pub low: usize,
    /// Its width [bits].
    pub width: usize,
}

impl PortBits {
    /// Its bits from the lowest on, up to 32 at a time.
    fn words<'a>(&self, line: &'a [u32]) -> impl DoubleEndedIterator<Item = u64> + 'a {
        let (low, end) = (self.low, self.low + self.width);
        let steps = (0..self.width.div_ceil(32)).map(move |step| low + 32 * step);
        steps.map(move |low| bits(line, low, (end - low).min(32)))
    }

    /// Returns whether both lines have the same bits there.
    pub fn agrees(&self, one: &[u32], other: &[u32]) -> bool {
        self.words(one).eq(self.words(other))
    }

    /// Returns whether one of its bits is 1.
    pub fn has_any(&self, line: &[u32]) -> bool {
        self.words(line).any(|word| word != 0)
    }

    /// Its bits in hexadecimal, all digits, with an x for each that has an unknown bit.
    pub fn hex_or_x(&self, line: &[u32], unknown: &[u32]) -> String {
        let digits = self.hex(line).into_bytes().into_iter().zip(self.hex(unknown).into_bytes());
        digits
            .map(|(digit, unknown)| char::from(if unknown == b'0' { digit } else { b'x' }))
            .collect()
    }

    /// Its bits in hexadecimal, all digits.
    pub fn hex(&self, line: &[u32]) -> String {
        let digits = self.width.div_ceil(4);
        let all: String = self.words(line).rev().map(|word| format!("{word:08x}")).collect();
        all[all.len() - digits..].to_owned()
    }
}

/// The places of ports, as a concatenation in Verilog has them: the first in the highest bits.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    places: Vec<PortBits>,
    width: usize,
}

impl Layout {
    pub(super) fn new<'a>(ports: impl Iterator<Item = &'a Port>) -> Self {
        let place =
            |port: &Port| PortBits { name: port.name.clone(), low: 0, width: port.width as usize };
        let mut places: Vec<_> = ports.map(place).collect();
        let mut width = 0;
        for place in places.iter_mut().rev() {
            place.low = width;
            width += place.width;
        }
        Layout { places, width }
    }

    /// The ports, in order.
    pub fn places(&self) -> &[PortBits] {
        &self.places
    }

    /// The port of that name.
    pub fn find(&self, name: &str) -> Option<&PortBits> {
        self.places.iter().find(|place| place.name == name)
    }

    /// Bits of a line.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Words that a line has.
    pub fn words(&self) -> usize {
        self.width.div_ceil(32)
    }
}

/// A line of outputs, kept up with the model.
pub(super) struct Outputs {
    pub(super) layout: Layout,
    /// Places of each id.
    places: Vec<Vec<usize>>,
    taps: TapDigits,
    /// The line, the lowest bit first.
    pub(super) words: Vec<u32>,
}

impl Outputs {
    pub(super) fn new(layout: Layout, ids: &[(usize, String)], taps: TapDigits) -> Self {
        let mut places = vec![Vec::new(); IDS];
        for (id, name) in ids {
            places[*id].extend(layout.places.iter().position(|place| place.name == *name));
        }
        let words = vec![0; layout.words()];
        Outputs { layout, places, taps, words }
    }
}

/// Puts so many bits at `low`.
pub(super) fn put(words: &mut [u32], low: usize, width: usize, value: u64) {
    let mask = u128::from(u64::MAX >> (64 - width)) << (low % 32);
    let value = u128::from(value) << (low % 32);
    for (step, word) in words[low / 32..].iter_mut().take(3).enumerate() {
        let [mask, value] = [mask, value].map(|all| (all >> (32 * step)) as u32);
        *word = *word & !mask | value & mask;
    }
}

impl Sink for Outputs {
    fn word(&mut self, id: usize, value: u64) {
        for place in self.places[id].iter().map(|place| &self.layout.places[*place]) {
            put(&mut self.words, place.low, place.width, value);
        }
    }

    fn taps(&mut self, id: usize, value: &Thermometer, group: usize) {
        for place in self.places[id].iter().map(|place| &self.layout.places[*place]) {
            let Bits { words, width } = self.taps.bits(value, group);
            for (step, word) in words.iter().enumerate().take(width.div_ceil(64)) {
                let width = (place.width - 64 * step).min(64);
                put(&mut self.words, place.low + 64 * step, width, *word);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_is_read_where_it_was_put() {
        let port =
            |name: &str, width| Port { name: name.to_owned(), width, output: true, meaning: "" };
        let ports = [port("a", 1), port("b", 64), port("c", 36), port("d", 30)];
        let layout = Layout::new(ports.iter());
        assert_eq!((layout.width(), layout.words()), (131, 5));
        let mut line = vec![u32::MAX; 5];
        let value = 0x1234_5678_9abc_def0;
        let b = layout.find("b").unwrap();
        put(&mut line, b.low, b.width, value);
        assert_eq!(b.hex(&line), "123456789abcdef0");
        assert_eq!(layout.find("a").unwrap().hex(&line), "1");
        assert_eq!(layout.find("c").unwrap().hex(&line), "fffffffff");
        assert_eq!(layout.find("d").unwrap().hex(&line), "3fffffff");
        let unknown = [0, 0, 0x0000_0f10, 0, 0];
        assert!(b.has_any(&unknown) && !layout.find("d").unwrap().has_any(&unknown));
        let mut x = vec![0; 5];
        put(&mut x, b.low, b.width, 0x0010_0000_0000_000f);
        assert_eq!(b.hex_or_x(&line, &x), "12x456789abcdefx");
        assert_eq!(b.hex_or_x(&line, &[]), "123456789abcdef0");
        let mut other = line.clone();
        put(&mut other, 0, 30, 5);
        assert!(b.agrees(&line, &other) && !layout.find("d").unwrap().agrees(&line, &other));
    }
}
