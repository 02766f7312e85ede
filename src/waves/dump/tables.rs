//! Numbers of the tables of states in a file.

use std::collections::HashMap;

use super::signal::{DumpKind, DumpSignal, DumpState};

/// Tables that a file has so far: signals of one width share the table of the states that they share.
#[derive(Default)]
pub(crate) struct Tables(HashMap<(*const DumpState, DumpKind), u64>);

impl Tables {
    /// Returns the number of a signal's table, from 1, and its text if it is new; `None` if the signal has no states.
    pub(crate) fn of(&mut self, signal: &DumpSignal) -> Option<(u64, Option<String>)> {
        if signal.states.is_empty() {
            return None;
        }
        let next = self.0.len() as u64 + 1;
        let number = *self.0.entry((signal.states.as_ptr(), signal.kind)).or_insert(next);
        Some((number, (number == next).then(|| signal.table(number))))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    #[test]
    fn a_table_is_shared_by_signals_of_one_width() {
        let states: Arc<[DumpState]> = Arc::new([("idle".to_owned(), 0), ("run".to_owned(), 1)]);
        let mut tables = Tables::default();
        let mut of = |width: u32, states: &Arc<[DumpState]>| {
            let (scopes, name, kind) = (Arc::default(), "s".to_owned(), DumpKind::Bits(width));
            let (states, description) = (Arc::clone(states), None);
            tables.of(&DumpSignal { scopes, name, range: None, kind, states, description, id: 0 })
        };
        assert_eq!(of(1, &states), Some((1, Some("states_1 2 idle run 0 1".to_owned()))));
        assert_eq!(of(1, &states), Some((1, None)));
        assert_eq!(of(2, &states), Some((2, Some("states_2 2 idle run 00 01".to_owned()))));
        assert_eq!(of(2, &Arc::default()), None);
    }
}
