//! Verilog parameters that the benches set, and the memories that some of them name.

use tofsim::firmware::carry_chain::Delays;
use tofsim::firmware::histogram_builder::{self, Bin, Count};
use tofsim::firmware::tdc_decoder::Decoder;
use tofsim::firmware::tof_top::{CodeSource, FirmwareEstimator, HistogramSource, Params, Sizes};
use tofsim::firmware::{
    centroid_estimator, depth_estimator, forward2, likelihood_estimator, pll, tdc_calibration,
    tdc_decoder, vcsel_driver,
};
use tofsim::kernel::U;
use tofsim::network::mem::{self, Mem, digits, lines};
use tofsim::sim::setup::Setup;

/// A parameter's value.
#[derive(Clone, Debug, PartialEq)]
pub enum Parameter {
    /// A number.
    Number(u64),
    /// Words of 16 bits side by side, the first one lowest.
    Words(Vec<u64>),
    /// The file name of a memory that the Verilog loads.
    Memory(Mem),
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
        }
    }
}

/// Names and values, in the order in which the benches set them.
pub type Parameters = Vec<(&'static str, Parameter)>;

/// The parameter with the number of hidden neurons.
pub const NEURONS: &str = "Neurons";

/// That parameter, where it is not the default: so many another design need not have.
pub fn neurons(neurons: usize) -> Option<(&'static str, Parameter)> {
    (neurons != forward2::NEURONS).then_some((NEURONS, Parameter::Number(neurons as u64)))
}

/// The parameter with the number of registers of the TDC's ones count.
pub const COUNT_STAGES: &str = "CountStages";

/// That parameter, where it is not the default.
pub fn count_stages(params: &tdc_decoder::Params) -> Option<(&'static str, Parameter)> {
    let stages = params.count_stages;
    (stages != tdc_decoder::COUNT_STAGES).then_some((COUNT_STAGES, Parameter::Number(stages)))
}

/// The parameter with the number of the decoder.
pub const DECODER: &str = "Decoder";
/// The parameter with what it takes to put the taps in the order of arrival.
pub const ORDER: &str = "Order";

/// Those of how the taps are read, where they are not the default.
pub fn decoder(params: &tdc_decoder::Params) -> Parameters {
    let encoder = &params.encoder;
    let number = Decoder::ALL.iter().position(|one| *one == encoder.decoder()).unwrap_or_default();
    let mut list = Vec::new();
    if number > 0 {
        list.push((DECODER, Parameter::Number(number as u64)));
    }
    if encoder.decoder() == Decoder::Reordered {
        let places = (0u16..).zip(encoder.order());
        let steps = places.map(|(place, tap)| tap.wrapping_sub(place).into());
        list.push((ORDER, Parameter::Words(steps.collect())));
    }
    list
}

/// The block that they are of.
pub const CALIBRATION: &str = "tdc_calibration";

/// Those of the TDC's calibration, if it has one.
pub fn tdc_calibration(params: &Params) -> Parameters {
    let Some(own) = &params.tdc_calibration else { return Vec::new() };
    let mut list = sized(params, &["Taps", "AgeBits", "Cycle"]);
    list.extend(of_calibration(own));
    list
}

/// Those that it does not share.
fn of_calibration(own: &tdc_calibration::Params) -> Parameters {
    vec![
        ("HitsLog2", Parameter::Number(own.hits_log2.into())),
        ("CalibrationFrames", Parameter::Number(own.frames)),
        ("YoungestAge", Parameter::Number(own.begin)),
        ("EdgeAge", Parameter::Number(own.start)),
    ]
}

/// The parameter that says where the decoder's ages come from.
pub const CALIBRATED: &str = "Calibrated";

/// That parameter, where they do not come from the ROM.
pub fn calibrated(params: &tdc_decoder::Params) -> Option<(&'static str, Parameter)> {
    params.calibrated.map(|_| (CALIBRATED, Parameter::Number(1)))
}

/// The parameters of some names that say how large things are, where they are not the default: as large
/// another design need not have them.
pub fn sized(params: &Params, names: &[&'static str]) -> Parameters {
    let usual = (Sizes::default(), vcsel_driver::Params::default());
    let own = |name| {
        let own = size(&params.sizes(), &params.vcsel_driver, name);
        (own != size(&usual.0, &usual.1, name)).then_some((name, own))
    };
    names.iter().copied().filter_map(own).collect()
}

/// The parameter of a name that says how large something is.
fn size(sizes: &Sizes, laser: &vcsel_driver::Params, name: &str) -> Parameter {
    match name {
        LASER_PERIODS => Parameter::Words(laser.every_period().to_vec()),
        "PulseHalfCycles" => Parameter::Number(sizes.pulse_half_cycles.into()),
        "DrainCycles" => Parameter::Number(sizes.drain_cycles),
        "Cycle" => Parameter::Number(sizes.cycle),
        "Digits" => Parameter::Number(sizes.digits.into()),
        "W1Fraction" => Parameter::Number(sizes.datapath.w1.fraction.into()),
        "B1Fraction" => Parameter::Number(sizes.datapath.b1.fraction.into()),
        "W2Fraction" => Parameter::Number(sizes.datapath.w2.fraction.into()),
        "B2Fraction" => Parameter::Number(sizes.datapath.b2.fraction.into()),
        "ActivationFraction" => Parameter::Number(sizes.datapath.l1_out.fraction.into()),
        "AddressBits" => Parameter::Number(sizes.datapath.address_bits.into()),
        "RangeLog2" => Parameter::Number(sizes.datapath.range_log2.into()),
        name => Parameter::Number(sizes.width(name).unwrap_or_default().into()),
    }
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

/// The parameter with the laser periods.
const LASER_PERIODS: &str = "LaserPeriods";
/// Of [`sized`], those on which widths of ports depend.
pub const SHAPES: [&str; 10] = [
    NEURONS,
    "Taps",
    "AgeBits",
    "CoarseBits",
    "RateBits",
    "Halves",
    "BinBits",
    "CountBits",
    "SumBits",
    "ActivationBits",
];
/// Of [`sized`], those of the decoder.
pub const OF_DECODER: [&str; 6] = ["Taps", "CoarseBits", "BinBits", "Cycle", "Digits", "AgeBits"];
/// Of [`sized`], those of the hidden layer.
pub const OF_FORWARD1: [&str; 7] =
    ["BinBits", "CountBits", "SumBits", "W1Bits", "W1Fraction", "B1Bits", "B1Fraction"];
/// Of [`sized`], those of the activation.
pub const OF_TANSIG: [&str; 5] =
    ["SumBits", "W1Fraction", "AddressBits", "RangeLog2", "ActivationBits"];
/// Of [`sized`], those of the output layer.
pub const OF_FORWARD2: [&str; 6] =
    ["ActivationBits", "ActivationFraction", "W2Bits", "W2Fraction", "B2Bits", "B2Fraction"];
/// Of [`sized`], those of the network.
pub const OF_NETWORK: [&str; 15] = [
    "BinBits",
    "CountBits",
    "SumBits",
    "W1Bits",
    "W1Fraction",
    "B1Bits",
    "B1Fraction",
    "AddressBits",
    "RangeLog2",
    "ActivationBits",
    "ActivationFraction",
    "W2Bits",
    "W2Fraction",
    "B2Bits",
    "B2Fraction",
];
/// Of [`sized`], those of the whole beside the network's.
const OF_TOP: [&str; 10] = [
    "DrainCycles",
    LASER_PERIODS,
    "RateBits",
    "PeriodBits",
    "PulseHalfCycles",
    "Taps",
    "CoarseBits",
    "Cycle",
    "Digits",
    "AgeBits",
];

/// Those of a block of the depth estimator: its memories, how many neurons they are for, and its sizes of
/// some names.
pub fn with_neurons(
    mut memories: Parameters,
    count: usize,
    params: &Params,
    names: &[&'static str],
) -> Parameters {
    memories.extend(neurons(count));
    memories.extend(sized(params, names));
    memories
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
    parameters.iter().filter_map(|(_, value)| match value {
        Parameter::Memory(memory) => Some(memory),
        Parameter::Number(_) | Parameter::Words(_) => None,
    })
}

/// Those of the depth estimator, without the number of neurons.
pub fn depth_estimator(params: &depth_estimator::Params) -> Parameters {
    let names = ["W1File", "B1File", "W2File", "B2File", "TansigFile"];
    files(names, mem::depth_estimator(params))
}

/// Those of the centroid estimator.
pub fn centroid_estimator(params: &centroid_estimator::Params) -> Parameters {
    vec![
        ("HalfWidth", Parameter::Number(params.half_width)),
        ("Background", Parameter::Number(params.background.into())),
        ("Slope", Parameter::Number(params.slope.get())),
        ("Offset", Parameter::Number(params.offset.bits())),
    ]
}

/// Those of the likelihood estimator.
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
    let names = ["EdgesFile", "PulseFile", "HazardFile", "LogFile"];
    list.extend(files(names, mem::likelihood_estimator(params)));
    list
}

/// Those of a block of the likelihood estimator: of some names, and its sizes.
pub fn of_likelihood(params: &Params, names: &[&'static str]) -> Parameters {
    let mut list = sized(params, &["BinBits", "CountBits"]);
    let own = likelihood_estimator(&params.likelihood_estimator);
    list.extend(own.into_iter().filter(|(name, _)| names.contains(name)));
    list
}

/// Those of the whole firmware. The memory of an unused stand-in is loaded too: zeros.
pub fn tof_top(setup: &Setup) -> Parameters {
    use Parameter::{Memory, Number};
    let params = &setup.params;
    let mut list = vec![
        ("ShotsPerFrame", Number(params.frame_ctrl.shots_per_frame.into())),
        ("LockTime", Number(setup.pll().locked_at.ps())),
    ];
    list.extend(clocks(&setup.scenario.pll.params()));
    list.extend(depth_estimator(&params.depth_estimator));
    list.extend([
        ("CalFile", Memory(mem::tdc_decoder(&params.tdc.decoder))),
        ("DelaysFile", Memory(tap_delays(&params.tdc.delays))),
    ]);
    list.extend(neurons(params.depth_estimator.neurons()));
    list.extend(count_stages(&params.tdc.decoder));
    list.extend(decoder(&params.tdc.decoder));
    list.extend(calibrated(&params.tdc.decoder));
    list.extend(params.tdc_calibration.iter().flat_map(of_calibration));
    list.extend(sized(params, &OF_NETWORK));
    list.extend(sized(params, &OF_TOP));
    let (preloads_codes, rom) = match &params.code_source {
        CodeSource::Tdc => (false, &[U::new(0)][..]),
        CodeSource::Preload(rom) => (true, &rom[..]),
    };
    let (preloads_histogram, words) = match &params.histogram_source {
        HistogramSource::Builder => (false, &vec![U::new(0); params.histogram.bins][..]),
        HistogramSource::Preload(rom) => (true, &rom[..]),
    };
    list.extend([
        ("CodeSource", Number(preloads_codes.into())),
        ("Codes", Number(rom.len() as u64)),
        ("CodeFile", Memory(codes(rom, &params.histogram))),
        ("HistogramSource", Number(preloads_histogram.into())),
        ("HistogramFile", Memory(histogram(words, &params.histogram))),
    ]);
    if params.estimator != FirmwareEstimator::default() {
        list.push(("Estimator", Number(params.estimator.number())));
    }
    match params.estimator {
        FirmwareEstimator::Network => {}
        FirmwareEstimator::Centroid => {
            list.extend(centroid_estimator(&params.centroid_estimator));
        }
        FirmwareEstimator::Likelihood => {
            list.extend(likelihood_estimator(&params.likelihood_estimator));
        }
    }
    list
}

/// Those of the whole firmware, also where they are the default.
pub fn tof_top_in_full(setup: &Setup) -> Parameters {
    let params = &setup.params;
    let mut list = tof_top(setup);
    let mut all = every_clock(&setup.scenario.pll.params());
    all.push((NEURONS, Parameter::Number(params.depth_estimator.neurons() as u64)));
    all.push((COUNT_STAGES, Parameter::Number(params.tdc.decoder.count_stages)));
    all.push((DECODER, Parameter::Number(0)));
    all.push((ORDER, Parameter::Words(vec![0; params.tdc.delays.taps()])));
    all.push((CALIBRATED, Parameter::Number(0)));
    all.extend(of_calibration(&tdc_calibration::Params::stand_in(&params.tdc)));
    let (sizes, laser) = (params.sizes(), &params.vcsel_driver);
    let named = OF_NETWORK.iter().chain(&OF_TOP);
    all.extend(named.map(|&name| (name, size(&sizes, laser, name))));
    all.push(("Estimator", Parameter::Number(params.estimator.number())));
    all.extend(centroid_estimator(&params.centroid_estimator));
    all.extend(likelihood_estimator(&params.likelihood_estimator));
    let is_new = |(name, _): &(&str, Parameter)| list.iter().all(|(known, _)| known != name);
    let others: Vec<_> = all.into_iter().filter(is_new).collect();
    list.extend(others);
    list
}

/// When each tap is reached after a change of `tdc_stop`, in the order of the taps [fs].
pub fn tap_delays(delays: &Delays) -> Mem {
    let mut arrivals = vec![0; delays.order().len()];
    for (&tap, at) in delays.order().iter().zip(delays.arrivals()) {
        arrivals[tap as usize] = at.fs();
    }
    Mem { name: "tap_delays.mem", text: lines(arrivals, 8) }
}

/// The ROM of `code_preload`.
pub fn codes(rom: &[Bin], size: &histogram_builder::Params) -> Mem {
    let words = rom.iter().map(|code| code.get());
    Mem { name: "codes.mem", text: lines(words, digits(size.bins.ilog2())) }
}

/// The ROM of `histogram_preload`.
pub fn histogram(rom: &[Count], size: &histogram_builder::Params) -> Mem {
    let words = rom.iter().map(|count| count.get());
    Mem { name: "histogram.mem", text: lines(words, digits(size.count_bits)) }
}
