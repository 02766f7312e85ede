//! Random numbers: one stream for each noise source and frame, all from one seed.
//!
//! A source takes a fixed number of words for each shot, so that a draw that is not used moves
//! nothing, and no source, frame or thread moves another.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::kernel::pulse::normal_quantile;

/// What a stream is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Source {
    /// First avalanche of each shot, one word a shot.
    Avalanche = 1,
    /// Further avalanches of a shot; each shot has its own stretch.
    FurtherAvalanches = 2,
    /// What set an avalanche off; each shot has its own stretch.
    Cause = 3,
    /// Jitter of the PLL, one word an edge of `clk_laser` since power-up.
    Jitter = 4,
    /// Stimulus of the golden vectors; the frame's place is the block's.
    Stimulus = 5,
    /// Histogram of a frame in one draw; as many words as it takes.
    Histogram = 6,
    /// Histogram of a dataset's row in one draw; the frame's place is the row number's.
    Dataset = 7,
    /// Which scenes a dataset has; the frame's place is that of a distance and a round.
    Scene = 8,
    /// A dark and a lit histogram for a dataset's row, in this order; the frame's place is the row
    /// number's.
    DatasetPair = 9,
    /// How late and how strong the laser pulse of a shot is; each shot has its own stretch.
    LaserPulse = 10,
    /// Whether an avalanche traps a carrier, and for how long; each shot has its own stretch.
    Afterpulse = 11,
    /// Whether an avalanche sets off a neighbour; each shot has its own stretch.
    Crosstalk = 12,
    /// Which diode of a row a carrier comes to; each shot has its own stretch.
    Diode = 13,
    /// Hits of a code-density test of the TDC; the frame's place is the test's.
    CodeDensity = 14,
    /// Edges of the ring oscillator; the frame's place is the run's.
    Ring = 15,
    /// When within its set-up window each register of the chain samples; the place in the stream is the edge's time.
    SetupWindow = 16,
}

/// Words of 32 bits that a shot may take from its stretch.
const STRETCH: u128 = 1 << 32;

/// The stream of a source in a frame.
pub fn stream(seed: u64, source: Source, frame: u64) -> ChaCha8Rng {
    let mut key = *b"........tofsim random streams v1";
    key[..8].copy_from_slice(&seed.to_le_bytes());
    let mut rng = ChaCha8Rng::from_seed(key);
    rng.set_stream((source as u64) << 56 | frame);
    rng
}

/// Moves a stream to the stretch of a shot, and in it to the `nth` word of 64 bits.
pub fn seek(stream: &mut ChaCha8Rng, shot: u64, nth: u64) {
    stream.set_word_pos(shot as u128 * STRETCH + 2 * nth as u128);
}

/// A source that takes any number of words in each shot, from the shot's own stretch.
#[derive(Clone, Debug)]
pub struct Stretches {
    seed: u64,
    source: Source,
    words: ChaCha8Rng,
    /// Shots of this frame, the time before its first one counted as shot 0.
    shot: u64,
    /// Whether the stream stands in the shot's stretch.
    is_there: bool,
}

impl Stretches {
    /// Before the first shot of the first frame.
    pub fn new(seed: u64, source: Source) -> Self {
        Stretches { seed, source, words: stream(seed, source, 0), shot: 0, is_there: true }
    }

    /// A frame begins.
    pub fn begin_frame(&mut self, frame: u64) {
        (self.words, self.shot) = (stream(self.seed, self.source, frame), 0);
        self.is_there = true;
    }

    /// A shot begins.
    pub fn begin_shot(&mut self) {
        self.shot += 1;
        self.is_there = false;
    }

    /// The shot's next word.
    pub fn next_u64(&mut self) -> u64 {
        if !self.is_there {
            seek(&mut self.words, self.shot, 0);
            self.is_there = true;
        }
        self.words.next_u64()
    }
}

/// A number between 0 and 1 from a word: its upper 52 bits choose the middle of one of 2^52 equal
/// parts, which is exact in an `f64` and never 0 or 1.
#[inline]
pub fn uniform(word: u64) -> f64 {
    ((word >> 12) as f64 + 0.5) * (1.0 / (1u64 << 52) as f64)
}

/// An exponential draw of mean 1 from a word.
#[inline]
pub fn exponential(word: u64) -> f64 {
    -libm::log(uniform(word))
}

/// A normal draw of deviation 1 from a word.
pub fn normal(word: u64) -> f64 {
    normal_quantile(uniform(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_and_frames_have_streams_of_their_own() {
        let first = |seed, source, frame| stream(seed, source, frame).next_u64();
        let words = [
            first(1, Source::Avalanche, 0),
            first(2, Source::Avalanche, 0),
            first(1, Source::Cause, 0),
            first(1, Source::Avalanche, 1),
        ];
        for (k, word) in words.iter().enumerate() {
            assert!(!words[..k].contains(word));
        }
    }

    #[test]
    fn a_seek_finds_the_same_word_again() {
        let mut further = stream(1, Source::FurtherAvalanches, 3);
        seek(&mut further, 7, 0);
        let words = [further.next_u64(), further.next_u64()];
        seek(&mut further, 7, 1);
        assert_eq!(further.next_u64(), words[1]);
    }

    #[test]
    fn exponential_draws_are_finite_and_positive() {
        assert!((exponential(0) - 53.0 * std::f64::consts::LN_2).abs() < 1e-12);
        assert!(exponential(u64::MAX) > 0.0);
        assert!((exponential(1 << 63) - std::f64::consts::LN_2).abs() < 1e-15);
    }

    #[test]
    fn a_uniform_number_is_never_0_or_1() {
        assert!(uniform(0) > 0.0);
        assert!(uniform(u64::MAX) < 1.0);
    }
}
