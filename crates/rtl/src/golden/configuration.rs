//! Configurations of a block beside the one that the scenario sets.

use std::sync::Arc;

use tofsim::error::Result;
use tofsim::firmware::likelihood_estimator::glass::Glass;
use tofsim::firmware::likelihood_estimator::params::Params;
use tofsim::firmware::likelihood_estimator::targets::Targets;
use tofsim::network::Fixed;
use tofsim::scenario::{self, DEFAULT};
use tofsim::sim::setup::Setup;

use super::setting::Setting;

/// Another choice of the parameters of a block.
#[derive(Debug)]
pub struct Configuration {
    /// Its name, after that of the block.
    pub name: &'static str,
    /// The scenario that has it.
    pub scenario: &'static str,
    /// Keys set in that scenario.
    pub set: &'static [&'static str],
    /// The parameters that tell a design of it. One that has not all of them cannot be it.
    pub parameters: &'static [&'static str],
    /// The module that it is about, if other people's designs need not have that.
    pub module: Option<&'static str>,
    /// Hidden neurons, if they are more than those of the scenario's network.
    pub neurons: Option<usize>,
    /// Whether a host controls the firmware.
    pub is_hosted: bool,
    /// Whether the likelihood estimator knows of a cover glass.
    pub has_glass: bool,
}

/// Sixteen hidden neurons.
pub const NEURONS_16: Configuration = Configuration {
    name: "neurons_16",
    set: &["estimator.network=uniform-16"],
    parameters: &["Neurons"],
    ..DEFAULTS
};

/// More neurons than any built-in network has, and an odd number of them.
pub const NEURONS_31: Configuration =
    Configuration { name: "neurons_31", neurons: Some(31), ..NEURONS_16 };

/// Two registers of the TDC's ones count.
pub const COUNT_STAGES_2: Configuration = Configuration {
    name: "count_stages_2",
    set: &["tdc.count_stages=2"],
    parameters: &["CountStages"],
    ..DEFAULTS
};

/// The leading bit of taps that are reached out of order.
pub const LEADING: Configuration = Configuration {
    name: "leading",
    set: &["tdc.decoder=leading", "tdc.profile=kintex7"],
    parameters: &["Decoder"],
    ..DEFAULTS
};

/// The leading bit of the same taps in the order in which they are reached.
pub const REORDERED: Configuration = Configuration {
    name: "reordered",
    set: &["tdc.decoder=reordered", "tdc.profile=kintex7"],
    parameters: &["Decoder", "Order"],
    ..DEFAULTS
};

/// Ages that the firmware computes, from few hits.
pub const CALIBRATED: Configuration = Configuration {
    name: "calibrated",
    set: &["tdc.recalibrate_frames=6", "tdc.calibration_hits_log2=10", "tdc.ring_ns=30"],
    parameters: &["Calibrated"],
    module: Some("tdc_calibration"),
    ..DEFAULTS
};

/// A faster clock, whose quarter of a period is no whole number of femtoseconds.
pub const CLOCKS: Configuration = Configuration {
    name: "clocks",
    set: &["pll.input_hz=150000000", "pll.multiply=13", "pll.divide=2", "pll.output_divide=6"],
    parameters: &["InputHz", "Multiply", "Divide", "OutputDivide"],
    ..DEFAULTS
};

/// Laser pulses of two cycles and a half.
pub const LONG_PULSE: Configuration =
    Configuration { name: "long_pulse", set: &["firmware.pulse_half_cycles=5"], ..DEFAULTS };

/// A host, whose guard can block the laser.
pub const HOSTED: Configuration = Configuration {
    name: "hosted",
    parameters: &["Hosted"],
    module: Some("laser_guard"),
    is_hosted: true,
    ..DEFAULTS
};

/// The same with laser pulses of two cycles and a half.
pub const HOSTED_LONG_PULSE: Configuration =
    Configuration { name: "hosted_long_pulse", set: LONG_PULSE.set, ..HOSTED };

