//! Meaning of the firmware's signals, for other sources with the same names.

use std::collections::HashMap;
use std::sync::LazyLock;

use tofsim::firmware::histogram_builder::{MOST_BINS, Params};
use tofsim::hierarchy;
use tofsim::kernel::signals::SignalFormat as Shape;

use super::names::Name;

/// Number of parts that two names of one signal must have in common.
const SHARED: usize = 2;

/// Names and shapes of the firmware's signals, in the order of the data flow.
static SHAPES: LazyLock<Vec<(Name, Shape)>> = LazyLock::new(|| {
    let most = Params { bins: MOST_BINS, ..Params::default() };
    let entries = hierarchy::every_entry().into_iter().chain(hierarchy::ram_entries(&most));
    entries.map(|entry| (Name::new(entry.path()), entry.signal.format)).collect()
});

/// Indices in [`SHAPES`] by the last part of the name.
static BY_LAST: LazyLock<HashMap<&str, Vec<usize>>> = LazyLock::new(|| {
    let mut by_last: HashMap<&str, Vec<usize>> = HashMap::new();
    for (place, (known, _)) in SHAPES.iter().enumerate() {
        by_last.entry(known.last()).or_default().push(place);
    }
    by_last
});

/// Returns the index in [`SHAPES`] of the first signal that has at least `enough` parts in common with a name.
fn place(name: &Name, enough: usize) -> Option<usize> {
    let places = BY_LAST.get(name.last())?;
    let is_one = |place: &usize| SHAPES[*place].0.common(name).is_some_and(|n| n >= enough);
    places.iter().copied().find(is_one)
}

/// Returns the shape of the firmware's first signal that has one of the names.
pub(crate) fn known_shape(names: &[&Name]) -> Option<Shape> {
    let first = names.iter().filter_map(|name| place(name, SHARED)).min()?;
    Some(SHAPES[first].1)
}

/// Returns the position of the firmware's signal in the data flow; unknown names come last.
pub(crate) fn flow(name: &Name) -> usize {
    place(name, SHARED.min(name.depth())).unwrap_or(SHAPES.len())
}
