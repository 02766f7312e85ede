//! Verilog parameters that the benches set, and the memories that some of them name.

use tofsim::firmware::carry_chain::Delays;
use tofsim::firmware::histogram_builder::{self, Bin, Count};
use tofsim::firmware::likelihood_estimator::targets::Targets;
use tofsim::firmware::tdc_decoder::Decoder;
use tofsim::firmware::tof_top::Params;
use tofsim::firmware::{
    centroid_estimator, depth_estimator, likelihood_estimator, pll, tdc_calibration, vcsel_driver,
};
use tofsim::kernel::sizes::{Size, Sizes};
use tofsim::network::mem::{self, Mem, digits, lines};

pub mod hash;
pub mod whole;

/// A parameter's value.
#[derive(Clone, Debug, PartialEq)]
pub enum Parameter {
    /// A number.
    Number(u64),
    /// Words of 16 bits side by side, the first one lowest.
    Words(Vec<u64>),
    /// The file name of a memory that the Verilog loads.
    Memory(Mem),
    /// A flag that is on, by which the Verilog loads further memories.
    Flag(Vec<Mem>),
}

impl Parameter {
    /// As Verilog writes it.
    pub fn literal(&self) -> String {
        match self {
            Parameter::Number(number) if *number > i32::MAX as u64 => format!("64'd{number}"),
            Parameter::Number(number) => number.to_string(),
            Parameter::Words(words) => {
                let words: Vec<_> = words.iter().rev().map(|word| format!("16'd{word}")).collect();
                format!("{{{}}}", words.join(", "))
            }
            Parameter::Memory(memory) => format!("\"{}\"", memory.name),
            Parameter::Flag(_) => "1".to_owned(),
        }
    }

    /// As VHDL writes it, without quotes.
    pub fn vhdl(&self) -> String {
        match self {
            Parameter::Number(number) => number.to_string(),
            Parameter::Words(words) => {
                words.iter().rev().map(|word| format!("{word:016b}")).collect()
            }
            Parameter::Memory(memory) => memory.name.to_string(),
            Parameter::Flag(_) => "1".to_owned(),
        }
    }
}

