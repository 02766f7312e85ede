//! Signals of a source by their names.

use std::collections::{HashMap, HashSet};

use super::names::Name;
use super::signals::{SignalKind, Source};

impl Source {
    /// Adds ranges to names that several signals would otherwise share: the source's, or else that of the bits.
    pub(super) fn distinguish(mut self) -> Self {
        let mut first: HashMap<&str, usize> = HashMap::new();
        let mut shared: HashSet<String> = HashSet::new();
        for signal in &self.signals {
            if *first.entry(&signal.name.text).or_insert(signal.id) != signal.id {
                shared.insert(signal.name.text.clone());
            }
        }
        for signal in self.signals.iter_mut().filter(|signal| shared.contains(&signal.name.text)) {
            let top = signal.lsb + i64::from(signal.width) - 1;
            let of_bits = (signal.kind == SignalKind::Bits).then_some([top, signal.lsb]);
            if let Some([high, low]) = signal.range.or(of_bits) {
                signal.name = Name::new(format!("{}[{high}:{low}]", signal.name.text));
            }
        }
        self
    }

    /// Returns the signals whose names end with the part `last`, regardless of their ranges, in ascending order.
    pub(crate) fn called(&self, last: &str) -> &[usize] {
        let by_last = self.by_last.get_or_init(|| {
            let mut by_last: HashMap<String, Vec<usize>> = HashMap::new();
            for (k, signal) in self.signals.iter().enumerate() {
                by_last.entry(bare(signal.name.last()).to_owned()).or_default().push(k);
            }
            by_last
        });
        by_last.get(bare(last)).map_or(&[], Vec::as_slice)
    }
}

/// Removes brackets at the end of a name.
fn bare(last: &str) -> &str {
    last.split('[').next().unwrap_or(last)
}
