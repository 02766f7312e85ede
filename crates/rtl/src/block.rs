//! A block of the model beside somebody else's: it takes the edges and the inputs of that one, and its outputs are
//! compared.

use std::cell::RefCell;
use std::sync::Arc;

use tofsim::Setup;
use tofsim::error::{Input, Result, hint};
use tofsim::firmware::carry_chain::Transitions;
use tofsim::firmware::tof_top::{CodeSource, HistogramSource, Pins, TofTop};
use tofsim::hierarchy::{self, Kind, Part};
use tofsim::kernel::Time;
use tofsim::waves::TapDigits;

use crate::golden::inputs::Inputs;
use crate::golden::model::{Edge, Model, Stepping};
use crate::golden::ports::Port;
use crate::golden::setting::{Constants, Setting};
use crate::golden::{BLOCKS, Spec, blocks, top};

mod layout;

use layout::Outputs;
pub use layout::{Layout, PortBits};

/// A block under way.
pub struct Block {
    spec: &'static Spec,
    model: Model,
    setup: Arc<Setup>,
    ports: Vec<Port>,
    top: TofTop,
    transitions: Transitions,
    inputs: Inputs,
    input_layout: Layout,
    part: Part,
    outputs: Outputs,
    edges: u64,
    /// Edges until outputs are compared; none before a reset.
    quiet: Option<u64>,
    last_stop: Time,
    /// The bit of its reset, if it has one.
    reset: Option<usize>,
}

/// An output that is not as the model has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    /// The port.
    pub port: String,
    /// The model's bits, in hexadecimal.
    pub expected: String,
    /// The other's, of which a digit with an unknown bit is x.
    pub got: String,
}

impl Block {
    /// A block as the scenario has it, before its first edge.
    ///
    /// # Errors
    /// When there is no such block, or the scenario does not have it, or what it has cannot be at the side of Verilog.
    pub fn new(setup: Arc<Setup>, name: &str) -> Result<Self> {
        let source = format!("scenario {}", setup.name);
        let fault = |expected: String| Input::new(&source, expected).field("block").value(name);
        let Some(spec) = blocks::find(name) else {
            let (hint, names) = hint(name, BLOCKS.iter().map(|spec| spec.name));
            return Err(fault(format!("no such block{hint}; there are {names}")).into());
        };
        let Some(model) = spec.model else {
            return Err(fault("this block cannot be stepped by itself".to_owned()).into());
        };
        if let Some(key) = lacks(&setup, name) {
            return Err(
                fault(format!("expected one that this scenario has: {key} is not set")).into()
            );
        }
        top::check(&setup)?;
        let sizes = setup.params.sizes();
        let ports = spec.ports(&sizes);
        let input_layout =
            Layout::new(ports.iter().filter(|port| !port.output && !port.is_clock()));
        let output_layout = Layout::new(ports.iter().filter(|port| port.output));
        let taps = || TapDigits::new(&setup.params.tdc.decoder.encoder);
        let find = |name: &str| input_layout.find(name).map(|place| (place.low, place.width));
        let inputs = Inputs::new(&(model.inputs)(), find, taps());
        let entries = hierarchy::every_entry_of(&sizes).into_iter();
        let own = entries.filter(|entry| entry.scope == spec.path() && entry.kind == Kind::Output);
        let ids: Vec<_> = own.map(|entry| (entry.id, entry.signal.name)).collect();
        let part = Part::of(ids.iter().map(|(id, _)| *id));
        let outputs = Outputs::new(output_layout, &ids, taps());
        let (top, transitions) =
            (TofTop::new(Pins::default(), &setup.params), Transitions::default());
        let reset = spec.reset.and_then(|name| input_layout.find(name)).map(|place| place.low);
        let quiet = if reset.is_some() { None } else { Some(settles(spec, &setup)?) };
        Ok(Block {
            spec,
            model,
            setup,
            ports,
            top,
            transitions,
            inputs,
            input_layout,
            part,
            outputs,
            edges: 0,
            quiet,
            last_stop: Time::ZERO,
            reset,
        })
    }

    /// Returns whether its registers have been reset, or without a reset have taken their first values: until
    /// then those of another implementation may differ.
    pub fn is_settled(&self) -> bool {
        self.quiet == Some(0)
    }

    /// Takes its registers for settled from power-up on.
    pub fn settle(&mut self) {
        self.quiet = Some(0);
    }

