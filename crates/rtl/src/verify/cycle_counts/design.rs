//! Sizes that cycle counts depend on: how large the estimator is, and how the laser fires.

use tofsim::firmware::forward2::NEURONS;
use tofsim::firmware::histogram_builder::BINS;
use tofsim::firmware::likelihood_estimator::params::Params as Likelihood;
use tofsim::firmware::likelihood_solver::instruction::Instruction;
use tofsim::firmware::likelihood_solver::program::Program;
use tofsim::firmware::{estimator_ctrl, vcsel_driver};
use tofsim::kernel::sizes::Size;
use tofsim::sim::setup::Setup;

use crate::golden::parameters::{Parameter, sized};

use super::scan::CountedScan;

/// The laser's Verilog.
const VCSEL_DRIVER: &str = include_str!("../../../../../rtl_ref/vcsel_driver.v");

/// Bins of the likelihood estimator's box, and of its fit before and after the one of the echo, unless set.
const BOX: usize = 15;
const BESIDE: usize = 26;

/// A macro: its name and its text.
pub type Define = (&'static str, String);

/// A design, as far as cycle counts depend on it.
#[derive(Clone, Debug)]
pub struct CountedDesign {
    /// Bins and neurons.
    pub estimator: estimator_ctrl::Params,
    /// Bins, box and fit of the likelihood estimator, where its model holds.
    pub likelihood: Option<Likelihood>,
    /// Periods and length of a pulse.
    pub laser: vcsel_driver::Params,
    /// Half a cycle of `clk_laser`, rounded down [ps].
    pub half_ps: u64,
    /// Rows, columns and banks, if there are any.
    pub scan: Option<CountedScan>,
    /// Parameters of the laser that are not the default, as an instance sets them.
    parameters: String,
    /// Bits of `laser_freq`, and of a count in the longest period.
    rate_bits: u32,
    period_bits: u32,
}

impl CountedDesign {
    /// Returns the design of a scenario.
    pub fn of(setup: &Setup) -> Self {
        let (sizes, laser) = (setup.params.sizes(), setup.params.vcsel_driver.clone());
        let own = sized(&setup.params, VCSEL_DRIVER);
        let own = own.iter().map(|(name, value)| format!(".{name}({})", value.literal()));
        CountedDesign {
            estimator: setup.params.estimators.depth_estimator.ctrl(),
            likelihood: setup.likelihood(setup.params.frame_ctrl.shots_per_frame.into()).ok(),
            half_ps: setup.pll().cycle.fs() / 4000,
            scan: CountedScan::of(setup),
            parameters: set(own.collect()),
            rate_bits: sizes.of(Size::RateBits),
            period_bits: sizes.of(Size::PeriodBits),
            laser,
        }
    }

    /// Cycles after which five shots must be over.
    pub fn patience(&self) -> u64 {
        6 * self.laser.longest_period() + 100
    }

    /// The macros with numbers of bins and neurons, and the parameters that set them.
    pub fn of_estimator(&self) -> Vec<Define> {
        let estimator_ctrl::Params { bins, neurons } = self.estimator;
        let bin_bits = ("BinBits", bins.ilog2() as usize, BINS.ilog2() as usize);
        vec![
            ("BINS", bins.to_string()),
            ("NEURONS", neurons.to_string()),
            ("NETWORK", others(&[("Neurons", neurons, NEURONS), bin_bits])),
            ("CENTROID", others(&[bin_bits])),
        ]
    }

    /// The programs of the likelihood estimator's solver.
    pub fn program(&self) -> &'static Program {
        self.likelihood.as_ref().map_or_else(|| Program::of(false, false), Likelihood::program)
    }

    /// The macros that say how large the likelihood estimator is, and its parameters.
    pub fn of_likelihood(&self) -> Vec<Define> {
        let Some(params) = &self.likelihood else { return Vec::new() };
        let bins = params.histogram.bins;
        let (before, after) = (params.before, params.after);
        let sizes = [
            ("BinBits", bins.ilog2() as usize, BINS.ilog2() as usize),
            ("BoxBins", params.box_bins, BOX),
            ("BinsBefore", before, BESIDE),
            ("BinsAfter", after, BESIDE),
            ("GlassBins", params.glass.bins(), 0),
            ("Targets", params.targets.most() as usize, 1),
        ];
        vec![
            ("LIKELIHOOD_BINS", bins.to_string()),
            ("LIKELIHOOD_BOX", params.box_bins.to_string()),
            ("LIKELIHOOD_BEFORE", before.to_string()),
            ("LIKELIHOOD_AFTER", after.to_string()),
            ("LIKELIHOOD_GLASS", params.glass.bins().to_string()),
            ("LIKELIHOOD_TARGETS", params.targets.most().to_string()),
            ("LIKELIHOOD", others(&sizes)),
        ]
        .into_iter()
        .chain(params.has_second().then(|| ("LIKELIHOOD_HAS_SECOND", String::new())))
        .chain(of_program(params.program()))
        .collect()
    }

    /// The macros that say how the laser fires, and its parameters. The periods are known where it has any.
    pub fn of_laser(&self) -> Vec<Define> {
        let mut defines = vec![
            ("CODES", self.laser.periods.len().to_string()),
            ("RATE_BITS", self.rate_bits.to_string()),
            ("PERIOD_BITS", self.period_bits.to_string()),
            ("HALF", self.half_ps.to_string()),
            ("PATIENCE", self.patience().to_string()),
            ("LASER", self.parameters.clone()),
        ];
        if !self.parameters.is_empty() {
            let periods = Parameter::Words(self.laser.every_period().to_vec());
            defines.push(("PERIODS", periods.literal()));
        }
        defines
    }

    /// All macros.
    pub fn defines(&self) -> Vec<Define> {
        let of_scan = self.scan.map_or_else(Vec::new, |scan| scan.defines());
        [self.of_estimator(), self.of_likelihood(), self.of_laser(), of_scan].concat()
    }
}

