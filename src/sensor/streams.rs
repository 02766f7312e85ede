//! Random number streams: one per noise source and frame, all derived from one seed.
//!
//! A source uses a fixed number of words per shot, so that unused draws, other sources, frames and threads do not
//! affect it.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::kernel::pulse::normal_quantile;

/// Purpose of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Source {
    /// First avalanche of each shot, one word per shot.
    Avalanche = 1,
    /// Further avalanches of a shot, from the shot's own section of the stream.
    FurtherAvalanches = 2,
    /// Causes of avalanches, from the shot's own section of the stream.
    Cause = 3,
    /// Jitter of the PLL, one word per edge of `clk_laser` since power-up.
    Jitter = 4,
    /// Stimulus of the golden vectors; the frame number is that of the block.
    Stimulus = 5,
    /// Histogram of a frame in one draw, with any number of words.
    Histogram = 6,
    /// Histogram of a dataset's row in one draw; the frame number is that of the row.
    Dataset = 7,
    /// Scenes of a dataset; the frame number is that of a distance and a round.
    Scene = 8,
    /// A dark and a lit histogram for a dataset's row, in this order; the frame number is that of the row.
    DatasetPair = 9,
    /// Time and energy of the laser pulse, from the shot's own section of the stream.
    LaserPulse = 10,
    /// Trapping of carriers and their release times, from the shot's own section of the stream.
    Afterpulse = 11,
    /// Crosstalk to neighbours, from the shot's own section of the stream.
    Crosstalk = 12,
    /// Choice of the SPAD of each carrier, from the shot's own section of the stream.
    Diode = 13,
    /// Hits of a code-density test of the TDC; the frame number is that of the test.
    CodeDensity = 14,
    /// Edges of the ring oscillator; the frame number is that of the run.
    Ring = 15,
    /// Sampling instants of the chain's registers within their set-up window; the position in the stream is the
    /// edge's time.
    SetupWindow = 16,
    /// Seeds of an array's pixels; the frame number is that of the pixel.
    Pixel = 17,
    /// Seeds of an array's rows, for what their pixels share; the frame number is that of the row.
    Row = 18,
}

/// Seeds of the random streams of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seeds {
    /// Of the streams of its own.
    pub pixel: u64,
    /// Of those that it shares with its row: jitter of the clocks and of the laser.
    pub row: u64,
}

impl From<u64> for Seeds {
    /// Those of a pixel by itself.
    fn from(seed: u64) -> Self {
        Seeds { pixel: seed, row: seed }
    }
}

/// Length of a shot's section of a stream [32-bit words].
const STRETCH: u128 = 1 << 32;

/// Creates the stream of a source in a frame.
pub fn stream(seed: u64, source: Source, frame: u64) -> ChaCha8Rng {
    let mut key = *b"........tofsim random streams v1";
    key[..8].copy_from_slice(&seed.to_le_bytes());
    let mut rng = ChaCha8Rng::from_seed(key);
    rng.set_stream((source as u64) << 56 | frame);
    rng
}

/// Moves a stream to a shot's section, and within it to the `nth` 64-bit word.
pub fn seek(stream: &mut ChaCha8Rng, shot: u64, nth: u64) {
    stream.set_word_pos(shot as u128 * STRETCH + 2 * nth as u128);
}

/// Stream of a source that uses a variable number of words per shot, from the shot's own section.
#[derive(Clone, Debug)]
pub struct Stretches {
    seed: u64,
    source: Source,
    words: ChaCha8Rng,
    /// Number of the present shot in its frame; 0 is the time before the first shot.
    shot: u64,
    /// Whether the stream is positioned in the shot's section.
    is_there: bool,
}

impl Stretches {
    /// Creates the stream before the first frame.
    pub fn new(seed: u64, source: Source) -> Self {
        Stretches { seed, source, words: stream(seed, source, 0), shot: 0, is_there: true }
    }

    /// Begins a frame.
    pub fn begin_frame(&mut self, frame: u64) {
        (self.words, self.shot) = (stream(self.seed, self.source, frame), 0);
        self.is_there = true;
    }

    /// Begins a shot.
    pub fn begin_shot(&mut self) {
        self.shot += 1;
        self.is_there = false;
    }

    /// Returns the next word of the shot.
    pub fn next_u64(&mut self) -> u64 {
        if !self.is_there {
            seek(&mut self.words, self.shot, 0);
            self.is_there = true;
        }
        self.words.next_u64()
    }
}

/// Converts a word to a uniform number between 0 and 1: its upper 52 bits select the midpoint of one of 2^52 equal
/// intervals, which is exact in an `f64` and never 0 or 1.
#[inline]
pub fn uniform(word: u64) -> f64 {
    ((word >> 12) as f64 + 0.5) * (1.0 / (1u64 << 52) as f64)
}

/// Converts a word to an exponentially distributed number of mean 1.
#[inline]
pub fn exponential(word: u64) -> f64 {
    -libm::log(uniform(word))
}

/// Converts a word to a normally distributed number of standard deviation 1.
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
