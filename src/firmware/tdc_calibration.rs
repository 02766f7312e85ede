//! Calibrates the TDC between two frames: counts hits that know nothing of the clock, and works out ages from them.
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
use crate::kernel::module::{Module, Visitor};
use crate::{signals, states};

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
    /// What the block does.
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
        /// What the decoder made of its taps.
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
        /// What the block does.
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
        /// The count as a time.
        #[size(HitsSumBits)]
        pub(crate) width: Sum,
        /// Where the ages of this word begin.
        #[size(HitsSumBits)]
        pub(crate) begin_sum: Sum,
        /// The middle of them, and a half to round.
        #[size(HitsSumBits)]
        pub(crate) middle: Sum,
        /// They begin at the laser edge or before it.
        pub(crate) early: bool,
        /// The age [units].
        #[size(AgeBits)]
        pub(crate) age: Word,
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

impl Module for TdcCalibration {
    const COUNT: usize = <Registers as Module>::COUNT;

    #[inline(always)]
    fn visit(&self, then: Option<&mut Self>, visitor: &mut impl Visitor) {
        visitor.signals("registers", &self.registers, then.map(|then| &mut then.registers));
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
        let age = p.age(q.middle.get());
        let is_limited = p.by_the_edge(age, q.early) != age;
        (q.state == State::Integrate && q.beat == 3).then_some((q.early, is_limited))
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
            State::Integrate => (q.beat == BEATS - 1).then_some((q.place, q.age)),
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

    /// A cycle of a word: it is read, times `Cycle`, to the middle of its ages, limited, and written.
    fn integrate(&self, d: &mut Registers, p: &Params) {
        let q = &self.registers;
        match q.beat.get() {
            0 => {}
            1 => d.width = Sum::new(q.calibrated_age.get() * p.cycle),
            2 => {
                d.middle = Sum::new(q.begin_sum.get() + q.width.get() + p.hits());
                d.early = q.begin_sum.get() <= p.start_sum();
            }
            3 => {
                d.age = Word::new(p.by_the_edge(p.age(q.middle.get()), q.early));
                d.begin_sum = Sum::new(q.begin_sum.get() + 2 * q.width.get());
            }
            _ if q.place == p.taps as u64 => (d.state, d.calibrating) = (State::Idle, false),
            _ => d.place = q.place + 1,
        }
        d.beat = if q.beat == BEATS - 1 { U::new(0) } else { q.beat + 1 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAPS: usize = 16;

    fn params() -> Params {
        let (begin, start) = (1280 << FRACTION, 5120 << FRACTION);
        Params { taps: TAPS, cycle: 5120, hits_log2: 10, frames: 2, begin, start }
    }

    const CLEAR: In =
        In { rst: false, clear: true, frame_done: false, n_valid: false, n: U::new(0) };

    /// The block after a calibration with that `n` for the hit of each number, and its cycles.
    fn calibrated(block: &mut TdcCalibration, p: &Params, n_of: impl Fn(u64) -> u64) -> u64 {
        let (mut given, mut cycles) = (0, 0);
        block.tick(&CLEAR, p);
        assert!(block.registers.ring_on && block.registers.calibrating);
        while block.registers.calibrating {
            let n_valid = cycles % 3 == 0;
            let counts = block.state() == State::Count && block.registers.hits != p.hits();
            block.tick(&In { n_valid, n: U::new(n_of(given)), ..CLEAR }, p);
            given += u64::from(n_valid && counts);
            cycles += 1;
        }
        cycles
    }

    #[test]
    fn ages_are_those_that_counts_come_to() {
        let (p, mut counts) = (params(), vec![0; TAPS + 1]);
        let n_of = |hit: u64| 1 + hit * hit % 13;
        (0..p.hits()).for_each(|hit| counts[n_of(hit) as usize] += 1);
        let mut block = TdcCalibration::new(&p);
        let cycles = calibrated(&mut block, &p, n_of);
        let ages: Vec<_> = block.ram.iter().map(|word| word.get()).collect();
        assert_eq!(ages, p.ages(&counts));
        assert_eq!(ages[0], 1280);
        assert_eq!(ages[TAPS], 1280 + 5120, "after all hits");
        let words = TAPS as u64 + 1;
        assert!(cycles.abs_diff(words + 3 * p.hits() + BEATS * words) < 6, "{cycles}");
    }

    #[test]
    fn the_age_that_holds_the_laser_edge_is_limited() {
        // 3 of 4 hits are younger than 1280 + 3840 units, which is the edge, and then there is one tap.
        let n_of = |hit: u64| if hit % 4 < 3 { 5 } else { 6 };
        let (p, mut block) = (params(), TdcCalibration::new(&params()));
        calibrated(&mut block, &p, n_of);
        assert_eq!(block.ram[5], 1280 + 1920);
        assert_eq!(block.ram[6], 5120, "begins with the edge");
        assert_eq!(block.ram[7], 6400, "begins after it");
    }

    #[test]
    fn it_calibrates_after_a_reset_and_after_so_many_frames() {
        let (p, mut block) = (params(), TdcCalibration::new(&params()));
        calibrated(&mut block, &p, |_| 3);
        let done = In { frame_done: true, ..CLEAR };
        block.tick(&done, &p);
        block.tick(&CLEAR, &p);
        assert_eq!(block.state(), State::Idle);
        block.tick(&done, &p);
        block.tick(&CLEAR, &p);
        assert_eq!(block.state(), State::Zero);
        block.tick(&In { rst: true, ..CLEAR }, &p);
        assert!(!block.registers.calibrating && !block.registers.ring_on);
        block.tick(&In { clear: false, ..CLEAR }, &p);
        assert_eq!(block.state(), State::Idle, "not while shots are fired");
        block.tick(&CLEAR, &p);
        assert_eq!(block.state(), State::Zero);
    }

    #[test]
    fn the_decoder_reads_the_word_of_its_hit() {
        let (p, mut block) = (params(), TdcCalibration::new(&params()));
        calibrated(&mut block, &p, |hit| 1 + hit % 16);
        for n in 0..=TAPS as u64 {
            block.tick(&In { clear: false, n_valid: true, n: U::new(n), ..CLEAR }, &p);
            assert_eq!(block.registers.calibrated_age, block.ram[n as usize]);
        }
    }
}
