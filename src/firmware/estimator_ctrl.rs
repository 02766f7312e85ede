//! Steps the estimator through its pipeline (U_CTRL of thesis Fig. 6.18).
//!
//! Mirrors `rtl_ref/estimator_ctrl.v`. Edge e0 takes `algo_start`. B are the bins, P the pairs of neurons; the
//! depth is there in cycle D, the larger of B + 3 + neurons and B + 7 + P: 267 with the thesis's 256 bins and
//! eight neurons.
//!
//! ```text
//! registers    read_addr     word, weight  product      l1_in        entry  l1_out
//! loaded at    e0 .. e(B-1)  e1 .. eB      .. e(B+1)    .. e(B+2)    e(B+3) e(B+4)
//! control                                  forward1_en               tansig_en
//!
//! registers    activation, weight  product      sum          depth
//! loaded at    e(B+5) .. e(B+4+P)  .. e(B+5+P)  .. e(B+6+P)  D
//! control      pair                             forward2_en  depth_en, algo_done
//! ```
//!
//! From eight neurons on nothing waits for anything but the depth, which keeps the latency that one
//! product an edge had. A start while busy is ignored; one in the cycle of `algo_done` is taken.

use crate::kernel::{Clocked, U};
use crate::signals;

use super::histogram_builder::Bin;

/// First cycle in which the hidden layer accumulates, counted from e0.
const SUMS_1: u64 = 2;

/// Verilog parameters: what the steps follow from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Params {
    /// Words of the histogram.
    pub bins: usize,
    /// Hidden neurons.
    pub neurons: usize,
}

impl Params {
    /// Words of the histogram, each read in one cycle.
    fn words(&self) -> u64 {
        self.bins as u64
    }

    /// Edges in which two neurons each are added.
    pub fn pairs(&self) -> u64 {
        self.neurons.div_ceil(2) as u64
    }

    /// Cycle before the edge that looks up the activations, counted from e0.
    pub fn tansig(&self) -> u64 {
        SUMS_1 + self.words()
    }

    /// Cycle before the edge that makes operands of the first pair.
    fn operands(&self) -> u64 {
        self.tansig() + 2
    }

    /// First cycle in which the output layer accumulates.
    fn sums_2(&self) -> u64 {
        self.operands() + 2
    }

    /// Cycle in which the depth is ready: the estimator's latency [cycles of clk_sys].
    pub fn done(&self) -> u64 {
        (self.sums_2() + self.pairs()).max(self.tansig() + self.neurons as u64) + 1
    }
}

signals! {
    /// Input ports.
    pub struct In {
        /// Synchronous reset.
        pub rst: bool,
        /// Starts an estimation.
        pub algo_start: bool,
    }
}

signals! {
    /// Registers; the public ones are the output ports.
    pub struct EstimatorCtrl {
        /// The histogram's word at `read_addr` is being read.
        pub read_en: bool,
        /// Word of the histogram.
        #[size(BinBits)]
        pub read_addr: Bin,
        /// Row of weights to fetch: that of the coming word.
        #[size(BinBits)]
        pub rom_addr: Bin,
        /// The sums of the hidden layer begin.
        pub forward1_first: bool,
        /// The hidden layer accumulates.
        #[view(heading = "Estimator", probe = true)]
        pub forward1_en: bool,
        /// The activations are looked up.
        #[view(heading = "Estimator", probe = true)]
        pub tansig_en: bool,
        /// Neurons whose activations become operands: twice this, and the next.
        #[size(PairBits)]
        pub pair: U<4>,
        /// The sums of the output layer begin.
        pub forward2_first: bool,
        /// The output layer accumulates.
        #[view(heading = "Estimator", probe = true)]
        pub forward2_en: bool,
        /// Its sums become the depth.
        pub depth_en: bool,
        /// The depth is ready; one cycle.
        pub algo_done: bool,
        /// An estimation is under way.
        pub(crate) busy: bool,
        /// Cycles since e0.
        #[size(StepBits)]
        pub(crate) step: U<11>,
    }
}

impl EstimatorCtrl {
    /// Cycles since e0, up to the one of `algo_done`.
    pub fn phase(&self, p: &Params) -> Option<u64> {
        if self.algo_done { Some(p.done()) } else { self.busy.then(|| self.step.get()) }
    }

