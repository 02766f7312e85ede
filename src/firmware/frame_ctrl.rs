//! Runs a frame: clear the histograms, acquire, let the TDCs drain, estimate column by column, again. In an array a
//! frame is a row, and with two banks of histograms one is read while the other is filled.
//!
//! Mirrors `rtl_ref/frame_ctrl.v`. All outputs are registers that change with the state.
//!
//! ```text
//! state     Clear      Acquire        Drain     Estimate      Clear
//! cycles    bins       shots x P + 1  drain     268           bins
//! pulses    clear      acquire        -         algo_start^   ^frame_done
//! ```
//!
//! `P` is the laser period; the KC705 has 256 bins and a Drain of 16 cycles, and 268 are those of its network. In an array
//! Estimate lasts as long again for each further column. With two banks there is no Estimate: Clear follows Drain, and
//! `frame_done` comes while the next row acquires. A row whose predecessor is still being estimated waits in the last
//! cycle of Drain.
//!
//! `calibrating` holds the last cycle of Clear. `dsp_en` low holds the machine before the estimator's start (in the
//! last cycle of Drain) and keeps the histogram. With a preloaded histogram Acquire and Drain are skipped (thesis 6.7.4), and `dsp_en` low holds
//! the last cycle of Clear.

use crate::kernel::scan::{Place, Scan};
use crate::kernel::{AWAKE, Clocked, U, asleep_if};
use crate::{signals, states};

use super::histogram_builder::{self, Bin};

pub mod timing;

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
    /// Rows, columns and banks.
    pub scan: Scan,
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
        /// Bank that is filled.
        #[only_if(Scanned)]
        pub bank: bool,
        /// Column that is read.
        #[only_if(Scanned)]
        #[view(heading = "Control")]
        pub depth_column: Place,
        /// Row that acquires.
        #[only_if(Scanned)]
        #[view(heading = "Control")]
        pub row: Place,
        /// Row whose depths are estimated.
        #[only_if(Scanned)]
        #[view(heading = "Control")]
        pub depth_row: Place,
        /// The other bank is being read.
        #[only_if(Scanned)]
        estimating: bool,
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

    /// Returns whether the estimator works.
    #[inline(always)]
    pub fn is_estimating(&self) -> bool {
        self.estimating || self.state == State::Estimate
    }

    /// Hands the histograms of a row over to the estimator, and turns to the next row.
    #[inline(always)]
    fn hand_over(&mut self, scan: &Scan) {
        self.depth_row = self.row;
        self.row = if self.row == scan.last_row() { U::new(0) } else { self.row + 1 };
        if scan.is_banked() {
            (self.state, self.clear) = (State::Clear, true);
            (self.bank, self.estimating) = (!self.bank, true);
        }
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
            State::Drain if i.dsp_en && !q.estimating => {
                (d.state, d.algo_start) = (State::Estimate, true);
                d.hand_over(&p.scan);
            }
            State::Drain => {}
            State::Estimate if i.algo_done && q.depth_column == p.scan.last_column() => {
                (d.state, d.clear) = (State::Clear, true);
            }
            State::Estimate => {}
        }
        if i.algo_done && q.is_estimating() {
            if q.depth_column != p.scan.last_column() {
                (d.depth_column, d.algo_start) = (q.depth_column + 1, true);
            } else {
                (d.depth_column, d.estimating, d.frame_done) = (U::new(0), false, true);
            }
        }
        if i.rst || i.dsp_rst {
            *d = Self::default();
        }
    }

    /// Nobody looks at how far Drain has come.
    #[inline(always)]
    fn quiet(&self, i: &In, p: &Params) -> u64 {
        let ends = i.algo_done && self.estimating;
        if i.rst || i.dsp_rst || self.algo_start || self.frame_done || ends {
            return AWAKE;
        }
        match self.state {
            State::Clear => AWAKE,
            State::Acquire => asleep_if(!i.start),
            State::Drain if self.drain != p.last_drain() => p.last_drain() - self.drain.get(),
            State::Drain => asleep_if(!i.dsp_en || self.estimating),
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
mod tests;
