//! Keeps the present row of a capture, word by word as signals change.

use bitvec::prelude::*;

use tofsim::firmware::carry_chain::TAPS;
use tofsim::firmware::tof_top::TofTop;
use tofsim::hierarchy::{IDS, Part};
use tofsim::kernel::Thermometer;
use tofsim::kernel::signals::Sink;

use crate::condition::WIDEST;

use super::probes::Bits;

/// Where some bits of a signal go.
#[derive(Clone, Copy, Debug)]
struct Insert {
    /// Lowest bit in the signal.
    low: u32,
    width: u32,
    /// Lowest bit among all words.
    begin: usize,
}

/// Which bits of a word of the present are those of a signal.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    /// Ones at those bits.
    mask: u64,
    /// How far the signal is turned left to lie there.
    turn: u32,
    word: u32,
    /// The signal's next place among the further ones, 0 if there is none.
    next: u32,
}

/// The present values of the probes and of what the conditions look at.
#[derive(Clone, Debug)]
pub(super) struct ProbeValues {
    part: Part,
    present: Packed,
}

#[derive(Clone, Debug)]
struct Packed {
    /// The first place of each id, one of no bits if it has none.
    places: Box<[Place; IDS]>,
    /// All further places. The first of them is none.
    further: Vec<Place>,
    /// Inserts of id `k`: from `first[k]` to before `first[k + 1]`. Only taps need them.
    first: Vec<u32>,
    inserts: Vec<Insert>,
    /// Tap at each place in the order of arrival.
    order: Vec<u16>,
    /// The row, then two words for each operand of the conditions.
    words: Vec<u64>,
    /// Words of the row.
    stride: usize,
    /// An operand may have changed.
    operands_changed: bool,
}

impl ProbeValues {
    /// At probes that stand side by side in a row of `stride` words, and at operands.
    pub(super) fn new(probes: &[Bits], operands: &[Bits], stride: usize, order: &[u16]) -> Self {
        let mut inserts: Vec<(usize, Insert)> = Vec::new();
        let mut begin = 0;
        for &Bits { id, low, width, .. } in probes {
            inserts.push((id, Insert { low, width, begin }));
            begin += width as usize;
        }
        for (operand, &Bits { id, low, width, .. }) in operands.iter().enumerate() {
            let begin = 64 * (stride + 2 * operand);
            inserts.push((id, Insert { low, width: width.min(WIDEST), begin }));
        }
        inserts.sort_by_key(|(id, _)| *id);
        let first = (0..=IDS).map(|id| inserts.partition_point(|insert| insert.0 < id) as u32);
        let (places, further) = places(&inserts);
        let present = Packed {
            places,
            further,
            first: first.collect(),
            inserts: inserts.iter().map(|insert| insert.1).collect(),
            order: order.to_vec(),
            words: vec![0; stride + 2 * operands.len()],
            stride,
            operands_changed: true,
        };
        ProbeValues { part: Part::of(inserts.iter().map(|insert| insert.0)), present }
    }

    /// Brings the values up to date.
    #[inline]
    pub(super) fn follow(&mut self, top: &TofTop) {
        self.part.follow(top, &mut self.present);
    }

    /// The probes' values.
    #[inline]
    pub(super) fn row(&self) -> &[u64] {
        &self.present.words[..self.present.stride]
    }

    /// An operand's value.
    #[inline]
    pub(super) fn operand(&self, operand: usize) -> u128 {
        let begin = self.present.stride + 2 * operand;
        let [low, high] = [0, 1].map(|word| u128::from(self.present.words[begin + word]));
        high << 64 | low
    }

    /// Whether an operand may have changed since this was last asked.
    #[inline]
    pub(super) fn take_operands_changed(&mut self) -> bool {
        std::mem::take(&mut self.present.operands_changed)
    }
}

/// The first place of each id and all further ones. Of a signal wider than a word, whose inserts
/// count instead, they mean nothing.
fn places(inserts: &[(usize, Insert)]) -> (Box<[Place; IDS]>, Vec<Place>) {
    let (mut places, mut further) = (Box::new([Place::default(); IDS]), vec![Place::default()]);
    for &(id, Insert { low, width, begin }) in inserts {
        let end = begin + width as usize;
        for word in begin / 64..end.div_ceil(64) {
            let (from, to) = (begin.max(64 * word), end.min(64 * (word + 1)));
            let mask = u64::MAX >> (64 - (to - from)) << (from % 64);
            let turn = (begin as u32).wrapping_sub(low) % 64;
            let mut place = Place { mask, turn, word: word as u32, next: 0 };
            if places[id].mask != 0 {
                place.next = further.len() as u32;
                further.push(places[id]);
            }
            places[id] = place;
        }
    }
    (places, further)
}

