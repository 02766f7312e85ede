//! A block as the golden vectors see it.

use tofsim::error::Result;
use tofsim::firmware::carry_chain::TAPS;
use tofsim::firmware::histogram_builder::BINS;
use tofsim::firmware::tof_top::TofTop;
use tofsim::hierarchy;
use tofsim::kernel::Time;
use tofsim::kernel::signals::Signals;
use tofsim::network::mem::Mem;
use tofsim::sim::setup::Setup;

use super::Vectors;
use super::cover::Cover;
use super::draw::Draw;
use super::timing::Timing;

/// What vectors are made from.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Network, chain, frame length and, for the top, light and control signals.
    pub setup: Setup,
    /// Whether the scenario, and not random control, is what the top runs.
    pub as_told: bool,
    /// Seed of the stimulus.
    pub seed: u64,
    /// Lines, if not as many as usual [clock cycles].
    pub cycles: Option<usize>,
    /// Frames of a scenario that the top runs as it is.
    pub frames: u64,
    /// Ones in the taps at most, for a design with a shorter chain [taps].
    pub taps: usize,
    /// Words of the histogram, for a design with a smaller one.
    pub bins: u64,
    /// Clock cycles that the estimator under test may take longer than ours; so long it is not
    /// started again.
    pub slack: u64,
}

impl Setting {
    /// Lines of each block unless told otherwise [clock cycles].
    const CYCLES: usize = 20_000;

    /// Hidden neurons.
    pub fn neurons(&self) -> usize {
        self.setup.params.depth_estimator.neurons()
    }

    /// Full-size chain and histogram, random control, the scenario's own seed.
    pub fn new(setup: Setup) -> Self {
        let seed = setup.scenario.seed;
        let (taps, bins) = (TAPS, BINS as u64);
        Setting { setup, as_told: false, seed, cycles: None, frames: 1, taps, bins, slack: 0 }
    }

    /// How many taps may be high, in the order of arrival, but tap 0 always.
    pub fn places(&self) -> usize {
        let delays = &self.setup.params.tdc.delays;
        let allowed = delays.order().iter().take_while(|&&tap| (tap as usize) < self.taps).count();
        allowed.max(delays.tap_0_position() + 1)
    }

    /// Lines of a block [clock cycles].
    pub fn cycles(&self) -> usize {
        self.cycles.unwrap_or(Self::CYCLES)
    }
}

/// How many clocks an effect takes at least, from the edge that takes the input to the one that
/// changes the output: 0 for a plain register. A combinational path has none.
#[derive(Clone, Copy, Debug)]
pub struct Latency {
    /// Input port.
    pub from: &'static str,
    /// Output port.
    pub to: &'static str,
    /// Clock cycles with so many neurons.
    pub cycles: fn(usize) -> u64,
}

/// An input that answers an output within the cycle, and so is no part of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Glue {
    /// The input port.
    pub drives: &'static str,
    /// Its declaration and driver in the bench.
    pub verilog: &'static str,
}

/// What a block is, beside its ports.
#[derive(Debug)]
pub struct Spec {
    /// Its module.
    pub name: &'static str,
    /// One place of it in the hierarchy, below the top.
    pub scope: &'static str,
    /// Number of the random stream that its stimulus has always had; a block without one has a stream
    /// that belongs to its name.
    pub stream: Option<u64>,
    /// When its clocks move and when it is looked at.
    pub timing: Timing,
    /// Its synchronous reset, active high.
    pub reset: Option<&'static str>,
    /// Outputs and registers that change within a cycle of the clock that counts.
    pub fast: &'static [&'static str],
    /// How long effects take.
    pub latency: &'static [Latency],
    /// A loop around the block, if it needs one.
    pub glue: Option<Glue>,
    /// Steps the Rust model.
    pub record: fn(&'static Spec, &Setting) -> Result<Vectors>,
}

impl Spec {
    /// Number of the random stream of its stimulus: whatever other blocks there are, it stays.
    pub fn stream(&self) -> u64 {
        // FNV-1a of the name, above all numbers that are given by hand.
        let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        let of_name = || self.name.bytes().fold(0xcbf2_9ce4_8422_2325, step) | 1 << 63;
        self.stream.unwrap_or_else(of_name)
    }

    /// Dotted path of the block in the hierarchy.
    pub fn path(&self) -> String {
        match self.scope {
            "" => hierarchy::TOP.to_owned(),
            scope => format!("{}.{scope}", hierarchy::TOP),
        }
    }
}

/// A Verilog parameter's value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// A number.
    Number(u64),
    /// A file name.
    File(&'static str),
}

/// Verilog parameter with the number of hidden neurons.
pub const NEURONS: &str = "Neurons";

/// That parameter, where it is not the default: so many another design need not have.
pub fn neurons(neurons: usize) -> Option<(&'static str, Parameter)> {
    let default = tofsim::firmware::forward2::NEURONS;
    (neurons != default).then_some((NEURONS, Parameter::Number(neurons as u64)))
}

/// A block that can be stepped alone, inside an otherwise idle top.
pub trait Block {
    /// What a line of the stimulus drives: its input ports, or what the bench makes them from.
    type Stimulus: Signals;

    /// The input of the coming edge. `top` shows the block before that edge.
    fn stimulus(&mut self, cycle: usize, top: &TofTop, draw: &mut Draw) -> Self::Stimulus;

    /// Combinational outputs, with the input in place.
    fn settle(&mut self, _: &Self::Stimulus, _: &mut TofTop) {}

    /// The edge that the cycle ends with.
    fn edge(&mut self, i: &Self::Stimulus, top: &mut TofTop);

    /// The whole cycle; `look` is called wherever the bench takes a sample.
    fn cycle(
        &mut self,
        _cycle: usize,
        i: &Self::Stimulus,
        top: &mut TofTop,
        look: &mut dyn FnMut(&TofTop),
    ) {
        self.settle(i, top);
        look(top);
        self.edge(i, top);
    }

    /// Verilog parameters.
    fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        Vec::new()
    }

    /// Memories that the Verilog loads.
    fn roms(&self) -> Vec<Mem> {
        Vec::new()
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