/// Parameters of an instance, of those that are not the default: another design need not have them.
fn others(sizes: &[(&str, usize, usize)]) -> String {
    let others = sizes.iter().filter(|(_, own, usual)| own != usual);
    set(others.map(|(name, own, _)| format!(".{name}({own})")).collect())
}

/// The list of parameters of an instance, if there are any.
fn set(parameters: Vec<String>) -> String {
    if parameters.is_empty() { String::new() } else { format!("#({})", parameters.join(", ")) }
}

/// The text of a module after the lines that define macros.
pub fn with_defines(module: &str, defines: &[Define], text: &str) -> String {
    let line = |(name, value): &Define| format!("`define {name} {value}\n");
    let lines: String = defines.iter().map(line).collect();
    format!("`define MODULE {module}\n{lines}{text}")
}

/// The macros with the programs of the likelihood estimator's solver: first and last instruction and cycles of each, and
/// for each instruction the cycle in which it begins and how long it waits for that.
fn of_program(program: &Program) -> [Define; 7] {
    let Program { instructions, ambient, start, step, end, second, swap } = program;
    // One target has four programs.
    let after = instructions.len() as u64;
    let [second, swap] = [second, swap].map(|entry| if *entry > 0 { *entry } else { after });
    let entries = [*ambient, *start, *step, *end, second, swap, after];
    let literal = |which: usize| {
        let (first, last) = (entries[which], entries[which + 1].saturating_sub(1));
        if first == after {
            return "30'd0".to_owned();
        }
        format!("{{7'd{first}, 7'd{last}, 16'd{}}}", program.cycles(first))
    };
    let mut begins = 0;
    let mut longest = 0;
    let line = |(place, instruction): (usize, &Instruction)| {
        if entries.contains(&(place as u64)) {
            (begins, longest) = (0, 0);
        }
        let line = format!("7'd{place}: {{begins, longest}} = {{16'd{begins}, 16'd{longest}}};");
        begins += u64::from(instruction.wait);
        longest = u64::from(instruction.wait) - 1;
        line
    };
    let lines: Vec<_> = instructions.iter().enumerate().map(line).collect();
    [
        ("LIKELIHOOD_AMBIENT", literal(0)),
        ("LIKELIHOOD_START", literal(1)),
        ("LIKELIHOOD_STEP", literal(2)),
        ("LIKELIHOOD_END", literal(3)),
        ("LIKELIHOOD_SECOND", literal(4)),
        ("LIKELIHOOD_SWAP", literal(5)),
        ("LIKELIHOOD_PROGRAM", lines.join(" ")),
    ]
}
