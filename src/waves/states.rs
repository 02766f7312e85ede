//! Tables of state names of a waveform's signals.

use crate::hierarchy::Entry;
use crate::kernel::signals::{Signal, SignalFormat};

/// Sets of states, numbered from 1 in the order in which the signals come.
pub(super) struct StateTables(Vec<StateTable>);

/// A set of states.
struct StateTable {
    name: String,
    states: &'static [&'static str],
    /// Width of their codes [bits].
    width: usize,
}

impl StateTables {
    /// Lists the distinct sets of states of `entries`.
    pub(super) fn of(entries: &[Entry]) -> Self {
        let mut tables = StateTables(Vec::new());
        for Entry { scope, signal, .. } in entries {
            if let SignalFormat::State(states) = signal.format
                && tables.number(signal).is_none()
            {
                let module = scope.rsplit('.').next().unwrap_or(scope);
                let name = format!("{module}_{}", signal.name);
                tables.0.push(StateTable { name, states, width: signal.width as usize });
            }
        }
        tables
    }

    /// Returns the number of a signal's table, if the signal is a state.
    pub(super) fn number(&self, signal: &Signal) -> Option<u64> {
        let SignalFormat::State(states) = signal.format else { return None };
        let place = self.0.iter().position(|table| table.states == states)?;
        Some(place as u64 + 1)
    }

    /// Formats each table, with its number: its name, the number of states, their names, and their codes in binary.
    pub(super) fn texts(&self) -> impl Iterator<Item = (u64, String)> {
        (1..).zip(&self.0).map(|(number, StateTable { name, states, width })| {
            let codes: Vec<_> = (0..states.len()).map(|code| format!("{code:0width$b}")).collect();
            let (count, labels, codes) = (states.len(), states.join(" "), codes.join(" "));
            (number, format!("{name} {count} {labels} {codes}"))
        })
    }
}
