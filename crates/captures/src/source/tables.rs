//! Names of the values of an enumeration in VCD and FST.

use std::collections::HashMap;
use std::sync::Arc;

use wellen::{Hierarchy, Var};

use tofsim::waves::dump::unescaped;

use crate::ila::read::NamedValue;

/// Tables by their names and first values, so that the signals of a type share one.
#[derive(Default)]
pub(super) struct Tables(HashMap<String, Vec<Arc<[NamedValue]>>>);

impl Tables {
    /// Returns the names of a variable's values, which are binary numbers; none if it has no table.
    pub(super) fn of(&mut self, var: &Var, hierarchy: &Hierarchy) -> Arc<[NamedValue]> {
        let Some((name, table)) = var.enum_type(hierarchy) else { return Arc::default() };
        let named = |(value, name): (&str, &str)| {
            let bits = u64::from_str_radix(value, 2).ok();
            NamedValue { name: unescaped(name).into_owned(), bits }
        };
        let known = self.0.entry(name.to_owned()).or_default();
        let is_it = |states: &&Arc<[NamedValue]>| {
            states.len() == table.len() && states.iter().zip(&table).all(|(a, b)| *a == named(*b))
        };
        if let Some(states) = known.iter().find(is_it) {
            return Arc::clone(states);
        }
        let states: Arc<[NamedValue]> = table.into_iter().map(named).collect();
        known.push(Arc::clone(&states));
        states
    }
}