    /// Returns the block's specification.
    pub fn spec(&self) -> &'static Spec {
        self.spec
    }

    /// Its module.
    pub fn name(&self) -> &'static str {
        self.spec.name
    }

    /// Every port, clocks and inputs before outputs.
    pub fn ports(&self) -> &[Port] {
        &self.ports
    }

    /// Returns the layouts of the inputs beside the clocks, and of the outputs.
    pub fn layouts(&self) -> [&Layout; 2] {
        [&self.input_layout, &self.outputs.layout]
    }

    /// Edges so far at which its clock rose: the number of the present cycle.
    pub fn cycle(&self) -> u64 {
        self.edges
    }

    /// Its outputs just before an edge at `now` that takes those inputs.
    ///
    /// # Errors
    /// When the inputs are taps that no chain shows.
    pub fn outputs(&mut self, now: Time, inputs: &[u32]) -> Result<&[u32]> {
        self.take(now, inputs, Edge::Rise, self.model.settle)?;
        self.part.follow(&self.top, &mut self.outputs);
        Ok(&self.outputs.words)
    }

    /// The outputs that differ from those of the model, which [`Block::outputs`] gave last; a bit that is `unknown`
    /// differs from any. Words of it that are not there have none.
    pub fn mismatches(&self, got: &[u32], unknown: &[u32]) -> Vec<Mismatch> {
        let Outputs { layout, words, .. } = &self.outputs;
        if unknown.is_empty() && words.iter().zip(got).all(|(want, got)| want == got) {
            return Vec::new();
        }
        let differs = |place: &&PortBits| !place.agrees(words, got) || place.has_any(unknown);
        let mismatch = |place: &PortBits| Mismatch {
            port: place.name.clone(),
            expected: place.hex(words),
            got: place.hex_or_x(got, unknown),
        };
        layout.places().iter().filter(differs).map(mismatch).collect()
    }

    /// Takes an edge.
    ///
    /// # Errors
    /// As [`Block::outputs`].
    pub fn edge(&mut self, edge: Edge, now: Time, inputs: &[u32]) -> Result<()> {
        if edge == Edge::Rise {
            self.edges += 1;
            let resets = self.reset.is_some_and(|bit| inputs[bit / 32] >> (bit % 32) & 1 == 1);
            self.quiet =
                if resets { Some(0) } else { self.quiet.map(|edges| edges.saturating_sub(1)) };
        }
        self.take(now, inputs, edge, self.model.edge)
    }

    /// `tdc_stop` changes; an instant before the last one is taken for that one.
    pub fn stop(&mut self, now: Time, level: bool) {
        self.last_stop = now.max(self.last_stop);
        if level != self.top.pins.tdc_stop {
            self.top.pins.tdc_stop = level;
            self.transitions.push(self.last_stop);
        }
    }

    fn take(
        &mut self,
        now: Time,
        inputs: &[u32],
        edge: Edge,
        how: fn(&mut Stepping),
    ) -> Result<()> {
        self.inputs.words.clear();
        self.inputs.words.extend_from_slice(inputs);
        let (top, params, pll) = (&mut self.top, &self.setup.params, self.setup.pll());
        how(&mut Stepping {
            top,
            params,
            pll,
            transitions: &mut self.transitions,
            now,
            edge,
            inputs: RefCell::new(&mut self.inputs),
        });
        let Some(id) = self.inputs.strange.take() else { return Ok(()) };
        let port = (self.model.inputs)().swap_remove(id).name;
        let expected = "expected taps that change level at most 11 times, as those of a chain do";
        Err(Input::new(self.spec.name, expected).field(port).into())
    }
}

/// Edges until the registers of a block without a reset have taken their first values.
fn settles(spec: &'static Spec, setup: &Setup) -> Result<u64> {
    let setting =
        Setting { cycles: Some(1), constants: Constants::All, ..Setting::new(setup.clone()) };
    Ok((spec.record)(spec, &setting)?.settles as u64)
}

/// Returns the key that a scenario without that block lacks.
fn lacks(setup: &Setup, block: &str) -> Option<&'static str> {
    let params = &setup.params;
    match (block, &params.code_source, &params.histogram_source, &params.tdc_calibration) {
        ("code_preload", CodeSource::Tdc, ..) => Some("stimulus.codes"),
        ("histogram_preload", _, HistogramSource::Builder, _) => Some("stimulus.histogram"),
        ("tdc_calibration", _, _, None) => Some("tdc.recalibrate_frames"),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