/// Names and values, in the order in which the benches set them.
pub type Parameters = Vec<(&'static str, Parameter)>;

/// Parameters that say what a design has. Benches set them before those that say how large it is.
const OPTIONS: [&str; 6] = ["Neurons", "CountStages", "Decoder", "Order", "Calibrated", "Hosted"];

/// Names of the parameters that a module's Verilog declares, in its order.
pub fn declared(verilog: &'static str) -> impl Iterator<Item = &'static str> {
    let declarations = verilog.lines().filter_map(|line| line.trim().strip_prefix("parameter "));
    let names = declarations.filter_map(|line| line.split(" = ").next()?.split(' ').next_back());
    names.take_while(|name| !name.is_empty())
}

/// Options of a module with that Verilog that are not the default: another design need not have them.
pub fn options(params: &Params, verilog: &'static str) -> Parameters {
    let declares = |option: &&str| declared(verilog).any(|name| name == *option);
    unusual(params, OPTIONS.into_iter().filter(declares))
}

/// Sizes of a module with that Verilog that are not the default: another design need not have them.
pub fn sized(params: &Params, verilog: &'static str) -> Parameters {
    unusual(params, sizes_of(verilog))
}

/// Names of a module's parameters that are no options.
fn sizes_of(verilog: &'static str) -> impl Iterator<Item = &'static str> {
    declared(verilog).filter(|name| !OPTIONS.contains(name))
}

/// Options and sizes of some names that are not the default.
fn unusual(params: &Params, names: impl Iterator<Item = &'static str>) -> Parameters {
    let usual = |name: &str, own: &Parameter| match (name, own) {
        (LASER_PERIODS, own) => *own == laser_periods(&vcsel_driver::Params::default()),
        (_, Parameter::Words(words)) => words.iter().all(|word| *word == 0),
        (name, own) => size(&Sizes::default(), name).unwrap_or(Parameter::Number(0)) == *own,
    };
    all(params, names).into_iter().filter(|(name, own)| !usual(name, own)).collect()
}

/// Options and sizes of some names.
fn all(params: &Params, names: impl Iterator<Item = &'static str>) -> Parameters {
    let (sizes, encoder) = (params.sizes(), &params.tdc.decoder.encoder);
    let value = |name| match name {
        LASER_PERIODS => Some(laser_periods(&params.vcsel_driver)),
        "Decoder" => Some(Parameter::Number(encoder.decoder() as u64)),
        "Order" if encoder.decoder() == Decoder::Reordered => {
            let places = (0u16..).zip(encoder.order());
            let steps = places.map(|(place, tap)| tap.wrapping_sub(place).into());
            Some(Parameter::Words(steps.collect()))
        }
        "Order" => Some(Parameter::Words(vec![0; params.tdc.delays.taps()])),
        name => size(&sizes, name),
    };
    names.filter_map(|name| Some((name, value(name)?))).collect()
}

/// Name of the parameter with the laser periods.
const LASER_PERIODS: &str = "LaserPeriods";

/// The laser period of every code [cycles of clk_sys].
fn laser_periods(laser: &vcsel_driver::Params) -> Parameter {
    Parameter::Words(laser.every_period().to_vec())
}

/// A size of that name.
fn size(sizes: &Sizes, name: &str) -> Option<Parameter> {
    Size::named(name).map(|size| Parameter::Number(sizes.of(size).into()))
}

/// Hits, frames and ages of the TDC's calibration.
pub fn tdc_calibration(own: &tdc_calibration::Params) -> Parameters {
    vec![
        ("HitsLog2", Parameter::Number(own.hits_log2.into())),
        ("CalibrationFrames", Parameter::Number(own.frames)),
        ("YoungestAge", Parameter::Number(own.begin)),
        ("EdgeAge", Parameter::Number(own.start)),
    ]
}

/// Oscillator and dividers of the PLL, where they are not the default.
pub fn clocks(p: &pll::Params) -> Parameters {
    let usual = [pll::INPUT_HZ, pll::MULTIPLY, pll::DIVIDE, pll::OUTPUT_DIVIDE];
    let others = every_clock(p).into_iter().zip(usual);
    let others = others.filter(|((_, own), usual)| *own != Parameter::Number(*usual));
    others.map(|(own, _)| own).collect()
}

/// Oscillator and dividers of the PLL.
fn every_clock(p: &pll::Params) -> Parameters {
    let values = [
        ("InputHz", p.input_hz),
        ("Multiply", p.multiply),
        ("Divide", p.divide),
        ("OutputDivide", p.output_divide),
    ];
    values.map(|(name, own)| (name, Parameter::Number(own))).into()
}

/// Memories under the names of their parameters.
pub fn files(
    names: impl IntoIterator<Item = &'static str>,
    memories: impl IntoIterator<Item = Mem>,
) -> Parameters {
    names.into_iter().zip(memories.into_iter().map(Parameter::Memory)).collect()
}

/// The memories among some parameters.
pub fn memories(parameters: &Parameters) -> impl Iterator<Item = &Mem> {
    parameters.iter().flat_map(|(_, value)| match value {
        Parameter::Memory(memory) => std::slice::from_ref(memory),
        Parameter::Flag(memories) => memories,
        Parameter::Number(_) | Parameter::Words(_) => &[],
    })
}

/// Memories of the depth estimator.
pub fn depth_estimator(params: &depth_estimator::Params) -> Parameters {
    let names = ["W1File", "B1File", "W2File", "B2File", "TansigFile"];
    files(names, mem::depth_estimator(params))
}

/// Window and scale of the centroid estimator.
pub fn centroid_estimator(params: &centroid_estimator::Params) -> Parameters {
    vec![
        ("HalfWidth", Parameter::Number(params.half_width)),
        ("Background", Parameter::Number(params.background.into())),
        ("Slope", Parameter::Number(params.slope.get())),
        ("Offset", Parameter::Number(params.offset.bits())),
    ]
}

/// Pulse, bins and memories of the likelihood estimator.
pub fn likelihood_estimator(params: &likelihood_estimator::params::Params) -> Parameters {
    let number = |value: u64| Parameter::Number(value);
    let mut list = vec![
        ("LikelihoodShots", number(params.shots)),
        ("BoxBins", number(params.box_bins as u64)),
        ("BinsBefore", number(params.before as u64)),
        ("BinsAfter", number(params.after as u64)),
        ("Kappa", number(params.kappa as u64)),
        ("StepLog2", number(params.step_log2.into())),
        ("PulseSigma", number(params.sigma as u64)),
        ("WindowEnd", number(params.end() as u64)),
        ("Metres", number(params.metres as u64)),
        ("MetresShift", number(params.metres_shift.into())),
        ("LaserDelay", number(params.delay as u64)),
    ];
    if params.glass.bins() > 0 {
        list.push(("GlassBins", number(params.glass.bins() as u64)));
        list.push(("GlassLight", number(params.glass.light as u64)));
    }
    if params.has_second() {
        list.push(("Targets", number(params.targets.most().into())));
        let is_strongest = params.targets == Targets::StrongestFirst;
        list.push(("Strongest", number(is_strongest.into())));
    }
    let names = ["EdgesFile", "PulseFile", "HazardFile", "LogFile", "ProgramFile", "GlassFile"];
    list.extend(files(names, mem::likelihood_estimator(params)));
    list
}

/// Parameters of a block of the likelihood estimator with that Verilog.
pub fn of_likelihood(params: &Params, verilog: &'static str) -> Parameters {
    let declares =
        |(own, _): &(&'static str, Parameter)| declared(verilog).any(|name| name == *own);
    let own =
        likelihood_estimator(&params.estimators.likelihood_estimator).into_iter().filter(declares);
    sized(params, verilog).into_iter().chain(own).collect()
}

/// When each tap is reached after a change of `tdc_stop`, in the order of the taps [fs].
pub fn tap_delays(delays: &Delays) -> Mem {
    let mut arrivals = vec![0; delays.order().len()];
    for (&tap, at) in delays.order().iter().zip(delays.arrivals()) {
        arrivals[tap as usize] = at.fs();
    }
    Mem::new("tap_delays.mem", lines(arrivals, 8))
}

/// The ROM of `code_preload`.
pub fn codes(rom: &[Bin], size: &histogram_builder::Params) -> Mem {
    let words = rom.iter().map(|code| code.get());
    Mem::new("codes.mem", lines(words, digits(size.bins.ilog2())))
}

/// The ROM of `histogram_preload`.
pub fn histogram(rom: &[Count], size: &histogram_builder::Params) -> Mem {
    let words = rom.iter().map(|count| count.get());
    Mem::new("histogram.mem", lines(words, digits(size.count_bits)))
}
