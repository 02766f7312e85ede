//! The whole firmware: a scenario as it is, or short frames under control signals that change at
//! random, also in the middle of a frame, and abandon some.

use crate::firmware::frame_ctrl::State;
use crate::firmware::tof_top::{Pins, TofTop};
use crate::golden::block::{Setting, Spec};
use crate::golden::cover::Cover;
use crate::golden::draw::Draw;
use crate::golden::timing::OWN_WITH_RESET;
use crate::golden::{Vectors, top};
use crate::scenario::Control;
use crate::sim::setup::Setup;

pub(super) const SPEC: Spec = Spec {
    name: "tof_top",
    scope: "",
    timing: OWN_WITH_RESET,
    reset: None,
    fast: &[
        "laser_on_lvds_p",
        "laser_on_lvds_n",
        "laser_on",
        "rst_250",
        "reset_sync_250.rst_sync",
        "reset_sync_250.meta",
        "vcsel_driver.laser_pulse",
        "vcsel_driver.laser_on",
        "vcsel_driver.ddr_output.q",
        "lvds_output.o",
        "lvds_output.ob",
    ],
    latency: &[],
    glue: None,
    record,
};

/// A little more than Clear takes after a reset [ns].
const ACQUIRE_NS: u64 = 2_120;
/// Shots of a frame under random control.
const SHOTS: u16 = 8;

fn record(spec: &'static Spec, setting: &Setting) -> crate::error::Result<Vectors> {
    if setting.as_told {
        return top::record(spec, &setting.setup, setting, &mut |_, _| ());
    }
    let mut setup = setting.setup.clone();
    setup.params.frame_ctrl.shots_per_frame = SHOTS;
    setup.scenario.control = control(&setup, setting);
    let mut covered = Covered::new();
    let vectors = top::record(spec, &setup, setting, &mut |pins, top| covered.see(pins, top))?;
    Ok(Vectors { coverage: covered.goals, ..vectors })
}

/// Control signals that change at random times; some frames are abandoned twice, the second time in
/// Acquire.
fn control(setup: &Setup, setting: &Setting) -> Vec<Control> {
    let mut draw = Draw::new(setting.seed, u64::MAX);
    let mut changes = Vec::new();
    let first_us = setup.pll().locked_at.fs() as f64 * 1e-9;
    let (mut at_ns, end_ns) = (0, 8 * setting.cycles() as u64);
    let mut again = false;
    while at_ns < end_ns {
        let mut change = Control {
            at_us: first_us + at_ns as f64 * 1e-3,
            laser_freq: draw.one_in(2).then(|| draw.below(4)),
            mode: draw.one_in(8).then(|| draw.below(2)),
            laser_en: draw.one_in(8).then(|| !draw.one_in(4)),
            dsp_en: draw.one_in(4).then(|| !draw.one_in(4)),
            dsp_rst: (again || draw.one_in(20)).then_some(true),
            rst: draw.one_in(60).then_some(true),
        };
        changes.push(change.clone());
        let pause = if draw.one_in(3) { 3000 } else { 200 };
        at_ns += 1 + draw.below(pause);
        if change.dsp_rst.is_some() || change.rst.is_some() {
            change.at_us = first_us + at_ns as f64 * 1e-3;
            (change.dsp_rst, change.rst) = (Some(false), Some(false));
            changes.push(change);
            again = draw.one_in(3);
            at_ns += if again { ACQUIRE_NS + draw.below(600) } else { 1 + draw.below(12_000) };
        } else {
            again = false;
        }
    }
    changes
}

struct Covered {
    goals: Vec<Cover>,
    before: Option<(State, u64)>,
}

impl Covered {
    fn new() -> Self {
        let transitions = [(0, 1), (1, 2), (2, 3), (3, 0), (1, 0)];
        let goals = vec![
            Cover::new("states, from x 4 + to", transitions.map(|(from, to)| from * 4 + to)),
            Cover::new("laser_freq in force, from x 4 + to", 0..16),
            Cover::new("coarse", 0..8),
            Cover::new("dsp_rst in state", [0, 1, 3]),
            Cover::new("mode of a hit", 0..2),
        ];
        Covered { goals, before: None }
    }

    fn see(&mut self, _: &Pins, top: &TofTop) {
        let state = top.frame_ctrl.state();
        let rate = top.vcsel_driver.registers.place().map_or(0, |place| place.0);
        if let Some((last, last_rate)) = self.before {
            self.goals[0].see_if(last != state, last as u64 * 4 + state as u64);
            self.goals[1].see(last_rate * 4 + rate);
        }
        let counter = &top.tdc.coarse_counter;
        self.goals[2].see_if(counter.window, counter.coarse.get());
        self.goals[3].see_if(top.control_sync.dsp_rst_sync, state as u64);
        self.goals[4].see_if(top.tdc.tdc_latch.hit, top.control_sync.mode_sync as u64);
        self.before = Some((state, rate));
    }
}
