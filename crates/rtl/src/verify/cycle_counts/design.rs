//! Sizes that cycle counts depend on: how large the estimator is, and how the laser fires.

use tofsim::firmware::forward2::NEURONS;
use tofsim::firmware::histogram_builder::BINS;
use tofsim::firmware::likelihood_estimator::params::Params as Likelihood;
use tofsim::firmware::{estimator_ctrl, vcsel_driver};
use tofsim::kernel::sizes::Size;
use tofsim::sim::setup::Setup;

use crate::golden::parameters::{Parameter, sized};

/// The laser's Verilog.
const VCSEL_DRIVER: &str = include_str!("../../../../../rtl_ref/vcsel_driver.v");

/// Bins of the likelihood estimator's box, and of its fit before and after the one of the echo, unless set.
const BOX: usize = 15;
const BESIDE: usize = 26;

/// A macro: its name and its text.
pub type Define = (&'static str, String);

/// A design, as far as cycle counts depend on it.
#[derive(Clone, Debug)]
pub struct Design {
    /// Bins and neurons.
    pub estimator: estimator_ctrl::Params,
    /// Bins, box and fit of the likelihood estimator, where its model holds.
    pub likelihood: Option<Likelihood>,
    /// Periods and length of a pulse.
    pub laser: vcsel_driver::Params,
    /// Half a cycle of `clk_laser`, rounded down [ps].
    pub half_ps: u64,
    /// Parameters of the laser that are not the default.
    parameters: String,
    /// Bits of `laser_freq`, and of a count in the longest period.
    rate_bits: u32,
    period_bits: u32,
}

impl Design {
    /// Returns the design of a scenario.
    pub fn of(setup: &Setup) -> Self {
        let (sizes, laser) = (setup.params.sizes(), setup.params.vcsel_driver.clone());
        let own = sized(&setup.params, VCSEL_DRIVER);
        let set = |(name, value): &(&str, Parameter)| format!(".{name}({})", value.literal());
        Design {
            estimator: setup.params.depth_estimator.ctrl(),
            likelihood: setup.likelihood(setup.params.frame_ctrl.shots_per_frame.into()).ok(),
            half_ps: setup.pll().cycle.fs() / 4000,
            parameters: own.iter().map(set).collect::<Vec<_>>().join(", "),
            rate_bits: sizes.of(Size::RateBits),
            period_bits: sizes.of(Size::PeriodBits),
            laser,
        }
    }

    /// Cycles after which five shots must be over.
    pub fn patience(&self) -> u64 {
        6 * self.laser.longest_period() + 100
    }

    /// The macros that set numbers of bins and neurons, where they are not the default: another design need not
    /// have those parameters.
    pub fn of_estimator(&self) -> Vec<Define> {
        let sizes =
            [("NEURONS", self.estimator.neurons, NEURONS), ("BINS", self.estimator.bins, BINS)];
        let others = sizes.into_iter().filter(|(_, own, usual)| own != usual);
        others.map(|(name, own, _)| (name, own.to_string())).collect()
    }

    /// The macros that say how large the likelihood estimator is, and set its parameters where they are not the
    /// default.
    pub fn of_likelihood(&self) -> Vec<Define> {
        let Some(params) = &self.likelihood else { return Vec::new() };
        let bins = params.histogram.bins;
        let (before, after) = (params.before, params.after);
        let sizes = [
            ("BinBits", bins.ilog2() as usize, BINS.ilog2() as usize),
            ("BoxBins", params.box_bins, BOX),
            ("BinsBefore", before, BESIDE),
            ("BinsAfter", after, BESIDE),
        ];
        let others = sizes.iter().filter(|(_, own, usual)| own != usual);
        let own: Vec<_> = others.map(|(name, own, _)| format!(".{name}({own})")).collect();
        let mut defines = vec![
            ("LIKELIHOOD_BINS", bins.to_string()),
            ("LIKELIHOOD_BOX", params.box_bins.to_string()),
            ("LIKELIHOOD_BEFORE", before.to_string()),
            ("LIKELIHOOD_AFTER", after.to_string()),
        ];
        if !own.is_empty() {
            defines.push(("LIKELIHOOD", own.join(", ")));
        }
        defines
    }

    /// The macros that say how the laser fires, and set its parameters where they are not the default.
    pub fn of_laser(&self) -> Vec<Define> {
        let mut defines = vec![
            ("CODES", self.laser.periods.len().to_string()),
            ("RATE_BITS", self.rate_bits.to_string()),
            ("PERIOD_BITS", self.period_bits.to_string()),
            ("HALF", self.half_ps.to_string()),
            ("PATIENCE", self.patience().to_string()),
        ];
        if !self.parameters.is_empty() {
            let periods = Parameter::Words(self.laser.every_period().to_vec());
            defines.push(("LASER", self.parameters.clone()));
            defines.push(("PERIODS", periods.literal()));
        }
        defines
    }

    /// All macros.
    pub fn defines(&self) -> Vec<Define> {
        [self.of_estimator(), self.of_likelihood(), self.of_laser()].concat()
    }
}

/// A text after the lines that define macros.
pub fn with_defines(defines: &[Define], text: &str) -> String {
    let line = |(name, value): &Define| format!("`define {name} {value}\n");
    defines.iter().map(line).collect::<String>() + text
}
