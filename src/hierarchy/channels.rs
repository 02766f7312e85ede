//! Signals of the other columns of an array: the scopes `channel_1` to that of the last column.
//!
//! A channel has the output of its column's SPAD, a converter and a histogram for each bank. Each of those has the signals
//! that it has in the first column, with ids of the channel's own.

use std::ops::Range;

use crate::firmware::histogram_builder::HistogramBuilder;
use crate::firmware::tdc::Tdc;
use crate::firmware::tof_top::{Params, TofTop};
use crate::kernel::module::{Instance, Module, Visitor};
use crate::kernel::signals::{Signal, SignalFormat, Signals, View};

use super::entry::{CHANNELS, Entry, IN_CHANNEL, Kind, TOP, within};

/// Name of a channel's scope, before the number of its column.
pub const CHANNEL: &str = "channel_";

/// Ids of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ChannelIds {
    /// Output of the SPAD, which is the first.
    pub(super) stop: usize,
}

impl ChannelIds {
    /// Returns those of a column from 1 on.
    pub(super) fn of(column: usize) -> Self {
        ChannelIds { stop: CHANNELS + (column - 1) * IN_CHANNEL }
    }

    /// First of the converter.
    pub(super) fn tdc(self) -> usize {
        self.stop + 1
    }

    /// First of a histogram.
    pub(super) fn bank(self, bank: usize) -> usize {
        self.tdc() + Tdc::COUNT + bank * HistogramBuilder::COUNT
    }

    /// Returns whether one of them is in a subset.
    pub(super) fn any(self, wanted: &[bool]) -> bool {
        wanted[self.stop..][..IN_CHANNEL].contains(&true)
    }
}

/// Lists every name of the channels, given those of the first column.
pub(super) fn channel_entries(params: &Params, first: &[Entry]) -> Vec<Entry> {
    let scan = &params.frame_ctrl.scan;
    if scan.columns == 1 {
        return Vec::new();
    }
    let modules = ["tdc", "histogram_builder"].map(first_id);
    let columns = 1..scan.columns as usize;
    columns.flat_map(|column| one(column, scan.banks as usize, first, modules)).collect()
}

/// Lists every name of a channel, given those of the first column and the first ids of its converter and histogram.
fn one(column: usize, banks: usize, first: &[Entry], [tdc, histogram]: [usize; 2]) -> Vec<Entry> {
    let (scope, ids) = (format!("{TOP}.{CHANNEL}{column}"), ChannelIds::of(column));
    let of_tdc = |id| moved(id, tdc..tdc + Tdc::COUNT, ids.tdc());
    let find = |path: &str| first.iter().find(|entry| entry.below_top() == path);
    // What reaches the first column alone, and what reaches this one in its place.
    let own = ["tdc_valid", "tdc_code"].map(|name| {
        let decoded = find(&format!("tdc.tdc_decoder.{name}"));
        (find(name), decoded, decoded.and_then(|entry| of_tdc(entry.id)))
    });
    let shared = |id: usize| {
        let is_it = |entry: &Option<&Entry>| entry.is_some_and(|entry| entry.id == id);
        if is_it(&find("tdc_stop")) {
            return ids.stop;
        }
        let sources = own.iter().filter(|(of_first, ..)| is_it(of_first));
        sources.filter_map(|(.., own)| *own).next().unwrap_or(id)
    };
    let wire = |name: &str, heading, signal: Signal, id| Entry {
        scope: scope.clone(),
        signal: Signal {
            name: name.to_owned(),
            output: false,
            view: View { heading, ..View::NONE },
            ..signal
        },
        kind: Kind::Internal,
        id,
    };
    let doc = "Output of the selected row's SPAD in this column, asynchronous.";
    let stop = Signal::plain(String::new(), 1, SignalFormat::Bits, doc);
    let mut entries = vec![wire("tdc_stop", "SPAD", stop, ids.stop)];
    for (name, (_, decoded, id)) in ["code_valid", "code"].into_iter().zip(&own) {
        entries.extend(
            decoded.zip(*id).map(|(entry, id)| wire(name, "TDC", entry.signal.clone(), id)),
        );
    }
    let mut copy = |module: &str, name: String, of_own: &dyn Fn(usize) -> Option<usize>| {
        let (module, name) = (format!("{TOP}.{module}"), format!("{scope}.{name}"));
        let entries_of = first.iter().filter(|entry| within(&entry.scope, &module));
        entries.extend(entries_of.map(|entry| Entry {
            scope: entry.scope.replacen(&module, &name, 1),
            id: of_own(entry.id).unwrap_or(shared(entry.id)),
            ..entry.clone()
        }));
    };
    copy("tdc", "tdc".to_owned(), &of_tdc);
    for bank in 0..banks {
        let words = histogram..histogram + HistogramBuilder::COUNT;
        copy("histogram_builder", format!("bank_{bank}"), &|id| {
            moved(id, words.clone(), ids.bank(bank))
        });
    }
    entries
}

