//! Calibrates the TDC between two frames: counts hits uncorrelated with the clock, and computes ages from them.
//!
//! Mirrors `rtl_ref/tdc_calibration.v`. Of hits that are spread evenly over a clock period, as many have an `n` as
//! the ages that give it are wide. With C hits of less, c of its own and 2^k in all, the middle of those ages is
//!
//! ```text
//! age = Begin + Cycle (2 C + c) / 2^(k + 1)   [units]
//! ```
//!
//! and no count tells `Begin`, when a hit reaches tap 0. A ring oscillator, which is none of the firmware, gives
//! the hits while `ring_on` is high, and the frame waits at the end of Clear while `calibrating` is.
//!
//! ```text
//! state     Idle   Zero       Count                      Integrate      Idle
//! cycles           Taps + 1   2^k periods of the ring    5 (Taps + 1)
//! ring_on          ^---------------------------------v
//! ```
//!
//! One RAM has the counts first and then the ages, which the decoder reads; its words are those of the last hit's
//! `n`. A calibration begins with the first Clear after a reset, so that there is none without, and then after so
//! many frames. Hits have to be two cycles or more apart.

use crate::kernel::U;
use crate::{module_of_registers, signals, states};

mod params;

pub use params::{FRACTION, Params};

/// `n` of a hit, and number of a word.
pub type Place = U<11>;
/// A word of the RAM: hits, and then an age [units].
pub type Word = U<42>;
/// An age times twice the number of hits [units].
type Sum = U<63>;
/// Cycles that Integrate takes for a word.
pub const BEATS: u64 = 5;

states! {
    /// States of the calibration.
    pub enum State: 2 {
        /// Nothing: the decoder reads ages.
        Idle,
        /// Sets all counts to zero, while the ring begins to run.
        Zero,
        /// Counts hits.
        Count,
        /// Turns counts into ages.
        Integrate,
    }
}

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// The histogram is being cleared.
        pub clear: bool,
        /// A frame has ended.
        pub frame_done: bool,
        /// `n` is that of a new hit.
        pub n_valid: bool,
        /// Number of the decoder for the taps.
        #[size(CountOfTaps)]
        pub n: Place,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct Registers {
        /// The TDC's hits are to come from the ring, and each counts.
        #[only_if(Calibrated)]
        #[view(heading = "TDC", probe = true)]
        pub ring_on: bool,
        /// The frame has to wait.
        #[only_if(Calibrated)]
        pub calibrating: bool,
        /// Age for the last hit's `n`, or a count while hits are counted [units].
        #[only_if(Calibrated)]
        #[size(AgeBits)]
        pub calibrated_age: Word,
        /// State of the calibration.
        #[view(heading = "TDC", probe = true)]
        pub(crate) state: State,
        /// A calibration is due.
        pub(crate) due: bool = true,
        /// Frames since the last one.
        pub(crate) frames: U<16>,
        /// Word that is set to zero, or turned into an age.
        #[size(CountOfTaps)]
        pub(crate) place: Place,
        /// Hits counted.
        #[size(HitsBits)]
        #[view(heading = "TDC", probe = true)]
        pub(crate) hits: U<21>,
        /// `calibrated_age` is the count of a hit.
        pub(crate) counting: bool,
        /// Its `n`.
        #[size(CountOfTaps)]
        pub(crate) hit_n: Place,
        /// Cycles that this word has taken.
        pub(crate) beat: U<3>,
        /// The count of this word.
        #[size(AgeBits)]
        pub(crate) own_hits: Word,
        /// The count as a time.
        #[size(HitsSumBits)]
        pub(crate) width: Sum,
        /// Start of the ages of this word.
        #[size(HitsSumBits)]
        pub(crate) begin_sum: Sum,
        /// The middle of them, and a half to round.
        #[size(HitsSumBits)]
        pub(crate) middle: Sum,
        /// The ages begin at the laser edge or before it.
        pub(crate) early: bool,
    }
}

/// Registers and RAM. Too large to copy at every edge, so it is clocked in place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TdcCalibration {
    /// Registers.
    pub registers: Registers,
    /// Hits of each `n`, and then the age of such a hit [units].
    pub ram: Box<[Word]>,
}

