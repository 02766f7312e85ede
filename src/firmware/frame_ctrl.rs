//! Runs a frame: clear the histogram, acquire, let the TDC drain, estimate, again.
//!
//! Mirrors `rtl_ref/frame_ctrl.v`. All outputs are registers that change with the state.
//!
//! ```text
//! state     Clear      Acquire        Drain     Estimate      Clear
//! cycles    bins       shots x P + 1  drain     268           bins
//! pulses    clear      acquire        -         algo_start^   ^frame_done
//! ```
//!
//! `P` is the laser period; the KC705 has 256 bins and a Drain of 16 cycles, and 268 are those of its network.
//! `calibrating` holds the last cycle of Clear. `dsp_en` low holds the machine before the estimator's start (in the
//! last cycle of Drain) and keeps the histogram. With a preloaded histogram Acquire and Drain are skipped (thesis 6.7.4), and `dsp_en` low holds
//! the last cycle of Clear.

use crate::kernel::{AWAKE, Clocked, U, asleep_if};
use crate::{signals, states};

use super::histogram_builder::{self, Bin};

/// Length of Drain unless elaboration says otherwise: longer than what a photon of the last shot takes to
/// its word of the histogram [cycles of clk_sys].
pub const DRAIN_CYCLES: u64 = 16;

states! {
    /// States of the frame.
    pub enum State: 2 {
        /// The histogram is set to zero, word by word.
        Clear,
        /// Shots are fired and counted.
        Acquire,
        /// The TDC finishes the last shot.
        Drain,
        /// The estimator works.
        Estimate,
    }
}

/// Verilog parameters.
#[derive(Clone, Copy, Debug)]
pub struct Params {
    /// Shots in a frame, at least 1.
    pub shots_per_frame: u32,
    /// Size of the histogram.
    pub histogram: histogram_builder::Params,
    /// The histogram comes from a ROM: nothing to acquire.
    pub preloaded: bool,
    /// Length of Drain, 1 to 65,536 [cycles of clk_sys].
    pub drain_cycles: u64,
}

impl Params {
    /// The last count of Drain.
    #[inline(always)]
    pub fn last_drain(&self) -> u64 {
        self.drain_cycles - 1
    }
}

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// A shot begins.
        pub start: bool,
        /// Abandons the frame.
        pub dsp_rst: bool,
        /// Lets the estimator start.
        pub dsp_en: bool,
        /// The estimator has finished.
        pub algo_done: bool,
        /// Holds the last cycle of Clear: the TDC is being calibrated.
        #[only_if(Calibrated)]
        pub calibrating: bool,
    }
}

signals! {
    /// Registers; the `pub` ones are the output ports.
    pub struct FrameCtrl {
        /// Sets a word of the histogram to zero.
        pub clear: bool = true,
        /// Address of the word to clear.
        #[size(BinBits)]
        pub clear_addr: Bin,
        /// Lets the laser's counter run.
        pub acquire: bool,
        /// Starts the estimator; one cycle.
        pub algo_start: bool,
        /// The frame has ended; one cycle, the first of the next Clear.
        pub frame_done: bool,
        /// State of the frame.
        #[view(heading = "Control", probe = true)]
        pub(crate) state: State,
        /// Shots begun in this frame.
        #[size(CountBits)]
        #[view(heading = "Control", probe = true)]
        pub(crate) shots: U<24>,
        /// Cycles spent in Drain.
        #[size(DrainBits)]
        pub(crate) drain: U<16>,
    }
}

impl FrameCtrl {
    /// State of the frame.
    pub fn state(&self) -> State {
        self.state
    }

    /// Shots begun in this frame.
    pub fn shots(&self) -> u64 {
        self.shots.get()
    }
}

impl Clocked for FrameCtrl {
    type In = In;
    type Params = Params;

    #[inline(always)]
    fn tick(&mut self, i: &In, p: &Params) {
        let (q, d) = (*self, self);
        d.algo_start = false;
        d.frame_done = false;
        match q.state {
            State::Clear if q.clear_addr != p.histogram.last_bin() => {
                d.clear_addr = q.clear_addr + 1
            }
            State::Clear if i.calibrating => {}
            State::Clear if !p.preloaded => {
                (d.clear, d.clear_addr) = (false, U::new(0));
                (d.state, d.acquire, d.shots) = (State::Acquire, true, U::new(0));
            }
            State::Clear if i.dsp_en => {
                (d.clear, d.clear_addr) = (false, U::new(0));
                (d.state, d.algo_start) = (State::Estimate, true);
            }
            State::Clear => {}
            State::Acquire if i.start => {
                d.shots = q.shots + 1;
                if d.shots == p.shots_per_frame as u64 {
                    (d.state, d.acquire, d.drain) = (State::Drain, false, U::new(0));
                }
            }
            State::Acquire => {}
            State::Drain if q.drain != p.last_drain() => d.drain = q.drain + 1,
            State::Drain if i.dsp_en => (d.state, d.algo_start) = (State::Estimate, true),
            State::Drain => {}
            State::Estimate if i.algo_done => {
                (d.state, d.clear, d.frame_done) = (State::Clear, true, true);
            }
            State::Estimate => {}
        }
        if i.rst || i.dsp_rst {
            *d = Self::default();
        }
    }

