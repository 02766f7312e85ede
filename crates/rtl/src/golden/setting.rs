//! Settings of golden vectors.

use std::collections::BTreeSet;
use std::sync::Arc;

use tofsim::error::{Error, Input, Result};
use tofsim::firmware::carry_chain::TAPS;
use tofsim::firmware::depth_estimator::datapath::Datapath;
use tofsim::firmware::histogram_builder;
use tofsim::scenario::Loaded;
use tofsim::sim::setup::Setup;
use tofsim::sim::setup::array::ArraySetup;

/// Parameters of ours that are constants inside a design. Its constant is what the scenario says, so
/// the stimulus keeps to that, where it would try other values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Constants {
    /// These.
    These(BTreeSet<String>),
    /// All.
    All,
}

impl Constants {
    /// Returns whether the parameter of that name is a constant.
    pub fn has(&self, parameter: &str) -> bool {
        match self {
            Constants::These(names) => names.contains(parameter),
            Constants::All => true,
        }
    }
}

/// Settings of golden vectors.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Network, chain, frame length and, for the top, light and control signals.
    pub setup: Setup,
    /// The pixels, if the firmware scans an array.
    pub array: Option<Arc<ArraySetup>>,
    /// True if the top runs the scenario as it is, and not under random control.
    pub as_configured: bool,
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
    /// Shots of a frame, for a design that has them as a constant.
    pub shots_per_frame: Option<u32>,
    /// Other constants of the design.
    pub constants: Constants,
    /// True if the histogram has an address of its own for reading: then nothing is read while a word is
    /// cleared or counted, when ours shows that one.
    pub reads_apart: bool,
    /// Clock cycles that the estimator under test may take longer than ours; so long it is not
    /// started again.
    pub slack: u64,
    /// Clock cycles that the estimator under test may be faster than ours; ours is not started so shortly before its
    /// end, because that one has ended.
    pub lead: u64,
}

impl Setting {
    /// Lines of each block unless told otherwise [clock cycles].
    pub const CYCLES: usize = 20_000;

    /// Tap at each place in the order of arrival.
    pub fn order(&self) -> &[u16] {
        self.setup.params.tdc.delays.order()
    }

    /// Returns the size of the histogram.
    pub fn histogram(&self) -> histogram_builder::Params {
        self.setup.params.histogram
    }

    /// Number formats of the network.
    pub fn datapath(&self) -> &Datapath {
        &self.setup.params.estimators.depth_estimator.forward2.datapath
    }

    /// Hidden neurons.
    pub fn neurons(&self) -> usize {
        self.setup.params.estimators.depth_estimator.neurons()
    }

    /// The setting of a scenario, which may have an array.
    ///
    /// # Errors
    /// When it cannot be elaborated, or the firmware has no such array.
    pub fn of(loaded: Loaded) -> Result<Self> {
        let array = &loaded.scenario.array;
        if array.count() == 1 && array.banks == 1 {
            return Ok(Setting::new(Setup::new(loaded)?));
        }
        let array = ArraySetup::new(loaded)?;
        let setup = array.with_firmware()?;
        Ok(Setting { array: Some(Arc::new(array)), ..Setting::new(setup) })
    }

    /// Full-size chain and histogram, random control, the scenario's own seed.
    pub fn new(setup: Setup) -> Self {
        let seed = setup.scenario.seed;
        let (taps, bins) = (setup.params.tdc.delays.taps(), setup.params.histogram.bins as u64);
        Setting {
            setup,
            array: None,
            as_configured: false,
            seed,
            cycles: None,
            frames: 1,
            taps,
            bins,
            shots_per_frame: None,
            constants: Constants::These(BTreeSet::new()),
            reads_apart: false,
            slack: 0,
            lead: 0,
        }
    }

    /// Returns how many taps may be high, in the order of arrival, but tap 0 always.
    pub fn places(&self) -> usize {
        let allowed = self.order().iter().take_while(|&&tap| (tap as usize) < self.taps).count();
        allowed.max(self.setup.params.tdc.delays.tap_0_position() + 1)
    }

    /// Shots of a frame: `few`, unless the design has them as a constant.
    pub fn shots(&self, few: u32) -> u32 {
        let scenario = self.setup.params.frame_ctrl.shots_per_frame;
        let constant = self.constants.has("ShotsPerFrame").then_some(scenario);
        self.shots_per_frame.or(constant).unwrap_or(few)
    }

    /// A design has this constant inside, and the scenario does not say what is in it.
    pub fn lacks(&self, parameter: &str, key: &str) -> Error {
        let source = format!("scenario {}", self.setup.name);
        let expected = format!("expected what the constant {parameter} of the design holds");
        Input::new(source, expected).field(key).into()
    }

    /// Lines of a block whose stimulus sweeps through the taps: more for a longer chain than usual [clock
    /// cycles].
    pub fn cycles_of_chain(&self) -> usize {
        let taps = self.setup.params.tdc.delays.taps();
        self.cycles.unwrap_or(Self::CYCLES.max(Self::CYCLES / TAPS * taps))
    }

    /// Lines of a block [clock cycles].
    pub fn cycles(&self) -> usize {
        self.cycles.unwrap_or(Self::CYCLES)
    }
}