module_of_registers!(TdcCalibration);

impl Registers {
    /// The age of the word in `middle` [units].
    fn age(&self, p: &Params) -> Word {
        Word::new(p.by_the_edge(p.age(self.middle.get()), self.early))
    }
}

impl TdcCalibration {
    /// At power-up.
    pub fn new(p: &Params) -> Self {
        TdcCalibration { registers: Registers::default(), ram: vec![U::new(0); p.taps + 1].into() }
    }

    /// Returns the block's state.
    pub fn state(&self) -> State {
        self.registers.state
    }

    /// Returns whether a calibration is due, and the hits counted by the one under way.
    pub fn progress(&self) -> (bool, u64) {
        (self.registers.due, self.registers.hits.get())
    }

    /// Returns, while an age is computed, whether its ages begin by the laser edge, and whether it is
    /// limited.
    pub fn limits(&self, p: &Params) -> Option<(bool, bool)> {
        let q = &self.registers;
        let is_limited = q.age(p) != p.age(q.middle.get());
        (q.state == State::Integrate && q.beat == BEATS - 1).then_some((q.early, is_limited))
    }

    /// The rising edge of `clk_sys`.
    pub fn tick(&mut self, i: &In, p: &Params) {
        let q = self.registers;
        let mut d = q;
        if i.frame_done {
            d.due |= q.frames == p.frames - 1;
            d.frames = if d.due { U::new(0) } else { q.frames + 1 };
        }
        d.counting = false;
        let (full, last) = (q.hits == p.hits(), q.place == p.taps as u64);
        match q.state {
            State::Idle if q.due && i.clear => {
                (d.state, d.due, d.place) = (State::Zero, false, U::new(0));
                (d.ring_on, d.calibrating) = (true, true);
            }
            State::Idle => {}
            State::Zero if !last => d.place = q.place + 1,
            State::Zero => (d.state, d.hits) = (State::Count, U::new(0)),
            State::Count if i.n_valid && !full => {
                (d.counting, d.hit_n, d.hits) = (true, i.n, q.hits + 1);
            }
            State::Count if full && !q.counting => {
                (d.state, d.ring_on) = (State::Integrate, false);
                (d.place, d.beat, d.begin_sum) = (U::new(0), U::new(0), Sum::new(p.begin_sum()));
            }
            State::Count => {}
            State::Integrate => self.integrate(&mut d, p),
        }
        let read = match q.state {
            State::Integrate => (q.beat == 0).then_some(q.place),
            _ => i.n_valid.then_some(i.n),
        };
        if let Some(word) = read.and_then(|place| self.ram.get(place.index())) {
            d.calibrated_age = *word;
        }
        let write = match q.state {
            State::Zero => Some((q.place, U::new(0))),
            State::Integrate => (q.beat == BEATS - 1).then(|| (q.place, q.age(p))),
            State::Idle | State::Count => q.counting.then_some((q.hit_n, q.calibrated_age + 1)),
        };
        if let Some((place, word)) = write
            && let Some(written) = self.ram.get_mut(place.index())
        {
            *written = word;
        }
        self.registers = d;
        if i.rst {
            self.registers = Registers { calibrated_age: d.calibrated_age, ..Registers::default() };
        }
    }

    /// A cycle of a word: it is read, kept, times `Cycle`, to the middle of its ages, limited and written.
    fn integrate(&self, d: &mut Registers, p: &Params) {
        let q = &self.registers;
        match q.beat.get() {
            0 => {}
            1 => d.own_hits = q.calibrated_age,
            2 => d.width = Sum::new(q.own_hits.get() * p.cycle),
            3 => {
                d.middle = Sum::new(q.begin_sum.get() + q.width.get() + p.hits());
                d.early = q.begin_sum.get() <= p.start_sum();
            }
            _ => {
                d.begin_sum = Sum::new(q.begin_sum.get() + 2 * q.width.get());
                if q.place == p.taps as u64 {
                    (d.state, d.calibrating) = (State::Idle, false);
                } else {
                    d.place = q.place + 1;
                }
            }
        }
        d.beat = if q.beat == BEATS - 1 { U::new(0) } else { q.beat + 1 };
    }
}

#[cfg(test)]
mod tests;
