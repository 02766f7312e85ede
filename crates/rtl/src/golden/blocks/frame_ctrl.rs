//! Frames of three shots, left in turn at every place by either reset or both; starts, ends of the
//! estimation and pauses of `dsp_en` also where they mean nothing.

use tofsim::firmware::frame_ctrl::{In, Params, State};
use tofsim::firmware::histogram_builder::BINS;
use tofsim::kernel::signals::Word;

use crate::golden::configuration;
use crate::golden::prelude::*;

/// Few, so that all states recur.
const SHOTS: u32 = 3;
/// A longer Drain takes more lines [cycles].
const FRAME: u64 = 100;
/// Of more shots than these, nearly each cycle has one.
const FEW: u32 = 50;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        Latency { from: "start", to: "acquire", cycles: |_| 0 },
        Latency { from: "dsp_en", to: "algo_start", cycles: |_| 0 },
        Latency { from: "algo_done", to: "frame_done", cycles: |_| 0 },
    ],
    configurations: &[PRELOADED, CALIBRATED, ARRAY, ONE_BANK],
    model: Some(Model::new::<In>(|at| at.top.frame_ctrl.tick(&at.input(), &at.params.frame_ctrl))),
    ..Spec::new("frame_ctrl", "frame_ctrl", record)
};

/// The histogram comes from a ROM.
const PRELOADED: Configuration = Configuration {
    name: "preloaded",
    scenario: "estimator_validation",
    parameters: &["Preloaded"],
    ..configuration::DEFAULTS
};

