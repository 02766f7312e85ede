//! What golden vectors are made from.

use tofsim::firmware::carry_chain::TAPS;
use tofsim::firmware::histogram_builder::BINS;
use tofsim::sim::setup::Setup;

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

    /// Tap at each place in the order of arrival.
    pub fn order(&self) -> &[u16] {
        self.setup.params.tdc.delays.order()
    }

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
        let allowed = self.order().iter().take_while(|&&tap| (tap as usize) < self.taps).count();
        allowed.max(self.setup.params.tdc.delays.tap_0_position() + 1)
    }

    /// Lines of a block [clock cycles].
    pub fn cycles(&self) -> usize {
        self.cycles.unwrap_or(Self::CYCLES)
    }
}
