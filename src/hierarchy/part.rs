//! Change detection for a subset of the signals.

use crate::firmware::histogram_builder::MOST_BINS;
use crate::firmware::tof_top::{Clocks, FirmwareEstimator, TofTop};
use crate::kernel::module::{Instance, Module, Visitor};
use crate::kernel::scan::MOST_COLUMNS;
use crate::kernel::signals::{Signals, Sink};

use super::channels::ChannelIds;
use super::entry::{IDS, RAM};

/// A subset of the signals, with their last reported values.
#[derive(Clone, Debug)]
pub struct Part {
    /// Whether each id belongs to the subset. A struct of signals is compared as a whole.
    wanted: Box<[bool; IDS]>,
    /// Whether a clock, which have the first ids, belongs to the subset.
    wants_clocks: bool,
    /// Number of ids to skip at the first id of a module that has none in the subset; the largest number where
    /// modules share a first id.
    unwanted: Box<[usize; IDS]>,
    /// The same while the estimators stand still.
    unwanted_if_still: Box<[usize; IDS]>,
    /// Whether the top counts the changes of its estimators.
    is_counted: bool,
    /// Other columns of an array with a signal in the subset. The array may have fewer.
    columns: Vec<usize>,
    /// RAM words in the subset, sorted and unique. The RAM may be smaller.
    words: Vec<usize>,
    /// Whether the next edge of `clk_sys` may write a RAM word.
    writes: bool,
    kept: Option<TofTop>,
}

impl Part {
    /// Creates a subset with the given ids, and with the signals that share a struct with them.
    pub fn of(ids: impl IntoIterator<Item = usize>) -> Self {
        let mut wanted = Box::new([false; IDS]);
        ids.into_iter().for_each(|id| wanted[id] = true);
        let words = (0..MOST_BINS).filter(|bin| wanted[RAM + bin]).collect();
        let mut unwanted = Unwanted {
            wanted: &wanted,
            counts: Box::new([0; IDS]),
            if_still: Box::new([0; IDS]),
            id: 0,
        };
        TofTop::default().visit(None, &mut unwanted);
        let Unwanted { counts: unwanted, if_still: unwanted_if_still, .. } = unwanted;
        let columns =
            (1..MOST_COLUMNS as usize).filter(|column| ChannelIds::of(*column).any(&wanted[..]));
        Part {
            columns: columns.collect(),
            wants_clocks: wanted[..<Clocks as Signals>::COUNT].contains(&true),
            wanted,
            unwanted,
            unwanted_if_still,
            is_counted: false,
            words,
            writes: true,
            kept: None,
        }
    }

    /// Compares an estimator only if the top has counted a change: for a top in which only its own edges change
    /// blocks.
    pub fn of_whole_edges(self) -> Self {
        Part { is_counted: true, ..self }
    }

    /// Reports every signal of the design as if it had changed.
    pub fn show(&mut self, top: &TofTop, sink: &mut impl Sink) {
        changes(top, None, sink);
        for &column in &self.columns {
            let look = &mut Look { wanted: None, between: false, id: 0, sink };
            follow_channel(column, top, None, look);
        }
        match &mut self.kept {
            Some(kept) => {
                copy(top, kept);
                kept.channels.clone_from(&top.channels);
            }
            None => self.kept = Some(top.clone()),
        }
        self.writes = true;
    }

    /// Reports every signal that has changed since the last call; the first call reports all. It must be called in
    /// every cycle of `clk_sys`, at least once while it is low: while it stays high, none of its registers changes.
    #[inline]
    pub fn follow(&mut self, top: &TofTop, sink: &mut impl Sink) {
        let Some(kept) = &mut self.kept else { return self.show(top, sink) };
        let between = kept.clocks.clk_sys;
        let still = self.is_counted && kept.estimator_changes == top.estimator_changes;
        let unwanted = if still { &self.unwanted_if_still } else { &self.unwanted };
        let wanted = Some((&*self.wanted, &**unwanted));
        if !top.channels.is_empty() {
            for &column in &self.columns {
                follow_channel(column, top, Some(kept), &mut Look { wanted, between, id: 0, sink });
            }
        }
        top.visit(Some(kept), &mut Look { wanted, between, id: 0, sink });
        kept.estimator_changes = top.estimator_changes;
        let writes = top.histogram_builder.has_hit() || top.frame_ctrl.clear;
        if std::mem::replace(&mut self.writes, writes) {
            let (now, then) = (&top.histogram_builder.ram, &mut kept.histogram_builder.ram);
            for &bin in self.words.iter().take_while(|bin| **bin < now.len()) {
                if then[bin] != now[bin] {
                    sink.word(RAM + bin, now[bin].get());
                    then[bin] = now[bin];
                }
            }
        }
    }

    /// Reports changes at an instant when only clock levels can change.
    #[inline(always)]
    pub fn tick(&mut self, top: &TofTop, sink: &mut impl Sink) {
        if let Some(kept) = &mut self.kept {
            if self.wants_clocks {
                top.clocks.changes(Some(&kept.clocks), 0, sink);
            }
            kept.clocks = top.clocks;
        }
    }
}