/// A cover glass that the likelihood estimator knows.
pub const GLASS: Configuration = Configuration {
    name: "glass",
    parameters: &["GlassBins"],
    module: Some("likelihood_glass"),
    has_glass: true,
    ..DEFAULTS
};

/// Two targets that the likelihood estimator finds.
pub const TWO: Configuration = Configuration {
    name: "two",
    set: &["estimator.targets=2"],
    parameters: &["Targets"],
    module: Some("likelihood_pair"),
    ..DEFAULTS
};

/// Two targets behind a cover glass, the stronger one first.
pub const TWO_BEHIND_GLASS: Configuration = Configuration {
    name: "two_behind_glass",
    set: &["estimator.targets=2", "estimator.order=strongest"],
    parameters: &["Targets", "GlassBins"],
    has_glass: true,
    ..TWO
};

/// An array of pixels with two banks of histograms.
pub const ARRAY: Configuration = Configuration {
    name: "array",
    scenario: "array",
    set: &["array.rows=4", "array.columns=3", "estimator.kind=network"],
    parameters: &["Banks"],
    ..DEFAULTS
};

/// Nothing else than usual.
pub(super) const DEFAULTS: Configuration = Configuration {
    name: "",
    scenario: DEFAULT,
    set: &[],
    parameters: &[],
    module: None,
    neurons: None,
    is_hosted: false,
    has_glass: false,
};

impl Configuration {
    /// The setting with it.
    ///
    /// # Errors
    /// When its scenario cannot be loaded.
    pub fn setting(&self, base: &Setting) -> Result<Setting> {
        let set: Vec<_> = self.set.iter().map(|line| (*line).to_owned()).collect();
        let Setting { mut setup, array, .. } = Setting::of(scenario::load(self.scenario, &set)?)?;
        if let Some(neurons) = self.neurons {
            widen(&mut setup.network.fixed, neurons);
            let network = setup.network.params(&setup.params.histogram);
            setup.params.estimators.depth_estimator = Arc::new(network);
        }
        setup.params.is_hosted = self.is_hosted;
        let setting = Setting { setup, array, ..base.clone() };
        Ok(if self.has_glass { behind_glass(setting) } else { setting })
    }
}

/// Returns a setting whose likelihood estimator knows of a cover glass.
pub fn behind_glass(mut setting: Setting) -> Setting {
    let own = &*setting.setup.params.estimators.likelihood_estimator;
    let own = Params { glass: pedestal(&setting.setup), ..own.clone() };
    setting.setup.params.estimators.likelihood_estimator = Arc::new(own);
    setting
}

/// Returns a setting whose likelihood estimator finds two targets.
pub fn with_second(mut setting: Setting) -> Setting {
    let own = &*setting.setup.params.estimators.likelihood_estimator;
    if !own.has_second() {
        let own = Params { targets: Targets::NearestFirst, ..own.clone() };
        setting.setup.params.estimators.likelihood_estimator = Arc::new(own);
    }
    setting
}

/// Half a photon per shot from a cover glass, a deviation of the pulse after the laser edge.
fn pedestal(setup: &Setup) -> Glass {
    let (pulse, edges_ps) = (&setup.budget.pulse, setup.known_bins().edges_ps());
    let before = |ps: f64| if ps > 0.0 { pulse.part(ps - pulse.sigma_ps()) } else { 0.0 };
    let hazard = |ends: &[f64]| 0.5 * (before(ends[1]) - before(ends[0]));
    Glass::of(&edges_ps.windows(2).map(hazard).collect::<Vec<_>>())
}

/// Adds neurons to a network, up to so many: those that it has, the last one first, so that no neuron has the weights
/// of the one that a narrow index takes in its place.
fn widen(weights: &mut Fixed, neurons: usize) {
    for neuron in (0..weights.neurons()).rev().take(neurons - weights.neurons()) {
        weights.w1.push(weights.w1[neuron].clone());
        weights.b1.push(weights.b1[neuron]);
        weights.w2.push(weights.w2[neuron]);
    }
}