/// An array whose rows are estimated before the next one acquires.
const ONE_BANK: Configuration = Configuration {
    name: "one_bank",
    set: &["array.rows=4", "array.columns=3", "array.banks=1", "estimator.kind=network"],
    parameters: &["Rows", "Columns"],
    ..ARRAY
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let preloaded = setting.setup.params.frame_ctrl.preloaded;
    let scan = setting.setup.params.frame_ctrl.scan;
    let is_banked = scan.banks > 1;
    let is_state = |state| match state {
        State::Clear => true,
        State::Acquire | State::Drain => !preloaded,
        State::Estimate => !is_banked,
    };
    // Where to leave, state and place in it; `turn` counts them.
    let bins = setting.setup.params.histogram.bins;
    let clear = (0..bins as u64).step_by(51.min(bins / 4)).map(|word| (State::Clear, word));
    let shots = setting.shots(SHOTS);
    // Of many shots, the first and the last ones.
    let places = (0..u64::from(shots)).filter(|shot| *shot < 2 || *shot + 2 >= u64::from(shots));
    let acquire = places.map(|shots| (State::Acquire, shots));
    let length = setting.setup.params.frame_ctrl.drain_cycles;
    let drain = ends(length + 1).map(|cycle| (State::Drain, cycle));
    let estimate = (0..3).map(|cycle| (State::Estimate, cycle));
    let mut exits: Vec<_> = clear.chain(acquire).chain(drain).chain(estimate).collect();
    exits.retain(|&(state, _)| is_state(state));
    let states = [State::Clear, State::Acquire, State::Drain, State::Estimate];
    let states = states.into_iter().filter(|&state| is_state(state));
    let each = |n: u64| states.clone().flat_map(move |s| (0..n).map(move |k| s.bits() * n + k));
    let steps: &[u64] = match (preloaded, is_banked) {
        (true, _) => &[3, 12],
        (false, false) => &[1, 6, 11, 12],
        (false, true) => &[1, 6, 8],
    };
    let mut transitions = Cover::new("state from x 4 + to", steps.iter().copied());
    let mut resets = Cover::new(
        "reset in state x 2^25 + place (word, shots, cycle)",
        exits.iter().map(|(state, place)| (state.bits() << 25) + place),
    );
    let mut kinds = Cover::new("state x 4 + rst x 2 + dsp_rst", each(4));
    let mut inputs = Cover::new("state x 8 + start, dsp_en, algo_done as bits", each(8));

    let (rows, columns) = (u64::from(scan.rows), u64::from(scan.columns));
    let places = (0..rows * columns).map(|place| place / columns * 64 + place % columns);
    let mut places = Cover::new("row x 64 + column of an estimate", places);
    let waits = if is_banked { 0..8 } else { 0..0 };
    let mut waits = Cover::new("end of Drain: bank, the other one is read, dsp_en as bits", waits);

    // Most calibrations last into the last cycle of Clear, and a few cycles longer.
    let calibrates = setting.setup.params.tdc_calibration.is_some();
    let histogram = setting.histogram();
    let params = Params { shots_per_frame: shots, histogram, preloaded, drain_cycles: length, scan };
    let mut run = Recorder::new(spec, setting, In::list());
    // The state, cycles in it, whether this run is to be left at the exit of this turn, frames finished.
    let (mut last, mut phase, mut leaves, mut turn, mut frames) = (State::Clear, 0, false, 0, 0u64);
    // Frames since the last exit.
    let mut whole = 0;
    // So that each exit comes up whatever the draws.
    let lines = exits.len() * (344 + bins + shots as usize + length as usize);
    let is_long = shots > FEW || length > FRAME || bins > BINS;
    let lines = match scan.is_single() {
        true if is_long => Setting::CYCLES.max(2 * lines),
        true => Setting::CYCLES,
        false => Setting::CYCLES.max((scan.rows as usize + 2) * lines),
    };
    for cycle in 0..setting.cycles.unwrap_or(lines) {
        let (ctrl, draw) = (run.top.frame_ctrl, &mut run.draw);
        let (state, is_read) = (ctrl.state(), ctrl.is_estimating());
        phase = if state == last { phase + 1 } else { 0 };
        let place = match state {
            State::Clear => ctrl.clear_addr.get(),
            State::Acquire => ctrl.shots(),
            State::Drain => phase.min(length),
            State::Estimate => phase.min(2),
        };
        transitions.see(last.bits() * 4 + state.bits());
        let exit = exits[turn % exits.len()];
        let leave = leaves && exit == (state, place);
        // 1, 2, 3: dsp_rst, rst, both.
        let kind = if leave { turn as u64 % 3 + 1 } else { 0 };
        let held = leaves && exit == (State::Drain, length);
        let (start, dsp_en) = match state {
            State::Estimate => (frames.is_multiple_of(2), frames % 4 < 2),
            State::Acquire => (if shots > FEW { !draw.one_in(8) } else { draw.one_in(4) }, draw.one_in(2)),
            _ => (draw.one_in(2), draw.one_in(2)),
        };
        let i = In {
            rst: kind >= 2 || cycle == FIRST_RESET,
            dsp_rst: kind % 2 == 1,
            start,
            dsp_en: dsp_en && !held,
            // Rows wait for the estimates of others that are long.
            algo_done: draw.one_in(if is_banked && is_read && frames.is_multiple_of(2) { 200 } else { 4 }),
            calibrating: calibrates && state == State::Clear && draw.one_in(2),
        };
        resets.see_if(leave, (state.bits() << 25) + place);
        kinds.see(state.bits() * 4 + kind);
        inputs.see(state.bits() * 8 + bits([i.start, i.dsp_en, i.algo_done]));
        places.see_if(is_read && i.algo_done && kind == 0, ctrl.depth_row.get() * 64 + ctrl.depth_column.get());
        waits.see_if((state, place) == (State::Drain, length), bits([ctrl.bank, is_read, i.dsp_en]));
        turn += usize::from(leave);
        frames += u64::from(ctrl.frame_done);
        // Every row of an array comes up between two exits.
        whole = if leave { 0 } else { whole + u64::from(ctrl.frame_done) };
        if ctrl.frame_done || leave {
            leaves = !draw.one_in(4) && (scan.is_single() || whole > rows);
        }
        last = if leave { State::Clear } else { state };
        run.line(&i);
        run.top.frame_ctrl = ctrl.next(&i, &params);
    }
    let own = vec![
        ("ShotsPerFrame", Parameter::Number(shots.into())),
        ("Preloaded", Parameter::Number(preloaded.into())),
    ];
    Ok(run.vectors([transitions, resets, kinds, inputs, places, waits]).with(own))
}
