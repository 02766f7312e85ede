//! The columns of a block's lines: its inputs, and the signals that a bench compares.

use tofsim::hierarchy::{self, Entry, IDS, Kind};
use tofsim::kernel::signals::Signal;

use super::spec::Spec;
use super::table::Column;

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

/// What a bench compares: columns of the expected lines, and for each sample of a cycle the columns
/// of each id.
pub(super) struct Compared {
    pub(super) columns: Vec<Column>,
    pub(super) places: Vec<Vec<Vec<usize>>>,
}

impl Compared {
    /// The outputs, registers and inner ports of a block, those that are not its outputs as far as
    /// `wanted`.
    pub(super) fn new(spec: &Spec, entries: &[Entry], wanted: impl Fn(&Entry) -> bool) -> Self {
        let samples = spec.timing.samples();
        let (mut columns, mut places) = (Vec::new(), vec![vec![Vec::new(); IDS]; samples]);
        for entry in entries.iter().filter(|entry| is_compared(spec, entry)) {
            let name = entry.path()[spec.path().len() + 1..].to_owned();
            let internal = entry.kind != Kind::Output || name.contains('.');
            if internal && !wanted(entry) {
                continue;
            }
            let first = if spec.fast.contains(&name.as_str()) { 0 } else { samples - 1 };
            for (sample, places) in places.iter_mut().enumerate().skip(first) {
                places[entry.id].push(columns.len());
                let (name, width) = (name.clone(), entry.signal.width as usize);
                columns.push(Column { name, width, low: 0, sample, internal });
            }
        }
        Compared { columns, places }
    }
}

/// Everything in the block but inputs, and clocks that are not its own outputs.
fn is_compared(spec: &Spec, entry: &Entry) -> bool {
    let is_port = entry.scope == spec.path() && entry.kind == Kind::Output;
    hierarchy::within(&entry.scope, &spec.path())
        && entry.kind != Kind::Input
        && (is_port || !entry.signal.name.starts_with("clk_"))
}
