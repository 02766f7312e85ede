//! Keeps the present row of a capture, word by word as signals change.

use bitvec::prelude::*;

use crate::condition::WIDEST;
use crate::firmware::carry_chain::TAPS;
use crate::firmware::tof_top::TofTop;
use crate::hierarchy::{self, IDS, Part};
use crate::kernel::Thermometer;
use crate::kernel::signals::Sink;

use super::probes::Bits;

/// Where some bits of a signal go.
#[derive(Clone, Copy, Debug)]
struct Insert {
    /// As many ones as there are bits, where they fit a word.
    mask: u64,
    /// Lowest bit in the signal.
    low: u32,
    width: u32,
    /// Lowest bit among all words.
    begin: usize,
}

/// The present values of the probes and of what the conditions look at.
#[derive(Clone, Debug)]
pub(super) struct Look {
    part: Part,
    kept: Option<TofTop>,
    present: Present,
}

#[derive(Clone, Debug)]
struct Present {
    /// Inserts of id `k`: from `first[k]` to before `first[k + 1]`.
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

impl Look {
    /// At probes that stand side by side in a row of `stride` words, and at operands.
    pub(super) fn new(probes: &[Bits], operands: &[Bits], stride: usize, order: &[u16]) -> Self {
        let mut places: Vec<(usize, Insert)> = Vec::new();
        let mut place = |&Bits { id, low, width, .. }: &Bits, begin| {
            let mask = u64::MAX >> 64u32.saturating_sub(width);
            places.push((id, Insert { mask, low, width, begin }));
        };
        let mut begin = 0;
        for bits in probes {
            place(bits, begin);
            begin += bits.width as usize;
        }
        for (operand, bits) in operands.iter().enumerate() {
            let width = bits.width.min(WIDEST);
            place(&Bits { width, ..*bits }, 64 * (stride + 2 * operand));
        }
        places.sort_by_key(|(id, _)| *id);
        let first = (0..=IDS).map(|id| places.partition_point(|place| place.0 < id) as u32);
        let present = Present {
            first: first.collect(),
            inserts: places.iter().map(|place| place.1).collect(),
            order: order.to_vec(),
            words: vec![0; stride + 2 * operands.len()],
            stride,
            operands_changed: true,
        };
        Look { part: Part::of(places.iter().map(|place| place.0)), kept: None, present }
    }

    /// Brings the values up to date.
    #[inline]
    pub(super) fn follow(&mut self, top: &TofTop) {
        match &mut self.kept {
            Some(kept) => hierarchy::follow(top, &self.part, kept, &mut self.present),
            None => {
                hierarchy::changes(top, None, &mut self.present);
                self.kept = Some(top.clone());
            }
        }
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

impl Present {
    #[inline]
    fn inserts(&self, id: usize) -> std::ops::Range<usize> {
        self.first[id] as usize..self.first[id + 1] as usize
    }
}

impl Sink for Present {
    #[inline]
    fn word(&mut self, id: usize, value: u64) {
        for k in self.inserts(id) {
            let Insert { mask, low, width, begin } = self.inserts[k];
            let value = value >> low & mask;
            let (word, shift) = (begin / 64, begin % 64);
            self.words[word] = self.words[word] & !(mask << shift) | value << shift;
            if shift + width as usize > 64 {
                let (mask, value) = (mask >> (64 - shift), value >> (64 - shift));
                self.words[word + 1] = self.words[word + 1] & !mask | value;
            }
            self.operands_changed |= word >= self.stride;
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
    use crate::hierarchy::{entries, ram_entries};
    use crate::scenario;
    use crate::sim::device::Off;
    use crate::sim::setup::Setup;

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
        let mut look = Look::new(&bits, &operands, stride, order);
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
