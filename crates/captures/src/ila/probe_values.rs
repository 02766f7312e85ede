//! The present sample of a capture, updated as signals change.

use bitvec::prelude::*;

use tofsim::firmware::tdc_decoder::Encoder;
use tofsim::firmware::tof_top::TofTop;
use tofsim::hierarchy::{IDS, Part};
use tofsim::kernel::Thermometer;
use tofsim::kernel::signals::Sink;
use tofsim::waves::TapDigits;

use crate::condition::WIDEST;

use super::probes::SignalSlice;

/// Bits of a signal within one word.
#[derive(Clone, Copy, Debug)]
struct Place {
    word: usize,
    /// Mask of these bits in the word.
    mask: u64,
    /// Lowest of these bits in the word.
    begin: u32,
    /// Lowest of these bits in the signal.
    low: u32,
}

/// Present values of the probes and of the conditions' operands.
#[derive(Clone, Debug)]
pub(super) struct ProbeValues {
    part: Part,
    present: Packed,
}

#[derive(Clone, Debug)]
struct Packed {
    /// Positions of each id's bits.
    places: Vec<Vec<Place>>,
    /// Converter of taps to their physical order.
    taps: TapDigits,
    /// Words of the sample, followed by two words for each operand.
    words: Vec<u64>,
    /// Words per sample.
    stride: usize,
    /// Whether an operand may have changed.
    operands_changed: bool,
}

impl ProbeValues {
    /// Creates values for probes, concatenated in a sample of `stride` words, and for operands.
    pub(super) fn new(
        probes: &[SignalSlice],
        operands: &[SignalSlice],
        stride: usize,
        encoder: &Encoder,
    ) -> Self {
        let mut present = Packed {
            places: vec![Vec::new(); IDS],
            taps: TapDigits::new(encoder),
            words: vec![0; stride + 2 * operands.len()],
            stride,
            operands_changed: true,
        };
        let mut begin = 0;
        for &bits in probes {
            present.insert(bits, begin);
            begin += bits.width as usize;
        }
        for (operand, &bits) in operands.iter().enumerate() {
            let bits = SignalSlice { width: bits.width.min(WIDEST), ..bits };
            present.insert(bits, 64 * (stride + 2 * operand));
        }
        let ids = probes.iter().chain(operands).map(|bits| bits.id);
        ProbeValues { part: Part::of(ids).of_whole_edges(), present }
    }

    /// Updates the values.
    #[inline]
    pub(super) fn follow(&mut self, top: &TofTop) {
        self.part.follow(top, &mut self.present);
    }

    /// Returns the values of the probes.
    #[inline]
    pub(super) fn row(&self) -> &[u64] {
        &self.present.words[..self.present.stride]
    }

    /// Returns the value of an operand.
    #[inline]
    pub(super) fn operand(&self, operand: usize) -> u128 {
        let begin = self.present.stride + 2 * operand;
        let [low, high] = [0, 1].map(|word| u128::from(self.present.words[begin + word]));
        high << 64 | low
    }

    /// Returns whether an operand may have changed since the last call.
    #[inline]
    pub(super) fn take_operands_changed(&mut self) -> bool {
        std::mem::take(&mut self.present.operands_changed)
    }
}

impl Packed {
    /// Maps bits of a signal to the bits from `begin` on of all words.
    fn insert(&mut self, SignalSlice { id, mut low, width, .. }: SignalSlice, begin: usize) {
        let end = begin + width as usize;
        for word in begin / 64..end.div_ceil(64) {
            let (from, to) = (begin.max(64 * word), end.min(64 * (word + 1)));
            let mask = u64::MAX >> (64 - (to - from)) << (from % 64);
            self.places[id].push(Place { word, mask, begin: from as u32 % 64, low });
            low += (to - from) as u32;
        }
    }

    /// Writes the bits of a signal to its positions.
    #[inline]
    fn put(&mut self, id: usize, bits: impl Fn(&Place) -> u64) {
        for place in &self.places[id] {
            let word = &mut self.words[place.word];
            *word = *word & !place.mask | bits(place) << place.begin & place.mask;
            self.operands_changed |= place.word >= self.stride;
        }
    }
}

