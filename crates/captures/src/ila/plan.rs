//! A probe configuration resolved against a scenario's design.

use std::collections::HashMap;

use tofsim::error::{Input, Result};
use tofsim::kernel::Time;
use tofsim::sim::setup::Setup;

use crate::condition::{Bound, Condition, Operand};

use super::capture::Probe;
use super::clock::AnalyserClock;
use super::core::Shape;
use super::probes::{Design, SignalSlice};
use super::setup::AnalyserSetup;

/// Largest number of bits per sample.
pub const WIDEST: usize = 4096;

/// Range of buffer depths [samples].
const DEPTHS: std::ops::RangeInclusive<u64> = 1 << 10..=1 << 17;

/// Resolved configuration of a logic analyser.
#[derive(Clone, Debug)]
pub struct AnalyserPlan {
    /// The probes.
    pub probes: Vec<Probe>,
    /// Signal bits of each probe.
    pub bits: Vec<SignalSlice>,
    /// Dimensions of the capture.
    pub shape: Shape,
    /// Sampling clock.
    pub sampling: AnalyserClock,
    /// Trigger condition over `operands`; without one, every sample triggers.
    pub trigger: Option<Bound>,
    /// Storage qualifier over `operands`; without one, all samples are stored.
    pub qualifier: Option<Bound>,
    /// Bits that the conditions use.
    pub operands: Vec<SignalSlice>,
    /// Time at which the analyser is armed.
    pub arm_at: Time,
    /// Number of registers between the signals and the analyser [edges].
    pub input_stages: u64,
    /// Whether the analyser must see every change rather than only the edges of `clk_sys` and `clk_laser`.
    pub every_change: bool,
    /// Whether the run ends as soon as the buffer is full.
    pub stop_when_full: bool,
}

impl AnalyserPlan {
    /// Resolves a configuration against the design of `setup`.
    ///
    /// # Errors
    /// If it names a signal that the design does not have, or its numbers are inconsistent; with the position.
    pub fn new(set_up: &AnalyserSetup, setup: &Setup) -> Result<Self> {
        let design = Design::new(&setup.params);
        let (probes, bits) = probes(set_up, &design)?;
        let file = &set_up.file;
        let fault = |expected| set_up.fault("clock", &file.clock, expected);
        let sampling = file.clock.parse::<AnalyserClock>().map_err(fault)?;
        let mut operands = Vec::new();
        let mut bind = |key, text: &Option<String>| {
            let text = text.as_deref();
            text.map(|text| condition(set_up, key, text, &design, (&probes, &bits), &mut operands))
                .transpose()
        };
        let trigger = bind("trigger", &file.trigger)?;
        let qualifier = bind("capture", &file.capture)?;
        if !(0.0..=1e9).contains(&file.arm_at_us) {
            let expected = "expected a number from 0 to 1e9 [us]";
            return Err(set_up.fault("arm_at_us", file.arm_at_us, expected));
        }
        if file.input_stages > 6 {
            return Err(set_up.fault("input_stages", file.input_stages, "expected 0 to 6 [edges]"));
        }
        let oscillator = design.signal("clk_in").map(|bits| bits.id);
        let at_edges = matches!(sampling, AnalyserClock::System | AnalyserClock::Laser)
            && bits.iter().chain(&operands).all(|bits| Ok(bits.id) != oscillator);
        Ok(AnalyserPlan {
            every_change: !at_edges,
            shape: shape(set_up)?,
            probes,
            bits,
            sampling,
            trigger,
            qualifier,
            operands,
            arm_at: Time::from_ps_f64(file.arm_at_us * 1e6),
            input_stages: file.input_stages,
            stop_when_full: false,
        })
    }
}

fn probes(set_up: &AnalyserSetup, design: &Design) -> Result<(Vec<Probe>, Vec<SignalSlice>)> {
    let (mut probes, mut all_bits) = (Vec::<Probe>::new(), Vec::new());
    let (mut heads, mut width) = (HashMap::new(), 0);
    for (index, entry) in set_up.file.probe.iter().enumerate() {
        let key = |field| format!("probe.{index}.{field}");
        let found = design.probe(&entry.signal, entry.name.as_deref(), entry.radix.radix());
        let (probe, bits) =
            found.map_err(|expected| set_up.fault(&key("signal"), &entry.signal, expected))?;
        let field = if entry.name.is_some() { "name" } else { "signal" };
        if probe.name.is_empty() || probe.name.contains(char::is_control) {
            return Err(set_up.fault(&key(field), &probe.name, "expected a name, on one line"));
        }
        if let Some(earlier) = heads.insert(probe.head(), index) {
            let expected = format!("probe {earlier} has this name already: `{}`", probe.head());
            return Err(set_up.fault(&key(field), &probe.name, expected));
        }
        width += probe.width as usize;
        if width > WIDEST {
            let expected = format!("expected at most {WIDEST} bits in all, not {width}");
            return Err(set_up.fault(&key("signal"), &entry.signal, expected));
        }
        probes.push(probe);
        all_bits.push(bits);
    }
    if probes.is_empty() {
        Err(set_up.fault("probe", "nothing", "expected at least one [[probe]]"))
    } else {
        Ok((probes, all_bits))
    }
}

fn shape(set_up: &AnalyserSetup) -> Result<Shape> {
    let file = &set_up.file;
    if !file.depth.is_power_of_two() || !DEPTHS.contains(&file.depth) {
        let expected = "expected a power of two from 1024 to 131072 [samples]";
        return Err(set_up.fault("depth", file.depth, expected));
    }
    if file.windows == 0 || file.windows > file.depth {
        let expected = format!("expected 1 to {}, the samples of the buffer", file.depth);
        return Err(set_up.fault("windows", file.windows, expected));
    }
    let depth = 1 << (file.depth / file.windows).ilog2();
    let position = file.position.unwrap_or(depth / 2);
    if position >= depth {
        let expected = format!("expected 0 to {}, before the end of a window", depth - 1);
        return Err(set_up.fault("position", position, expected));
    }
    let (depth, position) = (depth as usize, position as usize);
    Ok(Shape { depth, windows: file.windows as usize, position })
}

/// Binds a condition, with names of probes taking precedence over paths of signals, and adds the bits that it uses.
fn condition(
    set_up: &AnalyserSetup,
    key: &str,
    text: &str,
    design: &Design,
    (probes, bits): (&[Probe], &[SignalSlice]),
    operands: &mut Vec<SignalSlice>,
) -> Result<Bound> {
    let mut find = |name: &str| {
        let probe = probes.iter().position(|probe| probe.name == name || probe.head() == name);
        let found = match probe {
            Some(probe) => bits[probe],
            None => design.signal(name).map_err(|expected| Input::new("", expected).value(name))?,
        };
        operands.push(found);
        let index = operands.len() - 1;
        Ok(Operand { index, width: found.width, signed: found.signed })
    };
    let condition = Condition::parse(set_up.origin(key), text);
    condition
        .and_then(|condition| condition.bind(&mut find))
        .map_err(|error| set_up.fault_within(key, error))
}
