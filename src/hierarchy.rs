//! The signals of the firmware as a waveform shows them: scopes, names and drivers.
//!
//! The hierarchy is the Verilog's, and all of it comes from the modules themselves
//! ([`crate::kernel::module`]). A signal that a module stores or a wire carries has an id of its own;
//! a port that passes it on is an alias of the same id, found by the same connections that the
//! simulation uses.

use crate::firmware::histogram_builder::BINS;
use crate::firmware::tof_top::{Estimator, Params};
use crate::kernel::signals::{Signal, SignalFormat, View};

mod build;
mod entry;
mod part;

use build::Build;
use entry::RAM;
pub use entry::{Entry, IDS, Kind, TOP, below_top};
pub use part::{Part, changes, copy};

/// Every name in every scope that those parameters have, without the RAM's words.
pub fn entries(params: &Params) -> Vec<Entry> {
    let absent = params.left_out().map(|module| format!("{TOP}.{module}"));
    let neurons = params.depth_estimator.neurons();
    let mut entries = of_network(Build::entries(params.estimator), neurons);
    entries.retain(|entry| !absent.iter().any(|scope| within(&entry.scope, scope)));
    entries
}

/// Every name in every scope with so many neurons, without the RAM's words.
pub fn every_entry_of(neurons: usize) -> Vec<Entry> {
    of_network(every_entry(), neurons)
}

fn of_network(entries: Vec<Entry>, neurons: usize) -> Vec<Entry> {
    let fit = |entry: Entry| Some(Entry { signal: fitted(entry.signal, neurons)?, ..entry });
    entries.into_iter().filter_map(fit).collect()
}

/// A signal as an estimator with so many neurons has it: not at all past the last of them.
pub fn fitted(signal: Signal, neurons: usize) -> Option<Signal> {
    let is_there = |place: &str| place.parse::<usize>().is_ok_and(|neuron| neuron < neurons);
    match signal.name.rsplit_once('_') {
        Some(("fetched" | "weight" | "product" | "l1_in" | "entry" | "l1_out", place)) => {
            is_there(place).then_some(signal)
        }
        _ => Some(signal),
    }
}

/// Every name in every scope that there can be, in the order of the hierarchy, without the RAM's
/// words.
pub fn every_entry() -> Vec<Entry> {
    Build::entries(Estimator::default())
}

/// The words of the histogram's RAM, `histogram_builder.ram_0` to `ram_255`.
pub fn ram_entries() -> Vec<Entry> {
    let word = |bin| Entry {
        scope: format!("{TOP}.histogram_builder"),
        signal: Signal {
            name: format!("ram_{bin}"),
            width: 16,
            format: SignalFormat::Unsigned,
            output: false,
            view: View::NONE,
            doc: "Word of the histogram [hits].",
        },
        kind: Kind::Internal,
        id: RAM + bin,
    };
    (0..BINS).map(word).collect()
}

/// Whether a dotted path lies in another or is the same.
pub fn within(scope: &str, parent: &str) -> bool {
    scope.strip_prefix(parent).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}