impl Sink for Packed {
    #[inline]
    fn word(&mut self, id: usize, value: u64) {
        self.put(id, |place| value >> place.low);
    }

    fn taps(&mut self, id: usize, value: &Thermometer, group: usize) {
        if self.places[id].is_empty() {
            return;
        }
        let mut digits = std::mem::take(&mut self.taps);
        let bits = digits.bits(value, group).words.view_bits::<Lsb0>();
        self.put(id, |&Place { mask, low, .. }| {
            bits[low as usize..(low + mask.count_ones()) as usize].load_le()
        });
        self.taps = digits;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::hierarchy::{self, entries, ram_entries};
    use tofsim::kernel::ones_width;
    use tofsim::scenario;
    use tofsim::sim::device::Off;
    use tofsim::sim::setup::Setup;

    /// Collects every value by its id, bit by bit.
    struct Collect<'a>(Vec<BitVec<u64>>, &'a [u16]);

    impl Sink for Collect<'_> {
        fn word(&mut self, id: usize, value: u64) {
            self.0[id] = BitVec::from_element(value);
        }

        fn taps(&mut self, id: usize, value: &Thermometer, group: usize) {
            let mut taps = bitvec![u64, Lsb0; 0; self.1.len()];
            for (place, &tap) in self.1.iter().enumerate() {
                taps.set(tap as usize, value.tap(place));
            }
            let counts = taps.chunks(group).map(|taps| taps.count_ones());
            let bits =
                counts.flat_map(|ones| (0..ones_width(group)).map(move |bit| ones >> bit & 1 == 1));
            self.0[id] = bits.collect();
        }
    }

    #[test]
    fn every_signal_stands_at_its_place_after_every_edge() {
        let setup = Setup::new(scenario::load("bright", &[]).unwrap()).unwrap();
        let order = setup.params.tdc.delays.order();
        let mut bits: Vec<SignalSlice> = entries(&setup.params)
            .into_iter()
            .chain(ram_entries(&setup.params.histogram).into_iter().take(40))
            .map(|entry| SignalSlice {
                id: entry.id,
                low: 0,
                width: entry.signal.width,
                signed: false,
            })
            .collect();
        let slices = bits.iter().filter(|bits| bits.width > 4).copied();
        let slices = slices.map(|bits| SignalSlice { low: 3, width: bits.width - 4, ..bits });
        bits.extend(slices.collect::<Vec<_>>());
        let operands: Vec<SignalSlice> =
            bits.iter().copied().filter(|bits| bits.width <= 128).collect();
        let stride = bits.iter().map(|bits| bits.width as usize).sum::<usize>().div_ceil(64);
        let mut look =
            ProbeValues::new(&bits, &operands, stride, &setup.params.tdc.decoder.encoder);
        let mut device = setup.device();
        device.power_up(&mut Off, &mut Off);
        for cycle in 0..600 {
            device.step(&setup.params, &mut Off, &mut Off);
            look.follow(&device.top);
            let mut collect = Collect(vec![BitVec::new(); IDS], order);
            hierarchy::changes(&device.top, None, &mut collect);
            let (row, mut begin) = (look.row().view_bits::<Lsb0>(), 0);
            let value =
                |b: &SignalSlice| &collect.0[b.id][b.low as usize..(b.low + b.width) as usize];
            for bits in &bits {
                let end = begin + bits.width as usize;
                assert_eq!(row[begin..end], value(bits), "cycle {cycle}, {bits:?}");
                begin = end;
            }
            for (operand, bits) in operands.iter().enumerate() {
                let wanted = value(bits).iter().by_vals().rev();
                let wanted = wanted.fold(0u128, |value, bit| value << 1 | u128::from(bit));
                assert_eq!(look.operand(operand), wanted, "cycle {cycle}, {bits:?}");
            }
        }
    }
}
