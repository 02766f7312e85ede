//! Steps the estimator through its pipeline (U_CTRL of thesis Fig. 6.18).
//!
//! Mirrors `rtl_ref/estimator_ctrl.v`. Edge e0 takes `algo_start`. P are the pairs of neurons; the depth
//! is there in cycle D, the larger of 259 + neurons and 263 + P: 267 with the thesis's eight neurons.
//!
//! ```text
//! registers    read_addr   word, weight  product      l1_in        entry  l1_out
//! loaded at    e0 .. e255  e1 .. e256    e2 .. e257   e3 .. e258   e259   e260
//! control                                forward1_en               tansig_en
//!
//! registers    activation, weight  product         sum             depth
//! loaded at    e261 .. e260+P      e262 .. e261+P  e263 .. e262+P  D
//! control      pair                                forward2_en     depth_en, algo_done
//! ```
//!
//! From eight neurons on nothing waits for anything but the depth, which keeps the latency that one
//! product an edge had. A start while busy is ignored; one in the cycle of `algo_done` is taken.

use crate::kernel::{Clocked, U};
use crate::signals;

use super::histogram_builder::BINS;

/// Words of the histogram.
const WORDS: u64 = BINS as u64;
/// First cycle in which the hidden layer accumulates, counted from e0.
const SUMS_1: u64 = 2;
/// Cycle before the edge that looks up the activations.
pub const TANSIG: u64 = SUMS_1 + WORDS;
/// Cycle before the edge that makes operands of the first pair.
const OPERANDS: u64 = TANSIG + 2;
/// First cycle in which the output layer accumulates.
const SUMS_2: u64 = OPERANDS + 2;

/// Edges in which two neurons each are added.
pub const fn pairs(neurons: usize) -> u64 {
    neurons.div_ceil(2) as u64
}

/// Cycle in which the depth is ready with so many neurons: the estimator's latency [cycles of
/// clk_sys].
pub const fn done(neurons: usize) -> u64 {
    let (sums_end, serial) = (SUMS_2 + pairs(neurons), TANSIG + neurons as u64);
    (if sums_end > serial { sums_end } else { serial }) + 1
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
        pub read_addr: U<8>,
        /// Row of weights to fetch: that of the coming word.
        pub rom_addr: U<8>,
        /// The sums of the hidden layer begin.
        pub forward1_first: bool,
        /// The hidden layer accumulates.
        #[view(heading = "Estimator", probe = true)]
        pub forward1_en: bool,
        /// The activations are looked up.
        #[view(heading = "Estimator", probe = true)]
        pub tansig_en: bool,
        /// Neurons whose activations become operands: twice this, and the next.
        pub pair: U<3>,
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
        pub(crate) step: U<9>,
    }
}

impl EstimatorCtrl {
    /// Cycles since e0, up to the one of `algo_done`, with so many neurons.
    pub fn phase(&self, neurons: usize) -> Option<u64> {
        if self.algo_done { Some(done(neurons)) } else { self.busy.then(|| self.step.get()) }
    }

    /// In cycle `step` of an estimation.
    pub(crate) fn at(step: u64, neurons: usize) -> Self {
        let (done, pairs) = (done(neurons), pairs(neurons));
        let within = |first: u64, cycles: u64| (first..first + cycles).contains(&step);
        let place = |first: u64, end: u64| if within(first, end) { step - first } else { 0 };
        EstimatorCtrl {
            read_en: within(0, WORDS),
            read_addr: U::new(place(0, WORDS)),
            rom_addr: U::new(if within(0, WORDS - 1) { step + 1 } else { 0 }),
            forward1_first: step == SUMS_1,
            forward1_en: within(SUMS_1, WORDS),
            tansig_en: step == TANSIG,
            pair: U::new(place(OPERANDS, pairs)),
            forward2_first: step == SUMS_2,
            forward2_en: within(SUMS_2, pairs),
            depth_en: step == done - 1,
            algo_done: step == done,
            busy: step < done,
            step: U::new(if step < done { step } else { 0 }),
        }
    }
}

impl Clocked for EstimatorCtrl {
    type In = In;
    /// Hidden neurons.
    type Params = usize;

    #[inline]
    fn next(&self, i: &In, &neurons: &usize) -> Self {
        match self.busy {
            _ if i.rst => Self::default(),
            true => Self::at(self.step.get() + 1, neurons),
            false if i.algo_start => Self::at(0, neurons),
            false => Self::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GO: In = In { rst: false, algo_start: true };
    const IDLE: In = In { rst: false, algo_start: false };

    /// The control in each cycle from e0 on, `again` high in one of them.
    fn cycles(neurons: usize, again: Option<usize>) -> Vec<EstimatorCtrl> {
        let mut ctrl = EstimatorCtrl::default().next(&GO, &neurons);
        (0..300)
            .map(|cycle| {
                let now = ctrl;
                ctrl = ctrl.next(if again == Some(cycle) { &GO } else { &IDLE }, &neurons);
                now
            })
            .collect()
    }

    fn high(cycles: &[EstimatorCtrl], signal: impl Fn(&EstimatorCtrl) -> bool) -> Vec<usize> {
        (0..cycles.len()).filter(|&cycle| signal(&cycles[cycle])).collect()
    }

    #[test]
    fn the_depth_is_ready_267_edges_after_the_start_is_taken_and_with_16_neurons_275() {
        for (neurons, edges) in [(8, 267), (16, 275), (9, 268), (7, 267), (6, 266), (1, 264)] {
            let cycles = cycles(neurons, None);
            assert_eq!(high(&cycles, |ctrl| ctrl.algo_done), [edges]);
            assert_eq!(high(&cycles, |ctrl| ctrl.depth_en), [edges - 1]);
            assert_eq!(cycles[edges].phase(neurons), Some(done(neurons)));
            assert_eq!(cycles[299], EstimatorCtrl::default());
        }
    }

    #[test]
    fn the_enables_follow_the_words_through_the_pipeline() {
        for (neurons, pairs) in [(8, 4), (16, 8), (7, 4), (1, 1)] {
            let cycles = cycles(neurons, None);
            assert!(high(&cycles, |ctrl| ctrl.read_en).into_iter().eq(0..256));
            assert!(high(&cycles, |ctrl| ctrl.forward1_en).into_iter().eq(2..258));
            assert_eq!(high(&cycles, |ctrl| ctrl.tansig_en), [258]);
            assert!(high(&cycles, |ctrl| ctrl.forward2_en).into_iter().eq(262..262 + pairs));
            assert!((0..pairs).all(|pair| cycles[260 + pair].pair == pair as u64));
        }
    }

    #[test]
    fn a_start_while_busy_is_ignored_and_one_with_algo_done_is_taken() {
        assert_eq!(cycles(8, Some(266)), cycles(8, None));
        let again = cycles(8, Some(267));
        assert!(again[268].read_en && again[268].step == 0 && again[268].busy);
    }
}
