//! Values that stand for signals: words, arrays of them, and taps.

use crate::kernel::bits::{S, U};
use crate::kernel::{PartialOnes, Thermometer};

use super::signal::{Signal, SignalFormat};

/// Takes signal values; `id` is the signal's place in the list of its module plus an offset.
pub trait Sink {
    /// A word of up to 64 bits.
    fn word(&mut self, id: usize, value: u64);
    /// A signal that is one bit wide in every design.
    #[inline(always)]
    fn bit(&mut self, id: usize, value: bool) {
        self.word(id, value.into());
    }
    /// The taps of a delay line, or with a `group` above 1 the ones among so many taps each (see
    /// [`partial_ones`](super::partial_ones)).
    fn taps(&mut self, id: usize, value: &Thermometer, group: usize);
}

/// Gives signal values; `id` is as in [`Sink`].
pub trait Source {
    /// A word, its sign extended to 64 bits if it has one.
    fn word(&mut self, id: usize) -> u64;
    /// The taps of a delay line.
    fn taps(&mut self, id: usize) -> Thermometer;
}

/// A value that stands for one or more signals.
pub trait Field: Copy + PartialEq {
    /// Number of signals.
    const COUNT: usize;
    /// Appends the signals, shaped after `like` (its name, doc and direction).
    fn declare(like: Signal, list: &mut Vec<Signal>);
    /// Reports what differs from `before`, or everything.
    fn changes(&self, before: Option<&Self>, id: usize, sink: &mut impl Sink);
    /// The value with what the source gives.
    fn given(id: usize, source: &mut impl Source) -> Self;
    /// Returns whether both values are equal.
    #[inline(always)]
    fn is_same(&self, other: &Self) -> bool {
        self == other
    }
}

/// A field that is a single word.
pub trait Word: Copy + PartialEq {
    /// Its width [bits].
    const WIDTH: u32;
    /// Display format.
    const FORMAT: SignalFormat;
    fn bits(&self) -> u64;
    /// The word of those bits; a number has its sign extended.
    fn of_bits(bits: u64) -> Self;
}

impl Word for bool {
    const WIDTH: u32 = 1;
    const FORMAT: SignalFormat = SignalFormat::Bits;
    fn bits(&self) -> u64 {
        *self as u64
    }
    fn of_bits(bits: u64) -> Self {
        bits & 1 == 1
    }
}

impl<const N: u32> Word for U<N> {
    const WIDTH: u32 = N;
    const FORMAT: SignalFormat = SignalFormat::Unsigned;
    fn bits(&self) -> u64 {
        self.get()
    }
    fn of_bits(bits: u64) -> Self {
        U::new(bits)
    }
}

impl<const N: u32, const F: u32> Word for S<N, F> {
    const WIDTH: u32 = N;
    const FORMAT: SignalFormat = SignalFormat::Signed { fraction: F };
    fn bits(&self) -> u64 {
        S::bits(*self)
    }
    fn of_bits(bits: u64) -> Self {
        S::new(bits as i64)
    }
}

impl<T: Word> Field for T {
    const COUNT: usize = 1;
    fn declare(like: Signal, list: &mut Vec<Signal>) {
        list.push(Signal { width: T::WIDTH, format: T::FORMAT, ..like });
    }
    #[inline(always)]
    fn changes(&self, before: Option<&Self>, id: usize, sink: &mut impl Sink) {
        if before == Some(self) {
            return;
        }
        match T::WIDTH {
            1 => sink.bit(id, self.bits() == 1),
            _ => sink.word(id, self.bits()),
        }
    }
    fn given(id: usize, source: &mut impl Source) -> Self {
        T::of_bits(source.word(id))
    }
}

impl<T: Word, const K: usize> Field for [T; K] {
    const COUNT: usize = K;
    fn declare(like: Signal, list: &mut Vec<Signal>) {
        for k in 0..K {
            let name = format!("{}_{k}", like.name);
            T::declare(Signal { name, element: k as u32, ..like.clone() }, list);
        }
    }
    fn changes(&self, before: Option<&Self>, id: usize, sink: &mut impl Sink) {
        for k in 0..K {
            self[k].changes(before.map(|b| &b[k]), id + k, sink);
        }
    }
    fn given(id: usize, source: &mut impl Source) -> Self {
        std::array::from_fn(|k| T::given(id + k, source))
    }
    #[inline(always)]
    fn is_same(&self, other: &Self) -> bool {
        let pairs = self.iter().zip(other);
        pairs.fold(0, |differing, (one, other)| differing | (one.bits() ^ other.bits())) == 0
    }
}

impl Field for Thermometer {
    const COUNT: usize = 1;
    fn declare(like: Signal, list: &mut Vec<Signal>) {
        list.push(Signal { format: SignalFormat::Taps, ..like });
    }
    fn changes(&self, before: Option<&Self>, id: usize, sink: &mut impl Sink) {
        if before != Some(self) {
            sink.taps(id, self, 1);
        }
    }
    fn given(id: usize, source: &mut impl Source) -> Self {
        source.taps(id)
    }
}

impl<const GROUP: usize> Field for PartialOnes<GROUP> {
    const COUNT: usize = 1;
    fn declare(like: Signal, list: &mut Vec<Signal>) {
        list.push(like);
    }
    fn changes(&self, before: Option<&Self>, id: usize, sink: &mut impl Sink) {
        if before != Some(self) {
            sink.taps(id, &self.0, GROUP);
        }
    }
    fn given(id: usize, source: &mut impl Source) -> Self {
        PartialOnes(source.taps(id))
    }
}
