//! The lines of a block's vectors as they come: its inputs, and the signals that a bench compares.

use tofsim::hierarchy::{self, Entry, IDS, Kind};
use tofsim::kernel::signals::{Signal, Signals};
use tofsim::waves::TapDigits;

use super::setting::Setting;
use super::spec::{Spec, Vectors};
use super::table::{Column, LineSink, Table};

/// Lines so far.
pub(super) struct Lines<'a> {
    spec: &'static Spec,
    setting: &'a Setting,
    stimulus: Table,
    /// Columns of each signal of the stimulus.
    inputs: Vec<Vec<usize>>,
    expected: Table,
    /// For each sample of a cycle, columns of each id.
    compared: Vec<Vec<Vec<usize>>>,
    /// The coming sample.
    pub(super) sample: usize,
    taps: TapDigits,
}

impl<'a> Lines<'a> {
    /// No lines yet of these inputs, and of the block's outputs, registers and inner ports among
    /// `entries`: those that are not its outputs as far as `wanted`.
    pub(super) fn new(
        spec: &'static Spec,
        setting: &'a Setting,
        inputs: Vec<Signal>,
        entries: &[Entry],
        wanted: impl Fn(&Entry) -> bool,
    ) -> Self {
        let (mut stimulus, mut places) = (Vec::new(), Vec::new());
        let sizes = setting.setup.params.sizes();
        let shared =
            |signal: Signal| if signal.is_shared(&sizes) { signal.fitted(&sizes) } else { None };
        for signal in inputs.into_iter().map(shared) {
            places.push(signal.iter().map(|_| stimulus.len()).collect());
            stimulus.extend(signal.map(|Signal { name, width, .. }| Column::new(name, width)));
        }
        let samples = spec.timing.samples();
        let (mut expected, mut compared) = (Vec::new(), vec![vec![Vec::new(); IDS]; samples]);
        for entry in entries.iter().filter(|entry| is_compared(spec, entry)) {
            let name = entry.path()[spec.path().len() + 1..].to_owned();
            let internal = entry.kind != Kind::Output || name.contains('.');
            if internal && !wanted(entry) {
                continue;
            }
            let first = if spec.fast.contains(&name.as_str()) { 0 } else { samples - 1 };
            for (sample, places) in compared.iter_mut().enumerate().skip(first) {
                places[entry.id].push(expected.len());
                let column = Column::new(name.clone(), entry.signal.width);
                expected.push(Column { sample, internal, ..column });
            }
        }
        let (stimulus, expected) = (Table::new(stimulus), Table::new(expected));
        let taps = TapDigits::new(&setting.setup.params.tdc.decoder.encoder);
        Lines { spec, setting, stimulus, inputs: places, expected, compared, sample: 0, taps }
    }

    /// The input of the cycle's line.
    pub(super) fn input(&mut self, i: &impl Signals) {
        let (table, places, taps) = (&mut self.stimulus, &self.inputs, &mut self.taps);
        i.changes(None, 0, &mut LineSink { table, places, taps });
    }

    /// Takes a sample, of which `show` reports the signals; the last one of a cycle ends the line.
    pub(super) fn sample(&mut self, show: impl FnOnce(&mut LineSink)) {
        let (table, places) = (&mut self.expected, &self.compared[self.sample]);
        show(&mut LineSink { table, places, taps: &mut self.taps });
        self.sample += 1;
        if self.sample == self.compared.len() {
            self.sample = 0;
            self.stimulus.push();
            self.expected.push();
        }
    }

    /// The lines with where they come from, and with the parameters that any block may have, without memories, stops and coverage.
    pub(super) fn vectors(self) -> Vectors {
        let Lines { spec, setting, stimulus, expected, .. } = self;
        Vectors {
            spec,
            seed: setting.seed,
            source: setting.setup.name.clone(),
            sizes: setting.setup.params.sizes(),
            parameters: spec.parameters(setting),
            stimulus,
            expected,
            pll: setting.setup.pll().clone(),
            first_edge: spec.timing.period(setting.setup.cycle()),
            stops: Vec::new(),
            column_stops: Vec::new(),
            bench_memory: None,
            settles: 0,
            coverage: Vec::new(),
        }
    }
}

/// Everything in the block but inputs, and clocks that are not its own outputs.
fn is_compared(spec: &Spec, entry: &Entry) -> bool {
    let is_port = entry.scope == spec.path() && entry.kind == Kind::Output;
    hierarchy::within(&entry.scope, &spec.path())
        && entry.kind != Kind::Input
        && (is_port || !entry.signal.name.starts_with("clk_"))
}
