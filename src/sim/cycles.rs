//! Steps a run cycle by cycle, and reads signals by name.

use std::ops::ControlFlow;

use crate::error::{Input, Result, nearest};
use crate::firmware::tof_top::{Params, TofTop};
use crate::hierarchy::{self, Entry, IDS, Part, below_top};
use crate::kernel::signals::{SignalFormat, Sink};
use crate::kernel::{Thermometer, Time};

use super::device::{Device, Edge, SignalProbe};
use super::frames::Frames;
use super::run::{Outcome, Run};
use super::wave_tracer::WindowedProbe;

/// A cycle of `clk_sys`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    /// Number of the edge that it begins with, from 0 at power-up.
    pub number: u64,
    /// Instant of that edge.
    pub begin: Time,
}

impl Run<'_> {
    /// Simulates every cycle until `count` frames are done, and calls `each` at every edge of
    /// `clk_sys` with the values of `signals`, in that order, as the edge takes them: what the
    /// registers have held since the edge before. It may end the run there.
    ///
    /// A signal is named as in a waveform, `tof_top.tdc.tdc_decoder.tdc_code`; the top may be left out.
    /// Its value is the integer that the word holds, of a state its code, and of the taps of a delay line
    /// how many are high. A number with a binary point, as `depth`, is in units of its last bit.
    ///
    /// # Errors
    /// When a signal is unknown, the control signals keep a frame from ending, or `each` fails.
    pub fn step_cycles<const N: usize>(
        self,
        count: u64,
        signals: [&str; N],
        each: impl FnMut(Cycle, [i64; N]) -> Result<ControlFlow<()>>,
    ) -> Result<Outcome> {
        let entries = entries(&self.setup.params);
        let mut found = Vec::new();
        for name in signals {
            found.push(find(&entries, name)?);
        }
        let part = Part::of(found.iter().map(|entry| entry.id)).of_whole_edges();
        let shown = std::array::from_fn(|k| Shown::new(found[k]));
        let taps = self.setup.params.tdc.delays.taps();
        let values = Values::new(taps);
        let mut stepper = Stepper { shown, part, values, number: 0, each, end: None };
        let outcome = self.traced(count, &mut stepper, None)?;
        stepper.end.unwrap_or(Ok(()))?;
        Ok(outcome)
    }
}

/// Returns every signal, with the words of the RAM if there is one.
pub(super) fn entries(params: &Params) -> Vec<Entry> {
    let (mut entries, ram) =
        (hierarchy::entries(params), hierarchy::ram_entries(&params.histogram));
    if entries.iter().any(|entry| entry.scope == ram[0].scope) {
        entries.extend(ram);
    }
    entries
}

/// Finds a signal by its path, with or without the top.
pub(super) fn find<'a>(entries: &'a [Entry], name: &str) -> Result<&'a Entry> {
    let wanted = below_top(name);
    let paths: Vec<_> = entries.iter().map(Entry::below_top).collect();
    if let Some(place) = paths.iter().position(|path| path == wanted) {
        return Ok(&entries[place]);
    }
    let bare = wanted.rsplit('.').next().unwrap_or_default();
    let same_name = entries.iter().position(|entry| entry.signal.name == bare);
    let near = same_name.map(|place| &*paths[place]);
    let near = near.or_else(|| nearest(wanted, paths.iter().map(String::as_str)));
    let hint = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
    Err(Input::new("signal", format!("there is none of that name{hint}")).value(name).into())
}

/// Place and sign of a signal among [`Values`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Shown {
    pub(super) id: usize,
    /// Bits above the word if it is signed, or else 0.
    unused: u32,
}

impl Shown {
    pub(super) fn new(entry: &Entry) -> Self {
        let signal = &entry.signal;
        let is_signed = matches!(signal.format, SignalFormat::Signed { .. });
        Shown { id: entry.id, unused: if is_signed { 64 - signal.width } else { 0 } }
    }

    pub(super) fn value(self, values: &Values) -> i64 {
        (values.of_id[self.id] << self.unused) as i64 >> self.unused
    }
}

/// The values of all signals by id.
#[derive(Clone, Debug)]
pub(super) struct Values {
    of_id: Box<[u64; IDS]>,
    /// Length of the chain [taps].
    taps: usize,
}

impl Values {
    /// Zeros, for a chain of so many taps.
    pub(super) fn new(taps: usize) -> Self {
        Values { of_id: Box::new([0; IDS]), taps }
    }
}

impl Sink for Values {
    fn word(&mut self, id: usize, value: u64) {
        self.of_id[id] = value;
    }

    fn taps(&mut self, id: usize, value: &Thermometer, _: usize) {
        self.of_id[id] = value.ones(self.taps) as u64;
    }
}

/// Calls `each` with the values at each edge.
struct Stepper<F, const N: usize> {
    shown: [Shown; N],
    part: Part,
    values: Values,
    number: u64,
    each: F,
    /// Result with which `each` ended the run.
    end: Option<Result<()>>,
}

impl<F, const N: usize> SignalProbe for Stepper<F, N>
where
    F: FnMut(Cycle, [i64; N]) -> Result<ControlFlow<()>>,
{
    const ON: bool = false;
    const EDGES: bool = true;

    fn sample(&mut self, _: Time, _: &TofTop) {}

    fn looks_before(&self, edge: Edge) -> bool {
        edge == Edge::Both
    }

    fn before_edge(&mut self, _: Edge, now: Time, top: &TofTop) {
        self.part.follow(top, &mut self.values);
        let value = |shown: &Shown| shown.value(&self.values);
        let cycle = Cycle { number: self.number, begin: now };
        self.number += 1;
        self.end = match (self.each)(cycle, self.shown.each_ref().map(value)) {
            Ok(ControlFlow::Continue(())) => None,
            Ok(ControlFlow::Break(())) => Some(Ok(())),
            Err(error) => Some(Err(error)),
        };
    }
}

impl<F, const N: usize> WindowedProbe for Stepper<F, N>
where
    F: FnMut(Cycle, [i64; N]) -> Result<ControlFlow<()>>,
{
    fn is_wanted(&mut self, _: &mut Device, _: &Frames, _: &Params) -> Result<bool> {
        Ok(true)
    }

    fn is_done(&self) -> bool {
        self.end.is_some()
    }
}
