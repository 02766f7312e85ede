//! Signals and times of a table.

use tofsim::waves::dump::{DumpValue, unit};

use crate::source::{Axis, Signal, SignalKind, Source};

use super::excerpt::Chosen;
use super::values;

/// Columns of a table with a row for each instant.
pub(super) struct Columns {
    /// A signal for each column, by its first name.
    pub(super) signals: Vec<Signal>,
    /// Unit of times; `None` for sample numbers.
    pub(super) unit: Option<&'static str>,
    /// Number of units in a unit of the source.
    factor: u64,
}

impl Columns {
    pub(super) fn new(chosen: &Chosen, source: &Source) -> Columns {
        let signals = chosen.firsts().into_iter().cloned().collect();
        let Axis::Time(tick) = source.axis else {
            return Columns { signals, unit: None, factor: 1 };
        };
        let (factor, unit) = unit(tick.decimal().0);
        Columns { signals, unit: Some(unit), factor }
    }

    /// Returns a time as a number of the unit.
    pub(super) fn time(&self, at: u64) -> u128 {
        u128::from(at) * u128::from(self.factor)
    }

    /// Formats a value of a column.
    pub(super) fn text(&self, column: usize, value: DumpValue<'_>) -> String {
        match value {
            DumpValue::Bits { value, unknown } => {
                values::text(&self.signals[column], value, unknown)
            }
            DumpValue::Real(real) => format!("{real:?}"),
            DumpValue::Text(text) => text.to_owned(),
            DumpValue::Event => "1".to_owned(),
        }
    }

    /// Returns the columns that have a value only at the instants at which they occur.
    pub(super) fn events(&self) -> Vec<usize> {
        let columns = self.signals.iter().enumerate();
        columns.filter(|(_, signal)| signal.kind == SignalKind::Event).map(|(k, _)| k).collect()
    }
}
