//! The neural depth estimator: wires its four blocks (thesis Fig. 6.18).
//!
//! Mirrors `rtl_ref/depth_estimator.v`. Its ports are those of the estimator slot (`algo_start count`, `read_en
//! read_addr depth algo_done`). How many bins and hidden neurons it has are
//! parameters: from eight neurons on, three cycles and one for each bin and each neuron, so 267 for the
//! thesis's 256 and eight, 2.136 us (see [`estimator_ctrl`]).

pub mod datapath;

use datapath::Datapath;

use std::sync::Arc;

use crate::connect;
use crate::kernel::Clocked;

use super::estimator_ctrl::{self, EstimatorCtrl};
use super::forward1::{self, Forward1, Row};
use super::forward2::{self, Forward2};
use super::histogram_builder;
use super::tansig::{self, Tansig};
use super::tof_top::slot::{Assumptions, EstimateWords, SlotEstimator, SlotOut};

pub use super::tof_top::slot::HistogramIn as In;

/// ROM contents.
#[derive(Clone, Debug)]
pub struct Params {
    /// MEM1.
    pub forward1: Arc<forward1::Rom>,
    /// MEM2.
    pub tansig: Arc<tansig::Rom>,
    /// MEM3.
    pub forward2: forward2::Rom,
}

/// The blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthEstimator {
    /// Sequence.
    pub estimator_ctrl: EstimatorCtrl,
    /// Hidden layer.
    pub forward1: Forward1,
    /// Activations.
    pub tansig: Tansig,
    /// Output layer.
    pub forward2: Forward2,
}

connect! {
    /// Port connections.
    pub struct Wires in depth_estimator (this: &DepthEstimator, i: &In) {
        output [read_en, read_addr] <- this.estimator_ctrl;
        output depth <- this.forward2.depth;
        output algo_done <- this.estimator_ctrl.algo_done;
    }
    estimator_ctrl(clk_sys): estimator_ctrl::In {
        [rst, algo_start] <- i;
    }
    forward1(clk_sys): forward1::In {
        rst <- i.rst;
        [forward1_first, forward1_en, rom_addr] <- this.estimator_ctrl;
        count <- i.count;
    }
    tansig(clk_sys): tansig::In {
        rst <- i.rst;
        tansig_en <- this.estimator_ctrl.tansig_en;
        l1_in <- this.forward1.l1_in;
    }
    forward2(clk_sys): forward2::In {
        rst <- i.rst;
        [pair, forward2_first, forward2_en, depth_en] <- this.estimator_ctrl;
        l1_out <- this.tansig.l1_out;
    }
}

impl Params {
    /// Hidden neurons.
    pub fn neurons(&self) -> usize {
        self.forward2.neurons
    }

    /// Returns the parameters of the control's steps.
    pub fn ctrl(&self) -> estimator_ctrl::Params {
        estimator_ctrl::Params { bins: self.forward1.w1.len(), neurons: self.neurons() }
    }
}

impl SlotEstimator for DepthEstimator {
    type In = In;
    type Params = Params;
    const ASSUMES: Assumptions = Assumptions::Training;

    /// A network whose weights are all zero, with the thesis's neurons and formats.
    fn params_for(histogram: &histogram_builder::Params) -> Params {
        let (datapath, neurons) = (Datapath::THESIS, forward2::NEURONS);
        let w1 = vec![Row::default(); histogram.bins];
        let forward1 = forward1::Rom::new(w1, Row::default(), neurons, &datapath, histogram);
        Params {
            forward1: Arc::new(forward1),
            tansig: tansig::Rom::of(&datapath),
            forward2: forward2::Rom {
                neurons,
                datapath,
                w2: Default::default(),
                b2: Default::default(),
            },
        }
    }

    fn rise(&mut self, i: &In, p: &Params) {
        let (estimator_ctrl, forward1) = (Wires::estimator_ctrl(self, i), Wires::forward1(self, i));
        let (tansig, forward2) = (Wires::tansig(self, i), Wires::forward2(self, i));

        self.estimator_ctrl.tick(&estimator_ctrl, &p.ctrl());
        self.forward1.tick(&forward1, &p.forward1);
        self.tansig.tick(&tansig, &p.tansig);
        self.forward2.tick(&forward2, &p.forward2);
    }

    #[inline(always)]
    fn outputs(&self) -> SlotOut {
        let EstimatorCtrl { read_en, read_addr, algo_done, .. } = self.estimator_ctrl;
        let words = EstimateWords::of_depth(self.forward2.depth);
        SlotOut { read_en, read_addr, words, algo_done }
    }

    fn cycles(p: &Params) -> u64 {
        p.ctrl().done()
    }

    fn phase(&self, p: &Params) -> Option<u64> {
        self.estimator_ctrl.phase(&p.ctrl())
    }

    fn rests(&self, i: &In, p: &Params) -> bool {
        fn rests<C: Clocked>(block: &C, i: &C::In, p: &C::Params) -> bool {
            block.next(i, p) == *block
        }
        rests(&self.estimator_ctrl, &Wires::estimator_ctrl(self, i), &p.ctrl())
            && rests(&self.forward2, &Wires::forward2(self, i), &p.forward2)
            && rests(&self.tansig, &Wires::tansig(self, i), &p.tansig)
            && rests(&self.forward1, &Wires::forward1(self, i), &p.forward1)
    }
}