/// Returns the id of a signal whose module has its ids elsewhere, if it is one of the module.
fn moved(id: usize, from: Range<usize>, to: usize) -> Option<usize> {
    from.contains(&id).then(|| to + id - from.start)
}

/// Returns the first id of a module of the top.
fn first_id(name: &'static str) -> usize {
    let mut find = Find { name, id: 0, found: 0 };
    TofTop::default().visit(None, &mut find);
    find.found
}

/// Visitor that looks for a module of the top.
struct Find {
    name: &'static str,
    /// Id of the next signal.
    id: usize,
    found: usize,
}

impl Visitor for Find {
    fn signals<S: Signals>(&mut self, _: &'static str, _: &S, _: Option<&mut S>) {
        self.id += S::COUNT;
    }

    fn module<M: Module>(&mut self, instance: &'static Instance, _: &M, _: Option<&mut M>) {
        if instance.name == self.name {
            self.found = self.id;
        }
        self.id += M::COUNT;
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use crate::hierarchy::{column_entries, entries};
    use crate::kernel::scan::Scan;
    use crate::sim::setup::Setup;

    use super::*;

    fn array(columns: u32, banks: u32) -> Params {
        let mut params = Setup::load("kc705", &[]).unwrap().params;
        params.frame_ctrl.scan = Scan { rows: 2, columns, banks };
        params
    }

    #[test]
    fn a_channel_has_the_names_of_the_first_column() {
        let params = array(3, 2);
        let (first, all) = (entries(&params), column_entries(&params));
        let names = |entries: &[Entry], scope: &str| -> Vec<_> {
            let inside = entries.iter().filter(|entry| within(&entry.scope, scope));
            inside.map(|entry| entry.path().split_off(scope.len())).collect()
        };
        for column in ["tof_top.channel_1", "tof_top.channel_2"] {
            for (own, module) in
                [("tdc", "tdc"), ("bank_0", "histogram_builder"), ("bank_1", "second_bank")]
            {
                let own = names(&all, &format!("{column}.{own}"));
                assert_eq!(own, names(&first, &format!("tof_top.{module}")), "{column}");
            }
        }
        assert!(column_entries(&array(1, 2)).is_empty());
        assert!(names(&column_entries(&array(3, 1)), "tof_top.channel_1.bank_1").is_empty());
    }

    #[test]
    fn what_a_column_holds_is_its_own_and_what_it_shares_is_not() {
        let params = array(64, 2);
        let (first, all) = (entries(&params), column_entries(&params));
        let ids = |entries: &[Entry]| entries.iter().map(|entry| entry.id).collect::<BTreeSet<_>>();
        let of_first = ids(&first);
        let id = |path: &str| all.iter().find(|entry| entry.path() == path).unwrap().id;
        for column in [1, 63] {
            let scope = format!("tof_top.channel_{column}");
            let own: BTreeSet<_> = ids(&all).difference(&of_first).copied().collect();
            assert_eq!(
                own.range(ChannelIds::of(column).stop..).next(),
                Some(&id(&format!("{scope}.tdc_stop")))
            );
            assert_eq!(id(&format!("{scope}.tdc.tdc_stop")), id(&format!("{scope}.tdc_stop")));
            let code = id(&format!("{scope}.tdc.tdc_decoder.tdc_code"));
            assert_eq!(id(&format!("{scope}.bank_1.tdc_code")), code);
            assert_eq!(id(&format!("{scope}.code")), code);
            assert!(of_first.contains(&id(&format!("{scope}.bank_0.read_addr"))));
            assert!(of_first.contains(&id(&format!("{scope}.tdc.start"))));
        }
        let held = all.iter().filter(|entry| !of_first.contains(&entry.id));
        let mut seen: Vec<_> =
            held.map(|entry| (entry.id, entry.scope.split('.').nth(1))).collect();
        seen.sort_unstable();
        seen.dedup();
        assert!(seen.windows(2).all(|pair| pair[0].0 != pair[1].0), "an id of two channels");
    }
}