impl Packed {
    #[inline]
    fn inserts(&self, id: usize) -> std::ops::Range<usize> {
        self.first[id] as usize..self.first[id + 1] as usize
    }
}

impl Sink for Packed {
    #[inline]
    fn word(&mut self, id: usize, value: u64) {
        let mut place = &self.places[id];
        loop {
            let word = &mut self.words[place.word as usize];
            *word = *word & !place.mask | value.rotate_left(place.turn) & place.mask;
            self.operands_changed |= place.word as usize >= self.stride;
            if place.next == 0 {
                return;
            }
            place = &self.further[place.next as usize];
        }
    }

    fn taps<const N: usize>(&mut self, id: usize, value: &Thermometer<N>) {
        if self.inserts(id).is_empty() {
            return;
        }
        let (mut arrived, mut taps) = ([0u64; TAPS.div_ceil(64)], [0u64; TAPS.div_ceil(64)]);
        value.expand(arrived.view_bits_mut());
        let taps = taps.view_bits_mut::<Lsb0>();
        for (&tap, level) in self.order.iter().zip(arrived.view_bits::<Lsb0>()) {
            taps.set(tap as usize, *level);
        }
        for k in self.inserts(id) {
            let Insert { low, width, begin, .. } = self.inserts[k];
            let bits = &taps[low as usize..(low + width) as usize];
            let words = self.words.view_bits_mut::<Lsb0>();
            words[begin..begin + width as usize].copy_from_bitslice(bits);
            self.operands_changed |= begin >= 64 * self.stride;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tofsim::hierarchy::{self, entries, ram_entries};
    use tofsim::scenario;
    use tofsim::sim::device::Off;
    use tofsim::sim::setup::Setup;

    /// Every value by its id, bit by bit.
    struct Collect<'a>(Vec<BitVec<u64>>, &'a [u16]);

    impl Sink for Collect<'_> {
        fn word(&mut self, id: usize, value: u64) {
            self.0[id] = BitVec::from_element(value);
        }

        fn taps<const N: usize>(&mut self, id: usize, value: &Thermometer<N>) {
            self.0[id] = bitvec![u64, Lsb0; 0; N];
            for (place, &tap) in self.1.iter().enumerate() {
                self.0[id].set(tap as usize, value.tap(place));
            }
        }
    }

    #[test]
    fn every_signal_stands_at_its_place_after_every_edge() {
        let setup = Setup::new(scenario::load("bright", &[]).unwrap()).unwrap();
        let order = setup.params.tdc.delays.order();
        let mut bits: Vec<Bits> = entries(&setup.params)
            .into_iter()
            .chain(ram_entries().into_iter().take(40))
            .map(|entry| Bits { id: entry.id, low: 0, width: entry.signal.width, signed: false })
            .collect();
        let slices = bits.iter().filter(|bits| bits.width > 4).copied();
        let slices = slices.map(|bits| Bits { low: 3, width: bits.width - 4, ..bits });
        bits.extend(slices.collect::<Vec<_>>());
        let operands: Vec<Bits> = bits.iter().copied().filter(|bits| bits.width <= 128).collect();
        let stride = bits.iter().map(|bits| bits.width as usize).sum::<usize>().div_ceil(64);
        let mut look = ProbeValues::new(&bits, &operands, stride, order);
        let mut device = setup.device();
        device.power_up(&mut Off, &mut Off);
        for cycle in 0..600 {
            device.step(&setup.params, &mut Off, &mut Off);
            look.follow(&device.top);
            let mut collect = Collect(vec![BitVec::new(); IDS], order);
            hierarchy::changes(&device.top, None, &mut collect);
            let (row, mut begin) = (look.row().view_bits::<Lsb0>(), 0);
            let value = |b: &Bits| &collect.0[b.id][b.low as usize..(b.low + b.width) as usize];
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
