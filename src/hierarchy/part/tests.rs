use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::firmware::carry_chain::TAPS;
use crate::firmware::histogram_builder::BINS;
use crate::firmware::tof_top::Params;
use crate::firmware::tof_top::slot::SlotEstimator;
use crate::firmware::tof_top::slotted::Slotted;
use crate::in_slot;
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
            part: Part::of(0..IDS).of_whole_edges(),
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
fn control(setup: &Setup, cycles: u64, gap: u64, random: &mut ChaCha8Rng) -> Vec<Control> {
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
        cycle += random.random_range(5..gap);
    }
    changes
}

/// Returns whether the next edge leaves out the estimator; `None` if it would change.
fn rests_rightly(top: &TofTop, p: &Params) -> Option<bool> {
    in_slot!(p.estimator, E => {
        let ports = E::ports(top);
        let rests = top.rest.as_ref().is_some_and(|rest| *E::wires(rest) == ports);
        (!rests || E::block(top).rests(&ports, E::params(p))).then_some(rests)
    })
}

#[test]
fn no_change_is_missed() {
    for seed in 0..9 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        // An estimation by likelihood needs 3,779 cycles without a reset.
        let (kind, cycles, gap) =
            [("network", 30_000, 1500), ("centroid", 30_000, 1500), ("likelihood", 90_000, 8000)]
                [seed as usize / 3];
        let short = ["firmware.shots_per_frame=30".to_owned(), format!("estimator.kind={kind}")];
        let load = || scenario::load("bright", &short).unwrap();
        let (plain, mut loaded) = (Setup::new(load()).unwrap(), load());
        loaded.scenario.control = control(&plain, cycles, gap, &mut random);
        let setup = Setup::new(loaded).unwrap();
        let (mut both, mut device) = (Both::new(seed), setup.device());
        device.power_up(&mut Off, &mut Off);
        // Begins amid a change now and then.
        for _ in 0..random.random_range(0..40) {
            device.step(&setup.params, &mut Off, &mut Off);
        }
        let edge = device.next_edge();
        let mut rests = 0;
        device.resume_clocks(edge);
        both.part.show(&device.top, &mut both.followed);
        for cycle in 0..cycles {
            let rested = rests_rightly(&device.top, &setup.params);
            rests += usize::from(rested.unwrap_or_else(|| panic!("seed {seed}, cycle {cycle}")));
            device.step(&setup.params, &mut both, &mut Off);
        }
        assert!(both.looks >= 30_000 && both.resets > 5, "seed {seed}");
        assert!(rests > 3000 && both.estimations > 5, "seed {seed}");
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
