//! A block as the recorder steps it.

use tofsim::firmware::tof_top::TofTop;
use tofsim::kernel::Time;
use tofsim::kernel::signals::Signals;
use tofsim::network::mem::Mem;
use tofsim::signals;

use super::cover::Cover;
use super::draw::Draw;
use super::parameters::Parameters;
use super::setting::Setting;

signals! {
    /// The stimulus of a block whose lines are empty.
    pub struct Nothing {}
}

/// A block that can be stepped alone, inside an otherwise idle top.
pub trait Block {
    /// What a line of the stimulus drives: its input ports, or what the bench makes them from.
    type Stimulus: Signals;

    /// The block before the first edge.
    fn new(setting: &Setting) -> Self;

    /// The input of the coming edge. `top` shows the block before that edge.
    fn stimulus(&mut self, cycle: usize, top: &TofTop, draw: &mut Draw) -> Self::Stimulus;

    /// Combinational outputs, with the input in place.
    fn settle(&mut self, _: &Self::Stimulus, _: &mut TofTop) {}

    /// The edge that the cycle ends with.
    fn edge(&mut self, _: &Self::Stimulus, _: &mut TofTop) {}

    /// The whole cycle; `sample` is called wherever the bench takes a sample.
    fn cycle(
        &mut self,
        _cycle: usize,
        i: &Self::Stimulus,
        top: &mut TofTop,
        sample: &mut dyn FnMut(&TofTop),
    ) {
        self.settle(i, top);
        sample(top);
        self.edge(i, top);
    }

    /// Verilog parameters.
    fn parameters(&self) -> Parameters {
        Vec::new()
    }

    /// A memory that no parameter names: the bench itself reads it.
    fn bench_memory(&self) -> Option<Mem> {
        None
    }

    /// When `tdc_stop` has changed, from the begin of the bench, in order.
    fn stops(&self) -> &[Time] {
        &[]
    }

    /// What the stimulus has reached.
    fn coverage(self) -> Vec<Cover>
    where
        Self: Sized,
    {
        Vec::new()
    }
}
