//! The bits of a block's input ports, as words and taps of the model.

use tofsim::kernel::Thermometer;
use tofsim::kernel::signals::{Signal, SignalFormat, Source};
use tofsim::waves::TapDigits;

/// Bits of a port in its line.
#[derive(Clone, Copy, Debug)]
struct InputBits {
    low: usize,
    width: usize,
    signed: bool,
}

/// Input ports, by their place in the list of the block's inputs.
#[derive(Clone, Debug)]
pub(crate) struct Inputs {
    /// None of a port that such a design does not have: it stays 0.
    places: Vec<Option<InputBits>>,
    taps: TapDigits,
    /// The line, the lowest bit first.
    pub(crate) words: Vec<u32>,
    /// The place of taps that no chain of the model shows.
    pub(crate) strange: Option<usize>,
}

impl Inputs {
    /// Of ports in that order; `low` tells the lowest bit of the one of that name, if there is one, and its width.
    pub(crate) fn new(
        signals: &[Signal],
        low: impl Fn(&str) -> Option<(usize, usize)>,
        taps: TapDigits,
    ) -> Self {
        let place = |signal: &Signal| {
            let (low, width) = low(&signal.name)?;
            let signed = matches!(signal.format, SignalFormat::Signed { .. });
            Some(InputBits { low, width, signed })
        };
        let places = signals.iter().map(place).collect();
        Inputs { places, taps, words: Vec::new(), strange: None }
    }
}

/// Returns `width` bits from `low` on, 64 at most.
pub(crate) fn bits(words: &[u32], low: usize, width: usize) -> u64 {
    let word = |place: usize| words.get(place).copied().map_or(0, u128::from);
    let first = low / 32;
    let all = word(first) | word(first + 1) << 32 | word(first + 2) << 64;
    (all >> (low % 32)) as u64 & (u64::MAX >> (64 - width))
}

impl Source for Inputs {
    fn word(&mut self, id: usize) -> u64 {
        let Some(InputBits { low, width, signed }) = self.places[id] else { return 0 };
        let word = bits(&self.words, low, width);
        if signed { ((word << (64 - width)) as i64 >> (64 - width)) as u64 } else { word }
    }

    fn taps(&mut self, id: usize) -> Thermometer {
        let Some(InputBits { low, width, .. }) = self.places[id] else {
            return Thermometer::default();
        };
        let word = |from: usize| bits(&self.words, low + from, (width - from).min(64));
        self.taps.taps((0..width).step_by(64).map(word)).unwrap_or_else(|| {
            self.strange = Some(id);
            Thermometer::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_taken_across_words() {
        let words = [0x8000_0001, 0xffff_0000, 0x0000_00ab];
        assert_eq!(bits(&words, 0, 1), 1);
        assert_eq!(bits(&words, 31, 2), 1);
        assert_eq!(bits(&words, 48, 24), 0xab_ffff);
        assert_eq!(bits(&words, 31, 64), 0x0157_fffe_0001);
        assert_eq!(bits(&words, 95, 8), 0);
    }

    #[test]
    fn a_narrow_number_keeps_its_sign() {
        let mut list = <tofsim::firmware::tansig::In as tofsim::kernel::signals::Signals>::list();
        list.retain(|signal| signal.name == "l1_in_0");
        let mut inputs = Inputs::new(&list, |_| Some((4, 6)), TapDigits::default());
        inputs.words = vec![0b11_1110_0000];
        assert_eq!(inputs.word(0) as i64, -2);
        inputs.words = vec![0b01_1110_0000];
        assert_eq!(inputs.word(0), 30);
    }
}
