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
mod tests {
    use super::*;

    const SHORT: Params = Params {
        shots_per_frame: 2,
        histogram: histogram_builder::Params { bins: 256, count_bits: 16 },
        preloaded: false,
        drain_cycles: DRAIN_CYCLES,
        scan: Scan { rows: 1, columns: 1, banks: 1 },
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

    /// Runs 40,000 cycles with a shot in every third cycle and an estimator of `cycles`. Returns row and column of each
    /// depth, with the bank that is filled meanwhile, the cycles from frame to frame, and those from the fall of
    /// `acquire` to the last depth of each row.
    fn scanned(p: &Params, cycles: u64) -> (Vec<[u64; 3]>, Vec<u64>, Vec<u64>) {
        let (mut ctrl, mut due, mut since, mut ended, mut handed) =
            (FrameCtrl::default(), None, 0, 0, 0);
        let (mut depths, mut frames, mut latencies) = (Vec::new(), Vec::new(), Vec::new());
        for cycle in 0..40_000 {
            if ctrl.algo_start {
                due = Some(cycle + 1 + cycles);
                handed = if ctrl.depth_column == 0 { ended } else { handed };
            }
            let algo_done = due == Some(cycle);
            if algo_done {
                let place = [ctrl.depth_row, ctrl.depth_column].map(|place| place.get());
                depths.push([place[0], place[1], ctrl.bank.into()]);
                if place[1] == p.scan.last_column() {
                    latencies.push(cycle - handed);
                }
            }
            if ctrl.frame_done {
                frames.push(cycle);
            }
            let (start, acquired) = (ctrl.acquire && since == 3, ctrl.acquire);
            since = if start || !acquired { 1 } else { since + 1 };
            ctrl = ctrl.next(&In { start, algo_done, ..ENABLED }, p);
            if ctrl.acquire != acquired {
                (since, ended) = (0, cycle + 1);
            }
        }
        let periods = frames.windows(2).map(|pair| pair[1] - pair[0]).collect();
        (depths, periods, latencies)
    }

    #[test]
    fn an_array_is_estimated_row_by_row_in_as_many_cycles_as_it_promises() {
        for (banks, columns, cycles) in
            [(1, 1, 267), (1, 2, 50), (2, 1, 20), (2, 4, 50), (2, 4, 500)]
        {
            let p = Params { scan: Scan { rows: 3, columns, banks }, ..SHORT };
            let (depths, periods, latencies) = scanned(&p, cycles);
            let (columns, banks) = (u64::from(columns), u64::from(banks));
            let place = |k: u64| [k / columns % 3, k % columns, (k / columns + 1) % banks];
            assert_eq!(depths, (0..depths.len() as u64).map(place).collect::<Vec<_>>());
            let timing::RowTiming { row, latency, .. } = p.timing(3, cycles);
            let (first, others) = latencies.split_first().unwrap();
            assert!(*first <= latency && others.len() > 15, "{p:?}");
            assert!(others.iter().all(|&cycles| cycles == latency), "{p:?}: {others:?}");
            assert!(periods.iter().all(|&cycles| cycles == row), "{p:?}: {periods:?}");
        }
    }

    #[test]
    fn an_image_of_40_rows_takes_57_7_ms() {
        let scan = Scan { rows: 40, columns: 30, banks: 2 };
        let p = Params { shots_per_frame: 30_000, scan, ..SHORT };
        // The network and the likelihood estimator at 125 MHz, with a shot in six cycles.
        for (cycles, estimation) in [(267, 8_070), (3_779, 113_430)] {
            let timing = p.timing(6, cycles);
            assert_eq!(
                [timing.estimation, timing.row, timing.image],
                [estimation, 180_273, 7_210_920]
            );
        }
        let p = Params { scan: Scan { banks: 1, ..scan }, ..p };
        assert_eq!(p.timing(6, 267).row, 180_273 + 8_070);
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
