//! Follows some of the signals, so that the others cost nothing.
//!
//! Who looks before every edge of `clk_125` can let modules sleep that next to no edge changes.
//! The synchronisers and the PLL change within two edges of their pins, and who makes the pins
//! change says so. The estimator changes at every edge while it works; an edge that leaves it as
//! it is leaves it so until it is started or reset. The RAM changes where it is written.

use crate::firmware::histogram_builder::BINS;
use crate::firmware::tof_top::TofTop;
use crate::kernel::signals::Sink;

use super::instants::Instant;
use super::{RAM, changes, copy, follow, groups};

/// How long a module is looked at after it has been woken or has changed: at two looks a cycle,
/// more than the two edges that a change takes through a synchroniser [looks].
const AWAKE: u32 = 8;

/// Some of the groups of signals and some words of the RAM, and what they were.
#[derive(Clone, Debug)]
pub struct Part {
    /// A bit for each group.
    pub(super) groups: u32,
    /// Words of the RAM, each once.
    words: Vec<usize>,
    /// Whether modules may sleep.
    sleeps: bool,
    control: Sleeper,
    estimator: Sleeper,
    /// The coming edge may write a word of the RAM.
    writes: bool,
    pub(super) kept: Option<TofTop>,
}

/// Groups that need not be looked at most of the time.
#[derive(Clone, Debug)]
struct Sleeper {
    /// A bit for each group.
    groups: u32,
    /// Looks until it falls asleep.
    awake: u32,
}

impl Sleeper {
    /// The groups of those scopes.
    fn of(scopes: &[&str]) -> Self {
        let bits = groups().into_iter().enumerate().map(|(group, (scope, ..))| {
            let module = scope.split('.').next().unwrap_or_default();
            u32::from(scopes.contains(&module)) << group
        });
        Sleeper { groups: bits.sum(), awake: AWAKE }
    }

    /// Its groups if it sleeps; each call is a look.
    #[inline]
    fn asleep(&mut self) -> u32 {
        let asleep = if self.awake == 0 { self.groups } else { 0 };
        self.awake = self.awake.saturating_sub(1);
        asleep
    }
}

impl Part {
    /// The part with the values of those ids. If modules sleep in it, it has to be brought up to
    /// date before every edge of `clk_125`, once or twice a cycle, and to be told what
    /// [`Part::control_changes`] has to know.
    pub fn of(ids: impl IntoIterator<Item = usize>, sleeps: bool) -> Self {
        let ends: Vec<usize> = groups()
            .iter()
            .scan(0, |end, (.., signals)| {
                *end += signals.len();
                Some(*end)
            })
            .collect();
        let mut part = Part {
            groups: 0,
            words: Vec::new(),
            sleeps,
            control: Sleeper::of(&["pll", "reset_sync_125", "reset_sync_250", "control_sync"]),
            estimator: Sleeper::of(&["depth_estimator", "centroid_estimator"]),
            writes: true,
            kept: None,
        };
        for id in ids {
            match ends.iter().position(|&end| id < end) {
                Some(group) => part.groups |= 1 << group,
                None => part.words.push(id - RAM),
            }
        }
        part.words.sort_unstable();
        part.words.dedup();
        part
    }

    /// A pin that the synchronisers take changes before the next edge, or at it.
    pub fn control_changes(&mut self) {
        self.control.awake = AWAKE;
    }

    /// Reports every signal, as if for the first time.
    pub fn show(&mut self, top: &TofTop, sink: &mut impl Sink) {
        changes(top, None, sink);
        match &mut self.kept {
            Some(kept) => copy(top, kept),
            None => self.kept = Some(top.clone()),
        }
        (self.control.awake, self.estimator.awake, self.writes) = (AWAKE, AWAKE, true);
    }

    /// Reports every signal that differs from what it was; at first, every one.
    #[inline]
    pub fn follow(&mut self, top: &TofTop, sink: &mut impl Sink) {
        let Some(kept) = &mut self.kept else { return self.show(top, sink) };
        let (mut groups, mut works, mut written) = (self.groups, false, true);
        if self.sleeps {
            let asleep = self.estimator.asleep();
            let (network, centroid) = (&top.depth_estimator, &top.centroid_estimator.registers);
            works = asleep == 0
                && (kept.depth_estimator != *network
                    || kept.centroid_estimator.registers != *centroid);
            if works || top.frame_ctrl.algo_start || top.nets.rst_dsp {
                self.estimator.awake = AWAKE;
            }
            groups &= !(asleep | self.control.asleep());
            written =
                std::mem::replace(&mut self.writes, top.nets.tdc_valid || top.frame_ctrl.clear);
        }
        follow::<{ Instant::Rise125 as u8 }>(top, groups, kept, sink);
        if works {
            kept.depth_estimator = top.depth_estimator;
            kept.centroid_estimator.registers = top.centroid_estimator.registers;
        }
        if written {
            let (now, then) = (&top.histogram_builder.ram, &mut kept.histogram_builder.ram);
            for &bin in &self.words {
                if then[bin] != now[bin] {
                    sink.word(RAM + bin, now[bin].get());
                    then[bin] = now[bin];
                }
            }
        }
    }
}