    /// Nobody looks at how far Drain has come.
    #[inline(always)]
    fn quiet(&self, i: &In, p: &Params) -> u64 {
        if i.rst || i.dsp_rst || self.algo_start || self.frame_done {
            return AWAKE;
        }
        match self.state {
            State::Clear => AWAKE,
            State::Acquire => asleep_if(!i.start),
            State::Drain if self.drain != p.last_drain() => p.last_drain() - self.drain.get(),
            State::Drain => asleep_if(!i.dsp_en),
            State::Estimate => asleep_if(!i.algo_done),
        }
    }

    #[inline(always)]
    fn skip(&mut self, _: &In, p: &Params, edges: u64) {
        if self.state == State::Drain && self.drain != p.last_drain() {
            self.drain = self.drain + edges;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHORT: Params = Params {
        shots_per_frame: 2,
        histogram: histogram_builder::Params { bins: 256, count_bits: 16 },
        preloaded: false,
        drain_cycles: DRAIN_CYCLES,
    };
    const ENABLED: In = In {
        rst: false,
        start: false,
        dsp_rst: false,
        dsp_en: true,
        algo_done: false,
        calibrating: false,
    };

    fn after(mut ctrl: FrameCtrl, edges: usize, i: In, p: &Params) -> FrameCtrl {
        for _ in 0..edges {
            ctrl = ctrl.next(&i, p);
        }
        ctrl
    }

    fn draining() -> FrameCtrl {
        let acquiring = after(FrameCtrl::default(), 256, ENABLED, &SHORT);
        assert!(acquiring.acquire && !acquiring.clear);
        after(acquiring, 2, In { start: true, ..ENABLED }, &SHORT)
    }

    #[test]
    fn clear_takes_256_cycles_and_then_shots_are_counted() {
        assert!(after(FrameCtrl::default(), 255, ENABLED, &SHORT).clear);
        let ctrl = draining();
        assert_eq!(ctrl.state, State::Drain);
        assert!(!ctrl.acquire);
    }

    #[test]
    fn the_estimator_starts_after_sixteen_cycles_of_drain() {
        assert!(!after(draining(), 15, ENABLED, &SHORT).algo_start);
        assert!(after(draining(), 16, ENABLED, &SHORT).algo_start);
        assert!(!after(draining(), 17, ENABLED, &SHORT).algo_start);
    }

    #[test]
    fn dsp_en_low_holds_the_frame_before_the_estimator() {
        let held = after(draining(), 500, In { dsp_en: false, ..ENABLED }, &SHORT);
        assert_eq!(held.state, State::Drain);
        assert!(after(held, 1, ENABLED, &SHORT).algo_start);
    }

    #[test]
    fn a_calibration_holds_the_last_cycle_of_clear() {
        for p in [SHORT, Params { preloaded: true, ..SHORT }] {
            let calibrating = In { calibrating: true, ..ENABLED };
            let held = after(FrameCtrl::default(), 500, calibrating, &p);
            assert!(held.clear && held.clear_addr == 255 && held.state == State::Clear);
            assert!(!after(held, 1, ENABLED, &p).clear);
        }
    }

    #[test]
    fn dsp_rst_returns_to_clear_from_anywhere() {
        let reset = In { dsp_rst: true, ..ENABLED };
        assert_eq!(draining().next(&reset, &SHORT), FrameCtrl::default());
    }

    #[test]
    fn a_preloaded_histogram_needs_no_acquisition() {
        let preloaded = Params { preloaded: true, ..SHORT };
        let ctrl = after(FrameCtrl::default(), 256, ENABLED, &preloaded);
        assert!(ctrl.algo_start && !ctrl.acquire);
        let done = ctrl.next(&In { algo_done: true, ..ENABLED }, &preloaded);
        assert!(done.frame_done && done.clear);
    }
}