/// Reports every signal that differs from `before`, or every signal if there is none.
pub fn changes(top: &TofTop, before: Option<&TofTop>, sink: &mut impl Sink) {
    let mut then = before.cloned();
    top.visit(then.as_mut(), &mut Look { wanted: None, between: false, id: 0, sink });
    for (bin, now) in top.histogram_builder.ram.iter().enumerate() {
        if before.is_none_or(|before| before.histogram_builder.ram[bin] != *now) {
            sink.word(RAM + bin, now.get());
        }
    }
}

/// Reports the signals of a column from 1 on that differ from those before, or all. The pins before have to be those
/// of the same instant.
fn follow_channel<K: Sink>(
    column: usize,
    top: &TofTop,
    then: Option<&mut TofTop>,
    look: &mut Look<K>,
) {
    let (place, ids) = (column - 1, ChannelIds::of(column));
    let Some(now) = top.channels.get(place) else { return };
    let stop = |top: &TofTop| top.pins.column_stop.get() >> place & 1;
    if then.as_ref().is_none_or(|then| stop(then) != stop(top)) {
        look.sink.word(ids.stop, stop(top));
    }
    let (tdc, mut banks) = match then.map(|then| &mut then.channels[place]) {
        Some(then) => (Some(&mut then.tdc), Some(&mut then.banks)),
        None => (None, None),
    };
    look.id = ids.tdc();
    now.tdc.visit(tdc, look);
    for (bank, now) in now.banks.iter().enumerate() {
        look.id = ids.bank(bank);
        now.visit(banks.as_mut().map(|banks| &mut banks[bank]), look);
    }
}

/// Copies all state that [`changes`] compares, without allocating.
pub fn copy(from: &TofTop, to: &mut TofTop) {
    from.visit(Some(to), &mut Copy);
    to.estimator_changes = from.estimator_changes;
    to.histogram_builder.ram.copy_from_slice(&from.histogram_builder.ram[..]);
}

/// Visitor that reports changes and updates the copy.
struct Look<'a, S> {
    /// Ids in the subset, and ids to skip; `None` for all signals.
    wanted: Option<(&'a [bool; IDS], &'a [usize; IDS])>,
    /// Whether to skip modules whose only clock is `clk_sys`.
    between: bool,
    /// Id of the next signal.
    id: usize,
    sink: &'a mut S,
}

impl<K: Sink> Visitor for Look<'_, K> {
    #[inline(always)]
    fn signals<S: Signals>(&mut self, _: &'static str, now: &S, then: Option<&mut S>) {
        let ids = self.id..self.id + S::COUNT;
        self.id = ids.end;
        match then {
            None => report_all(now, ids.start, self.sink),
            Some(then) if then != now => {
                if self.wanted.is_none_or(|(wanted, _)| wanted[ids.clone()].contains(&true)) {
                    report_changes(now, then, ids.start, self.sink);
                }
                *then = *now;
            }
            Some(_) => {}
        }
    }

    #[inline(always)]
    fn module<M: Module>(&mut self, instance: &'static Instance, now: &M, then: Option<&mut M>) {
        match instance.clocks {
            [("clk_sys", _)] if self.between => self.id += M::COUNT,
            _ if self.wanted.is_some_and(|(_, counts)| counts[self.id] >= M::COUNT) => {
                self.id += M::COUNT;
            }
            _ => now.visit(then, self),
        }
    }
}

/// Reports all signals of a struct.
#[cold]
#[inline(never)]
fn report_all<S: Signals>(now: &S, id: usize, sink: &mut impl Sink) {
    now.changes(None, id, sink);
}

/// Reports the signals that differ from `before`.
#[inline(never)]
fn report_changes<S: Signals>(now: &S, before: &S, id: usize, sink: &mut impl Sink) {
    now.changes(Some(before), id, sink);
}

/// Visitor that finds modules without a signal in the subset, and in a second table the estimators too.
struct Unwanted<'a> {
    wanted: &'a [bool; IDS],
    counts: Box<[usize; IDS]>,
    if_still: Box<[usize; IDS]>,
    /// Id of the next signal.
    id: usize,
}

impl Visitor for Unwanted<'_> {
    fn signals<S: Signals>(&mut self, _: &'static str, _: &S, _: Option<&mut S>) {
        self.id += S::COUNT;
    }

    fn module<M: Module>(&mut self, instance: &'static Instance, now: &M, _: Option<&mut M>) {
        let ids = self.id..self.id + M::COUNT;
        let mut estimators = FirmwareEstimator::ALL.iter().map(|estimator| estimator.module());
        let is_wanted = self.wanted[ids.clone()].contains(&true);
        let is_moving = !estimators.any(|name| name == instance.name);
        for (counts, skips) in
            [(&mut self.counts, !is_wanted), (&mut self.if_still, !(is_wanted && is_moving))]
        {
            if skips {
                counts[ids.start] = counts[ids.start].max(M::COUNT);
            }
        }
        now.visit(None, self);
    }
}

/// Visitor that copies without reporting.
struct Copy;

impl Visitor for Copy {
    fn signals<S: Signals>(&mut self, _: &'static str, now: &S, then: Option<&mut S>) {
        if let Some(then) = then {
            *then = *now;
        }
    }

    fn module<M: Module>(&mut self, _: &'static Instance, now: &M, then: Option<&mut M>) {
        now.visit(then, self);
    }
}

#[cfg(test)]
mod tests;