/// Reports every word of the RAM that differs from `before`, or every one.
pub(super) fn ram_changes(top: &TofTop, before: Option<&TofTop>, sink: &mut impl Sink) {
    let now = &top.histogram_builder.ram;
    let then = before.map(|b| &b.histogram_builder.ram);
    if then != Some(now) {
        for bin in 0..BINS {
            if then.is_none_or(|then| then[bin] != now[bin]) {
                sink.word(RAM + bin, now[bin].get());
            }
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::hierarchy::IDS;
    use crate::kernel::{Thermometer, Time};
    use crate::scenario::{self, Control};
    use crate::sim::device::{Edge, Off, SignalProbe};
    use crate::sim::setup::Setup;

    /// The value of each id; of taps their number.
    #[derive(Clone, PartialEq)]
    pub(in crate::hierarchy) struct Values(pub Vec<u64>);

    impl Sink for Values {
        fn word(&mut self, id: usize, value: u64) {
            self.0[id] = value;
        }

        fn taps<const N: usize>(&mut self, id: usize, value: &Thermometer<N>) {
            self.0[id] = value.ones() as u64;
        }
    }

    /// Follows a part of every signal with modules asleep, and looks at all of them beside it.
    struct Both {
        part: Part,
        followed: Values,
        middle: bool,
        looks: usize,
        resets: usize,
        estimations: usize,
    }

    impl SignalProbe for Both {
        const ON: bool = false;
        const EDGES: bool = true;

        fn looks_before(&self, edge: Edge) -> bool {
            self.middle || edge == Edge::Both
        }

        fn sample(&mut self, _: Time, _: &TofTop) {}

        fn before_edge(&mut self, _: Edge, now: Time, top: &TofTop) {
            self.part.follow(top, &mut self.followed);
            let mut every = Values(vec![0; IDS]);
            changes(top, None, &mut every);
            assert!(self.followed == every, "at {now}");
            self.looks += 1;
            self.resets += usize::from(top.nets.rst_dsp);
            self.estimations += usize::from(top.socket.algo_done);
        }

        fn control_changes(&mut self) {
            self.part.control_changes();
        }
    }

    /// Changes of the control signals at any time, at an edge, and as pulses from an edge to before
    /// the next, which no look before an edge sees.
    pub(in crate::hierarchy) fn control(
        setup: &Setup,
        cycles: u64,
        random: &mut ChaCha8Rng,
    ) -> Vec<Control> {
        let clk_125 = &setup.pll().clk_125;
        let mut changes = Vec::new();
        let mut cycle = 10;
        while cycle < cycles {
            let edge = clk_125.rise(cycle);
            let at = |ps: u64| (edge + Time::from_fs(1000 * ps)).seconds() * 1e6;
            let begin = if random.random_bool(0.5) { 0 } else { random.random_range(0..8000) };
            let end = random.random_range(begin..begin + 24_000);
            let mut pulse = [begin, end].map(|ps| Control { at_us: at(ps), ..Control::default() });
            match random.random_range(0..6) {
                0 => [pulse[0].rst, pulse[1].rst] = [Some(true), Some(false)],
                1 => [pulse[0].dsp_rst, pulse[1].dsp_rst] = [Some(true), Some(false)],
                2 => [pulse[0].dsp_en, pulse[1].dsp_en] = [Some(false), Some(true)],
                3 => [pulse[0].mode, pulse[1].mode] = [Some(1), Some(0)],
                4 => pulse[0].laser_freq = Some(random.random_range(0..4)),
                _ => pulse[1].laser_en = Some(random.random_bool(0.8)),
            }
            changes.extend(pulse);
            cycle += random.random_range(5..1500);
        }
        changes
    }

    #[test]
    fn a_module_that_sleeps_misses_no_change() {
        for seed in 0..6 {
            let (mut random, cycles) = (ChaCha8Rng::seed_from_u64(seed), 30_000);
            let kind = if seed < 4 { "network" } else { "centroid" };
            let short =
                ["firmware.shots_per_frame=30".to_owned(), format!("estimator.kind={kind}")];
            let load = || scenario::load("bright", &short).unwrap();
            let mut loaded = load();
            let plain = Setup::new(load()).unwrap();
            loaded.scenario.control = control(&plain, cycles, &mut random);
            let setup = Setup::new(loaded).unwrap();
            let mut both = Both {
                part: Part::of(0..IDS, true),
                followed: Values(vec![0; IDS]),
                middle: seed % 2 == 1,
                looks: 0,
                resets: 0,
                estimations: 0,
            };
            let mut device = setup.device();
            device.power_up(&mut Off, &mut Off);
            // Begins amid a change now and then.
            for _ in 0..random.random_range(0..40) {
                device.step(&setup.params, &mut Off, &mut Off);
            }
            for _ in 0..cycles {
                device.step(&setup.params, &mut both, &mut Off);
            }
            assert!(both.looks >= 30_000 && both.resets > 5 && both.estimations > 5, "seed {seed}");
        }
    }

    #[test]
    fn a_part_reports_nothing_of_what_it_leaves_out() {
        let setup = Setup::new(scenario::load("bright", &[]).unwrap()).unwrap();
        let mut device = setup.device();
        let (mut part, mut values) = (Part::of([RAM + 3], true), Values(vec![7; IDS]));
        part.follow(&device.top, &mut values);
        assert!(!values.0.contains(&7), "at first it reports everything");
        values = Values(vec![7; IDS]);
        device.power_up(&mut Off, &mut Off);
        for _ in 0..2000 {
            part.follow(&device.top, &mut values);
            device.step(&setup.params, &mut Off, &mut Off);
        }
        assert!(values.0.iter().enumerate().all(|(id, &value)| value == 7 || id == RAM + 3));
    }
}