    /// In cycle `step` of an estimation.
    pub(crate) fn at(step: u64, p: &Params) -> Self {
        let (done, pairs, words) = (p.done(), p.pairs(), p.words());
        let (operands, sums_2) = (p.operands(), p.sums_2());
        let within = |first: u64, cycles: u64| (first..first + cycles).contains(&step);
        let place = |first: u64, end: u64| if within(first, end) { step - first } else { 0 };
        EstimatorCtrl {
            read_en: within(0, words),
            read_addr: U::new(place(0, words)),
            rom_addr: U::new(if within(0, words - 1) { step + 1 } else { 0 }),
            forward1_first: step == SUMS_1,
            forward1_en: within(SUMS_1, words),
            tansig_en: step == p.tansig(),
            pair: U::new(place(operands, pairs)),
            forward2_first: step == sums_2,
            forward2_en: within(sums_2, pairs),
            depth_en: step == done - 1,
            algo_done: step == done,
            busy: step < done,
            step: U::new(if step < done { step } else { 0 }),
        }
    }
}

impl Clocked for EstimatorCtrl {
    type In = In;
    type Params = Params;

    #[inline]
    fn next(&self, i: &In, p: &Params) -> Self {
        if i.rst {
            Self::default()
        } else if self.busy {
            Self::at(self.step.get() + 1, p)
        } else if i.algo_start {
            Self::at(0, p)
        } else {
            Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GO: In = In { rst: false, algo_start: true };
    const IDLE: In = In { rst: false, algo_start: false };

    const KC705: Params = Params { bins: 256, neurons: 8 };

    fn with(bins: usize, neurons: usize) -> Params {
        Params { bins, neurons }
    }

    /// The control in each cycle from e0 on, `again` high in one of them.
    fn cycles(p: &Params, again: Option<usize>) -> Vec<EstimatorCtrl> {
        let mut ctrl = EstimatorCtrl::default().next(&GO, p);
        (0..p.bins + 60)
            .map(|cycle| {
                let now = ctrl;
                ctrl = ctrl.next(if again == Some(cycle) { &GO } else { &IDLE }, p);
                now
            })
            .collect()
    }

    fn high(cycles: &[EstimatorCtrl], signal: impl Fn(&EstimatorCtrl) -> bool) -> Vec<usize> {
        (0..cycles.len()).filter(|&cycle| signal(&cycles[cycle])).collect()
    }

    #[test]
    fn the_depth_is_ready_267_edges_after_the_start_is_taken_and_with_16_neurons_275() {
        for (bins, neurons, edges) in [
            (256, 8, 267),
            (256, 16, 275),
            (256, 32, 291),
            (256, 9, 268),
            (256, 7, 267),
            (256, 6, 266),
            (256, 1, 264),
            (16, 8, 27),
            (1024, 16, 1043),
        ] {
            let p = with(bins, neurons);
            let cycles = cycles(&p, None);
            assert_eq!(high(&cycles, |ctrl| ctrl.algo_done), [edges]);
            assert_eq!(high(&cycles, |ctrl| ctrl.depth_en), [edges - 1]);
            assert_eq!(cycles[edges].phase(&p), Some(p.done()));
            assert_eq!(cycles[bins + 59], EstimatorCtrl::default());
        }
    }

    #[test]
    fn the_enables_follow_the_words_through_the_pipeline() {
        for (bins, neurons, pairs) in
            [(256, 8, 4), (64, 16, 8), (64, 32, 16), (256, 7, 4), (1024, 1, 1)]
        {
            let cycles = cycles(&with(bins, neurons), None);
            assert!(high(&cycles, |ctrl| ctrl.read_en).into_iter().eq(0..bins));
            assert!(high(&cycles, |ctrl| ctrl.forward1_en).into_iter().eq(2..bins + 2));
            assert_eq!(high(&cycles, |ctrl| ctrl.tansig_en), [bins + 2]);
            let sums_2 = bins + 6;
            assert!(high(&cycles, |ctrl| ctrl.forward2_en).into_iter().eq(sums_2..sums_2 + pairs));
            assert!((0..pairs).all(|pair| cycles[bins + 4 + pair].pair == pair as u64));
        }
    }

    #[test]
    fn a_start_while_busy_is_ignored_and_one_with_algo_done_is_taken() {
        assert_eq!(cycles(&KC705, Some(266)), cycles(&KC705, None));
        let again = cycles(&KC705, Some(267));
        assert!(again[268].read_en && again[268].step == 0 && again[268].busy);
    }
}
