//! Steps the estimator through its cycles (U_CTRL of thesis Fig. 6.18).
//!
//! Mirrors `rtl_ref/estimator_ctrl.v`. Edge e0 takes `algo_start`; with the thesis's eight neurons it
//! takes 267 cycles, and each neuron more is one more product of the output layer:
//!
//! ```text
//! cycle         e0 .. e255   e256     e257     e258 .. e265  e266     e267
//! next edge     product      bias     tansig   product       bias     -
//! forward1_en   ^^^^^^^^^^^^^^^^^^^^
//! read_en       ^^^^^^^^^^^
//! tansig_en                           ^^^^^^
//! forward2_en                                  ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
//! algo_done                                                           ^^^^^^^^
//! ```
//!
//! A start while busy is ignored; one in the cycle of `algo_done` is taken.

use crate::kernel::{Clocked, U};
use crate::signals;

use super::forward1::BIAS_ROW;
/// Cycle of the hidden layer's bias, counted from e0.
const BIAS: u64 = BIAS_ROW as u64;
/// Cycle before the edge that looks up the activations.
const TANSIG: u64 = BIAS + 1;
/// First cycle of the output layer.
const FORWARD2: u64 = TANSIG + 1;

/// Cycle in which the depth is ready with so many neurons: the estimator's latency [cycles of
/// clk_125].
pub const fn done(neurons: usize) -> u64 {
    FORWARD2 + neurons as u64 + 1
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
        /// Row of weights to fetch for the cycle after; 256 is the bias.
        pub rom_addr: U<9>,
        /// The hidden layer accumulates.
        #[view(heading = "Estimator", probe = true)]
        pub forward1_en: bool,
        /// The activations are looked up.
        #[view(heading = "Estimator", probe = true)]
        pub tansig_en: bool,
        /// The output layer accumulates, or holds its result.
        #[view(heading = "Estimator", probe = true)]
        pub forward2_en: bool,
        /// Neuron to add; the one past the last is the bias, then none.
        pub neuron: U<5>,
        /// The depth is ready; one cycle.
        pub algo_done: bool,
        /// An estimation is under way.
        pub(crate) busy: bool,
        /// Cycles since e0.
        pub(crate) step: U<9>,
    }
}

impl EstimatorCtrl {
    /// Cycles since e0, up to the one of `algo_done`.
    pub fn phase(&self) -> Option<u64> {
        let done = self.algo_done.then(|| FORWARD2 + self.neuron.get());
        done.or_else(|| self.busy.then(|| self.step.get()))
    }
}

impl Clocked for EstimatorCtrl {
    type In = In;
    /// Hidden neurons.
    type Params = usize;

    #[inline]
    fn next(&self, i: &In, &neurons: &usize) -> Self {
        let (q, mut d, done) = (self, Self::default(), done(neurons));
        if q.busy || i.algo_start {
            let step = if q.busy { q.step.get() + 1 } else { 0 };
            let row = step.min(BIAS);
            d.busy = step < done;
            d.step = U::new(if d.busy { step } else { 0 });
            d.forward1_en = step <= BIAS;
            d.read_en = step < BIAS;
            d.read_addr = U::new(row);
            d.rom_addr = U::new(if row < BIAS { row + 1 } else { 0 });
            d.tansig_en = step == TANSIG;
            d.forward2_en = step >= FORWARD2;
            d.neuron = U::new(step.saturating_sub(FORWARD2));
            d.algo_done = step == done;
        }
        if i.rst { Self::default() } else { d }
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

    fn count(cycles: &[EstimatorCtrl], high: impl Fn(&EstimatorCtrl) -> bool) -> usize {
        cycles.iter().filter(|ctrl| high(ctrl)).count()
    }

    #[test]
    fn the_depth_is_ready_267_edges_after_the_start_is_taken_and_with_16_neurons_275() {
        for (neurons, edges) in [(8, 267), (16, 275), (1, 260)] {
            let cycles = cycles(neurons, None);
            assert_eq!(cycles.iter().position(|ctrl| ctrl.algo_done), Some(edges));
            assert_eq!(count(&cycles, |ctrl| ctrl.algo_done), 1);
            assert_eq!(cycles[edges].phase(), Some(done(neurons)));
            assert_eq!(cycles[299], EstimatorCtrl::default());
        }
    }

    #[test]
    fn the_enables_are_high_for_257_1_and_10_cycles() {
        for (neurons, forward2) in [(8, 10), (16, 18)] {
            let cycles = cycles(neurons, None);
            assert_eq!(count(&cycles, |ctrl| ctrl.forward1_en), 257);
            assert_eq!(count(&cycles, |ctrl| ctrl.read_en), 256);
            assert_eq!(count(&cycles, |ctrl| ctrl.tansig_en), 1);
            assert_eq!(count(&cycles, |ctrl| ctrl.forward2_en), forward2);
        }
    }

    #[test]
    fn a_start_while_busy_is_ignored_and_one_with_algo_done_is_taken() {
        assert_eq!(cycles(8, Some(266)), cycles(8, None));
        let again = cycles(8, Some(267));
        assert!(again[268].forward1_en && !again[268].forward2_en);
    }
}
