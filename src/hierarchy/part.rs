//! Change detection for a subset of the signals.

use crate::firmware::histogram_builder::MOST_BINS;
use crate::firmware::tof_top::TofTop;
use crate::kernel::module::{Instance, Module, Visitor};
use crate::kernel::signals::{Signals, Sink};

use super::entry::{IDS, RAM};

/// A subset of the signals, with their last reported values.
#[derive(Clone, Debug)]
pub struct Part {
    /// Whether each id belongs to the subset. A struct of signals is compared as a whole.
    wanted: Box<[bool; IDS]>,
    /// Number of ids to skip at the first id of a module that has none in the subset; the largest number where
    /// modules share a first id.
    unwanted: Box<[usize; IDS]>,
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
        let mut unwanted = Unwanted { wanted: &wanted, counts: Box::new([0; IDS]), id: 0 };
        TofTop::default().visit(None, &mut unwanted);
        let unwanted = unwanted.counts;
        Part { wanted, unwanted, words, writes: true, kept: None }
    }

    /// Reports every signal of the design as if it had changed.
    pub fn show(&mut self, top: &TofTop, sink: &mut impl Sink) {
        changes(top, None, sink);
        match &mut self.kept {
            Some(kept) => copy(top, kept),
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
        let wanted = Some((&*self.wanted, &*self.unwanted));
        top.visit(Some(kept), &mut Look { wanted, between, id: 0, sink });
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

    /// Reports changes at an instant when only clock levels, which have the first ids, can change.
    #[inline(always)]
    pub fn tick(&mut self, top: &TofTop, sink: &mut impl Sink) {
        if let Some(kept) = &mut self.kept {
            top.clocks.changes(Some(&kept.clocks), 0, sink);
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

/// Copies all state that [`changes`] compares, without allocating.
pub fn copy(from: &TofTop, to: &mut TofTop) {
    from.visit(Some(to), &mut Copy);
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
            None => now.changes(None, ids.start, self.sink),
            Some(then) if then != now => {
                if self.wanted.is_none_or(|(wanted, _)| wanted[ids.clone()].contains(&true)) {
                    now.changes(Some(&*then), ids.start, self.sink);
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

/// Visitor that finds modules without a signal in the subset.
struct Unwanted<'a> {
    wanted: &'a [bool; IDS],
    counts: Box<[usize; IDS]>,
    /// Id of the next signal.
    id: usize,
}

impl Visitor for Unwanted<'_> {
    fn signals<S: Signals>(&mut self, _: &'static str, _: &S, _: Option<&mut S>) {
        self.id += S::COUNT;
    }

    fn module<M: Module>(&mut self, _: &'static Instance, now: &M, _: Option<&mut M>) {
        let ids = self.id..self.id + M::COUNT;
        if !self.wanted[ids.clone()].contains(&true) {
            self.counts[ids.start] = self.counts[ids.start].max(M::COUNT);
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
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::firmware::carry_chain::TAPS;
    use crate::firmware::histogram_builder::BINS;
    use crate::kernel::{Thermometer, Time};
    use crate::scenario::{self, Control, QuenchMode};
    use crate::sim::device::{Edge, Off, SignalProbe};
    use crate::sim::setup::Setup;

    /// Latest value of each id; of taps, their number of ones.
    #[derive(Clone, PartialEq)]
    struct Values(Vec<u64>);

    impl Sink for Values {
        fn word(&mut self, id: usize, value: u64) {
            self.0[id] = value;
        }

        fn taps(&mut self, id: usize, value: &Thermometer, _: usize) {
            self.0[id] = value.ones(TAPS) as u64;
        }
    }

    /// Follows every signal through a [`Part`], and by comparing all of them.
    struct Both {
        part: Part,
        followed: Values,
        /// Whether to look at every change rather than only before edges.
        every_change: bool,
        /// Whether to look before the edges of `clk_laser` too.
        middle: bool,
        looks: usize,
        ticks: usize,
        resets: usize,
        estimations: usize,
    }

    impl Both {
        fn new(seed: u64) -> Self {
            Both {
                part: Part::of(0..IDS),
                followed: Values(vec![0; IDS]),
                every_change: seed % 3 == 2,
                middle: seed % 2 == 1,
                looks: 0,
                ticks: 0,
                resets: 0,
                estimations: 0,
            }
        }

        fn compare(&mut self, now: Time, top: &TofTop) {
            let mut every = Values(vec![0; IDS]);
            changes(top, None, &mut every);
            assert!(self.followed == every, "at {now}");
            self.looks += 1;
            self.resets += usize::from(top.nets.rst_dsp);
            self.estimations += usize::from(top.slot.algo_done);
        }
    }

    impl SignalProbe for Both {
        const ON: bool = true;
        const EDGES: bool = true;

        fn looks_before(&self, edge: Edge) -> bool {
            !self.every_change && (self.middle || edge == Edge::Both)
        }

        fn sample(&mut self, now: Time, top: &TofTop) {
            if self.every_change {
                self.part.follow(top, &mut self.followed);
                self.compare(now, top);
            }
        }

        fn tick(&mut self, now: Time, top: &TofTop) {
            if self.every_change {
                self.part.tick(top, &mut self.followed);
                self.compare(now, top);
                self.ticks += 1;
            }
        }

        fn before_edge(&mut self, _: Edge, now: Time, top: &TofTop) {
            self.part.follow(top, &mut self.followed);
            self.compare(now, top);
        }
    }

    /// Creates control changes at random times, on edges, and as pulses between two edges, which no look before an
    /// edge sees.
    fn control(setup: &Setup, cycles: u64, random: &mut ChaCha8Rng) -> Vec<Control> {
        let clk_sys = &setup.pll().clk_sys;
        let mut changes = Vec::new();
        let mut cycle = 10;
        while cycle < cycles {
            let edge = clk_sys.rise(cycle);
            let at = |ps: u64| (edge + Time::from_fs(1000 * ps)).seconds() * 1e6;
            let begin = if random.random_bool(0.5) { 0 } else { random.random_range(0..8000) };
            let end = random.random_range(begin..begin + 24_000);
            let mut pulse = [begin, end].map(|ps| Control { at_us: at(ps), ..Control::default() });
            match random.random_range(0..6) {
                0 => [pulse[0].rst, pulse[1].rst] = [Some(true), Some(false)],
                1 => [pulse[0].dsp_rst, pulse[1].dsp_rst] = [Some(true), Some(false)],
                2 => [pulse[0].dsp_en, pulse[1].dsp_en] = [Some(false), Some(true)],
                3 => {
                    [pulse[0].mode, pulse[1].mode] =
                        [Some(QuenchMode::FreeRunning), Some(QuenchMode::EachShot)]
                }
                4 => pulse[0].laser_freq = Some(random.random_range(0..4)),
                _ => pulse[1].laser_en = Some(random.random_bool(0.8)),
            }
            changes.extend(pulse);
            cycle += random.random_range(5..1500);
        }
        changes
    }

    #[test]
    fn no_change_is_missed() {
        for seed in 0..6 {
            let (mut random, cycles) = (ChaCha8Rng::seed_from_u64(seed), 30_000);
            let kind = if seed < 4 { "network" } else { "centroid" };
            let short =
                ["firmware.shots_per_frame=30".to_owned(), format!("estimator.kind={kind}")];
            let load = || scenario::load("bright", &short).unwrap();
            let (plain, mut loaded) = (Setup::new(load()).unwrap(), load());
            loaded.scenario.control = control(&plain, cycles, &mut random);
            let setup = Setup::new(loaded).unwrap();
            let (mut both, mut device) = (Both::new(seed), setup.device());
            device.power_up(&mut Off, &mut Off);
            // Begins amid a change now and then.
            for _ in 0..random.random_range(0..40) {
                device.step(&setup.params, &mut Off, &mut Off);
            }
            let edge = device.next_edge();
            device.resume_clocks(edge);
            both.part.show(&device.top, &mut both.followed);
            for _ in 0..cycles {
                device.step(&setup.params, &mut both, &mut Off);
            }
            assert!(both.looks >= 30_000 && both.resets > 5 && both.estimations > 5, "seed {seed}");
            assert!(both.ticks > 40_000 || !both.every_change, "seed {seed}");
        }
    }

    #[test]
    fn a_part_reports_nothing_of_what_it_leaves_out() {
        let setup = Setup::new(scenario::load("bright", &[]).unwrap()).unwrap();
        let mut device = setup.device();
        let (mut part, mut values) = (Part::of([RAM + 3]), Values(vec![7; RAM + BINS]));
        part.follow(&device.top, &mut values);
        assert!(!values.0.contains(&7), "at first it reports everything");
        values = Values(vec![7; RAM + BINS]);
        device.power_up(&mut Off, &mut Off);
        for _ in 0..2000 {
            part.follow(&device.top, &mut values);
            device.step(&setup.params, &mut Off, &mut Off);
        }
        assert!(values.0.iter().enumerate().all(|(id, &value)| value == 7 || id == RAM + 3));
    }
}
