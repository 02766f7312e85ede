//! The signals of the firmware as a waveform shows them: scopes, names and drivers.
//!
//! The hierarchy equals that of the Verilog, and is derived from the modules themselves ([`crate::kernel::module`]).
//! A signal that a module stores or a wire carries has its own id; a port that passes it on is an alias with the same
//! id, found through the connections that the simulation uses.

use crate::firmware::histogram_builder;
use crate::firmware::tof_top::{FirmwareEstimator, Params};
use crate::kernel::signals::{Signal, SignalFormat};
use crate::kernel::sizes::{Size, Sizes};

mod build;
mod channels;
mod entry;
mod part;
mod sources;

use build::Build;
pub use channels::CHANNEL;
use channels::channel_entries;
pub use entry::{Entry, IDS, Kind, ROW, TOP, below_top, within};
use entry::{MOST_OUTPUTS, RAM};
pub use part::{Part, changes, copy};
pub use sources::{ModulePlaces, ScopePlace};

/// Lists every name in every scope of a design with these parameters, without the RAM's words and the other columns of
/// an array.
pub fn entries(params: &Params) -> Vec<Entry> {
    let absent: Vec<_> =
        params.left_out().into_iter().map(|module| format!("{TOP}.{module}")).collect();
    let sizes = params.sizes();
    let mut entries = fitted(Build::entries(params.estimator), &sizes);
    entries.retain(|entry| !absent.iter().any(|scope| within(&entry.scope, scope)));
    if sizes.of(Size::Scanned) > 0 {
        // What a histogram of several shows is in the word that all of them show, and nowhere else.
        let builders = ["histogram_builder", "second_bank"].map(|name| format!("{TOP}.{name}"));
        let is_own =
            |entry: &Entry| entry.signal.name == "count" && builders.contains(&entry.scope);
        entries.retain(|entry| !is_own(entry));
    }
    let scale = params.tdc.decoder.scale;
    for Entry { signal, .. } in &mut entries {
        signal.unit = signal.unit.in_design(scale.bin(), scale.digits());
    }
    entries
}

/// Lists every name of the other columns of an array, without the words of their RAM.
pub fn column_entries(params: &Params) -> Vec<Entry> {
    channel_entries(params, &entries(params))
}

/// Lists every name in every scope of a design of these sizes, without the RAM's words.
pub fn every_entry_of(sizes: &Sizes) -> Vec<Entry> {
    fitted(every_entry(), sizes)
}

fn fitted(entries: Vec<Entry>, sizes: &Sizes) -> Vec<Entry> {
    // Those that read what nobody reads in such a design.
    let reads = |entry: &Entry| {
        let is_source = |other: &Entry| {
            other.id == entry.id
                && other.kind == Kind::Output
                && other.scope.len() > entry.scope.len()
        };
        entries.iter().any(|other| is_source(other) && within(&other.scope, &entry.scope))
    };
    let fit = |entry: &Entry| {
        let kind = match entry.kind {
            kind if entry.signal.is_shared(sizes) => kind,
            // Its registers stay what they are, and nobody reads them.
            _ if is_optional(entry.signal.only_if) => return None,
            Kind::Output if !reads(entry) => Kind::Internal,
            _ => return None,
        };
        Some(Entry { signal: entry.signal.clone().fitted(sizes)?, kind, ..entry.clone() })
    };
    entries.iter().filter_map(fit).collect()
}

/// Returns whether a signal vanishes from a design that does not have it, and is not kept as a register.
fn is_optional(only_if: Option<Size>) -> bool {
    use Size::{Glass, HasSecond, MoreLight, Scanned};
    matches!(only_if, Some(Scanned | Glass | HasSecond | MoreLight))
}

/// Lists every name in every scope of the largest possible design, in hierarchical order, without the RAM's words.
pub fn every_entry() -> Vec<Entry> {
    Build::entries(FirmwareEstimator::default())
}

/// Lists the words of the histogram RAM, from `histogram_builder.ram_0` to that of the last bin.
pub fn ram_entries(size: &histogram_builder::Params) -> Vec<Entry> {
    let word = |bin| Entry {
        scope: format!("{TOP}.histogram_builder"),
        signal: Signal::plain(
            format!("ram_{bin}"),
            size.count_bits,
            SignalFormat::Unsigned,
            "Word of the histogram [hits].",
        ),
        kind: Kind::Internal,
        id: RAM + bin,
    };
    (0..size.bins).map(word).collect()
}

/// Lists the outputs of the SPAD row, `spad_row.spad_out_0` to that of the last output. The row is not a module of
/// the firmware.
pub fn row_entries(outputs: usize) -> Vec<Entry> {
    let output = |place| Entry {
        scope: "spad_row".to_owned(),
        signal: Signal {
            output: true,
            ..Signal::plain(
                format!("spad_out_{place}"),
                1,
                SignalFormat::Bits,
                "Output of a SPAD of the selected row, before the OR and the monostable.",
            )
        },
        kind: Kind::Output,
        id: ROW + place,
    };
    (0..outputs.min(MOST_OUTPUTS)).map(output).collect()
}
