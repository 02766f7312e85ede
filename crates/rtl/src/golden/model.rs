//! Steps a block of the model by itself, with inputs from elsewhere.

use std::cell::RefCell;

use tofsim::firmware::carry_chain::{Taps, Transitions};
use tofsim::firmware::pll::Pll;
use tofsim::firmware::tof_top::{Params, TofTop};
use tofsim::kernel::Time;
use tofsim::kernel::signals::{Signal, Signals};

use super::inputs::Inputs;

/// An edge of a block's clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// Its clock rises; of a block with both, both do.
    Rise,
    /// `clk_laser` rises alone.
    Middle,
    /// `clk_laser` falls.
    Fall,
}

/// Functions that step a block.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    /// The input ports that it reads.
    pub inputs: fn() -> Vec<Signal>,
    /// Updates what follows from the inputs, or from the time, before an edge.
    pub settle: fn(&mut Stepping),
    /// The edge.
    pub edge: fn(&mut Stepping),
}

impl Model {
    /// A block with those inputs whose outputs are registers.
    pub const fn new<S: Signals>(edge: fn(&mut Stepping)) -> Self {
        Model { inputs: S::list, settle: |_| {}, edge }
    }

    /// A block without a clock.
    pub const fn combinational<S: Signals>(settle: fn(&mut Stepping)) -> Self {
        Model { inputs: S::list, settle, edge: |_| {} }
    }
}

/// A block at an edge, or just before it.
pub struct Stepping<'a> {
    /// The block, inside an otherwise idle top.
    pub top: &'a mut TofTop,
    /// Parameters of the firmware.
    pub params: &'a Params,
    /// The clocks.
    pub pll: &'a Pll,
    /// The transitions of `tdc_stop`.
    pub transitions: &'a mut Transitions,
    /// The instant.
    pub now: Time,
    /// Edge that is taken.
    pub edge: Edge,
    pub(crate) inputs: RefCell<&'a mut Inputs>,
}

impl Stepping<'_> {
    /// The inputs.
    pub fn input<S: Signals>(&self) -> S {
        S::given(0, &mut **self.inputs.borrow_mut())
    }

    /// Samples the taps at the edge.
    pub fn taps(&mut self) -> Taps {
        self.transitions.sample(self.top.pins.tdc_stop, self.now, &self.params.tdc.delays)
    }
}
