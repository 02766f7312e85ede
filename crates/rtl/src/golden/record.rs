//! Steps a block and keeps what goes in and what comes out.

use tofsim::error::Result;
use tofsim::firmware::tof_top::{Pins, TofTop};
use tofsim::hierarchy::{self, Entry, IDS, Kind, fitted};
use tofsim::kernel::signals::{Signal, Signals};

use super::block::{Block, Setting, Spec};
use super::draw::Draw;
use super::table::{Column, Fill, Table};
use super::vectors::Vectors;

/// What a bench compares: columns of the expected lines, and for each sample of a cycle the columns
/// of each id.
pub(super) struct Watched {
    pub(super) columns: Vec<Column>,
    pub(super) places: Vec<Vec<Vec<usize>>>,
}

impl Watched {
    /// The outputs, registers and inner ports of a block, those that are not its outputs as far as
    /// `wanted`.
    pub(super) fn new(spec: &Spec, entries: &[Entry], wanted: impl Fn(&Entry) -> bool) -> Self {
        let samples = spec.timing.samples();
        let mut watched =
            Watched { columns: Vec::new(), places: vec![vec![Vec::new(); IDS]; samples] };
        for entry in entries.iter().filter(|entry| is_watched(spec, entry)) {
            let name = name_in(spec, entry);
            let internal = entry.kind != Kind::Output || name.contains('.');
            if internal && !wanted(entry) {
                continue;
            }
            let first = if spec.fast.contains(&name.as_str()) { 0 } else { samples - 1 };
            for sample in first..samples {
                watched.places[sample][entry.id].push(watched.columns.len());
                let (name, width) = (name.clone(), entry.signal.width as usize);
                watched.columns.push(Column { name, width, low: 0, sample, internal });
            }
        }
        watched
    }
}

/// Everything in the block but inputs, and clocks that are not its own outputs.
fn is_watched(spec: &Spec, entry: &Entry) -> bool {
    let is_port = entry.scope == spec.path() && entry.kind == Kind::Output;
    hierarchy::within(&entry.scope, &spec.path())
        && entry.kind != Kind::Input
        && (is_port || !entry.signal.name.starts_with("clk_"))
}

/// Path of a signal inside the block.
fn name_in(spec: &Spec, entry: &Entry) -> String {
    entry.path()[spec.path().len() + 1..].to_owned()
}

/// Columns of a stimulus line.
pub(super) fn inputs(signals: &[Signal]) -> Vec<Column> {
    let column = |signal: &Signal| Column {
        name: signal.name.clone(),
        width: signal.width as usize,
        low: 0,
        sample: 0,
        internal: false,
    };
    signals.iter().map(column).collect()
}

/// The vectors of a block that is stepped alone.
pub(super) fn record<B: Block>(
    spec: &'static Spec,
    setting: &Setting,
    mut block: B,
) -> Result<Vectors> {
    let neurons = setting.neurons();
    let entries = hierarchy::every_entry_of(neurons);
    let Watched { columns, places } = Watched::new(spec, &entries, |_| true);
    let mut expected = Table::new(columns);
    let signals: Vec<_> =
        B::Stimulus::list().into_iter().map(|signal| fitted(signal, neurons)).collect();
    let mut next = 0..;
    let column = |signal: &Option<Signal>| signal.iter().zip(&mut next).map(|(_, n)| n).collect();
    let own_places: Vec<Vec<usize>> = signals.iter().map(column).collect();
    let signals: Vec<_> = signals.into_iter().flatten().collect();
    let mut stimulus = Table::new(inputs(&signals));
    let order = setting.setup.params.tdc.delays.order();

    let mut draw = Draw::new(setting.seed, spec.stream());
    let mut top = TofTop::new(Pins::default());
    for cycle in 0..setting.cycles() {
        let i = block.stimulus(cycle, &top, &mut draw);
        let mut fill = Fill { table: &mut stimulus, places: &own_places, order };
        i.changes(None, 0, &mut fill);
        stimulus.push();
        let mut samples = places.iter();
        block.cycle(cycle, &i, &mut top, &mut |top| {
            if let Some(places) = samples.next() {
                let mut fill = Fill { table: &mut expected, places, order };
                hierarchy::changes(top, None, &mut fill);
            }
        });
        expected.push();
    }
    Ok(Vectors {
        spec,
        seed: setting.seed,
        source: setting.setup.name.clone(),
        neurons,
        parameters: block.parameters(),
        stimulus,
        expected,
        first_edge_ps: spec.timing.period_ps(),
        stops: block.stops().to_vec(),
        roms: block.roms(),
        coverage: block.coverage(),
    })
}
