//! What the values of the firmware's signals mean, for other sources of the same names.

use std::sync::LazyLock;

use tofsim::hierarchy;
use tofsim::kernel::signals::SignalFormat as Shape;

use super::names::Name;

/// Parts of a name that two have to share to be of one signal.
const SHARED: usize = 2;

/// The firmware's signals and their shapes, in the order of data flow.
pub(crate) static SHAPES: LazyLock<Vec<(Name, Shape)>> = LazyLock::new(|| {
    let entries = hierarchy::every_entry().into_iter().chain(hierarchy::ram_entries());
    entries.map(|entry| (Name::new(entry.path()), entry.signal.format)).collect()
});

/// The shape of the firmware's first signal that has one of those names.
pub(crate) fn known_shape(names: &[&Name]) -> Option<Shape> {
    let is_one = |known: &Name| {
        names.iter().any(|name| known.common(name).is_some_and(|parts| parts >= SHARED))
    };
    SHAPES.iter().find(|(known, _)| is_one(known)).map(|(_, shape)| *shape)
}
