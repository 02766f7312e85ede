//! Calibrations from hits that are two cycles apart or more, with one `n` of many around the laser edge; every other
//! one is left by a reset, in each state in turn. Between them hits of every number are looked up.

use tofsim::firmware::tdc_calibration::{BEATS, FRACTION, In, Params, State, TdcCalibration};

use crate::golden::prelude::*;

/// Fewest cycles from a hit to the next.
const APART: u64 = 2;
/// Calibrations, of which every other is seen to its end.
const CALIBRATIONS: u64 = 10;
/// Cycles in the state that a reset ends, of a long chain.
const STAYS: u64 = 40;
/// Hits of a calibration as a power of two, and frames between two, if the design has no constants: few.
const FEW: (u32, u64) = (10, 60);
/// Parts of a period up to the laser edge, beyond which there is no room for a wide `n` around it [1/64].
const LAST_EDGE: u64 = 51;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        Latency { from: "clear", to: "ring_on", cycles: |_| 0 },
        Latency { from: "clear", to: "calibrating", cycles: |_| 0 },
        Latency { from: "frame_done", to: "calibrating", cycles: |_| 1 },
        Latency { from: "n_valid", to: "calibrated_age", cycles: |_| 0 },
        Latency { from: "n", to: "calibrated_age", cycles: |_| 0 },
    ],
    model: Some(Model::new::<In>(|at| {
        if let Some(params) = &at.params.tdc_calibration {
            at.top.tdc_calibration.tick(&at.input(), params);
        }
    })),
    ..Spec::new("tdc_calibration", "tdc_calibration", record)
};

/// The setting with such a block, and its parameters.
fn with_block(setting: &Setting) -> (Setting, Params) {
    let mut setting = setting.clone();
    let all = &mut setting.setup.params;
    let (hits_log2, frames) = FEW;
    let few = || Params::new(&all.tdc.delays, &all.tdc.decoder.scale, hits_log2, frames);
    let own = all.tdc_calibration.clone().filter(|_| setting.constants.has("HitsLog2"));
    let params = own.unwrap_or_else(few);
    all.tdc = all.tdc.clone().calibrated(params.hits_log2);
    all.tdc_calibration = Some(params.clone());
    (setting, params)
}

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let (setting, params) = with_block(setting);
    let (taps, places) = (params.taps as u64, setting.places() as u64);
    // Part of a period from the youngest hit to the one at the laser edge.
    let edge = ((params.start - params.begin) << 6) / (params.cycle << FRACTION);
    let mut states = Cover::new(
        "state from x 4 + to",
        [(0, 1), (1, 2), (2, 3), (3, 0), (1, 0), (2, 0)].map(|(from, to)| from * 4 + to),
    );
    let mut inputs = Cover::new("state x 8 + clear, frame_done, n_valid as bits", 0..32);
    let mut counted = Cover::new("bits of the n of a counted hit", 1..=places.ilog2().into());
    let mut ages = Cover::new("n of an age that is read", 0..=taps);
    let cases: &[u64] = if edge < LAST_EDGE { &[0, 2, 3] } else { &[2] };
    let mut limits = Cover::new("begins by the laser edge, is limited, as bits", cases.iter().copied());
    let mut apart = Cover::new("cycles from a counted hit to the next", APART..8);
    let mut dues = Cover::new("due x 2 + frame_done", 0..4);
    let mut run = Recorder::new(spec, &setting, In::list());
    run.top.tdc_calibration = TdcCalibration::new(&params);
    let (stays, idle) = (STAYS.min(taps / 2), APART * (taps + 2));
    let whole = 5 * params.hits() + (1 + BEATS) * (taps + 1) + 2 * idle;
    // Cycles since the last hit and in this state, calibrations begun, hits looked up.
    let (mut since, mut stayed, mut turn, mut swept) = (APART, 0, 0, 0);
    let mut last = State::Idle;
    for cycle in 0..setting.cycles.unwrap_or((CALIBRATIONS * whole) as usize) {
        let (block, draw) = (&mut run.top.tdc_calibration, &mut run.draw);
        let state = block.state();
        states.see(last as u64 * 4 + state as u64);
        if state != last {
            turn += u64::from(state == State::Zero);
            stayed = 0;
        }
        stayed += 1;
        let left_in = [State::Zero, State::Count, State::Integrate][(turn / 2 % 3) as usize];
        let leaves = turn % 2 == 0 && state == left_in && stayed == stays;
        // The one after a reset begins at once: it is due, however many frames there have been.
        let looks_up = state == State::Idle && stayed < idle && turn % 2 == 1;
        let n_valid = since >= APART && (looks_up || draw.one_in(3));
        let n = match draw.below(64) {
            _ if state == State::Idle => swept % (taps + 1),
            0..4 => 1 + draw.below(places),
            part if part + 6 < edge => 1 + draw.below(places.min(8)),
            part if part < edge + 13 => 1 + places / 2,
            _ => places,
        };
        swept += u64::from(n_valid && state == State::Idle);
        let (due, hits) = block.progress();
        let i = In {
            rst: cycle == FIRST_RESET || leaves,
            clear: !(looks_up && due) && draw.one_in(2),
            // Few while it works, so that the next one is not due at once.
            frame_done: draw.one_in(if state == State::Idle { 6 } else { 200 }),
            n_valid,
            n: U::new(n),
        };
        inputs.see(state as u64 * 8 + bits([i.clear, i.frame_done, i.n_valid]));
        dues.see(bits([due, i.frame_done]));
        if state == State::Count && hits < params.hits() && n_valid && !i.rst {
            counted.see(u64::from(n.ilog2()));
            apart.see_if(since < 8, since);
        }
        ages.see_if(state == State::Idle && turn > 1 && n_valid, n);
        if let Some((early, limited)) = block.limits(&params) {
            limits.see(bits([early, limited]));
        }
        since = if n_valid { 1 } else { since + 1 };
        last = state;
        run.line(&i);
        run.top.tdc_calibration.tick(&i, &params);
    }
    let mut vectors = run.vectors([states, inputs, counted, ages, limits, apart, dues]);
    vectors.parameters.extend(parameters::tdc_calibration(&params));
    Ok(vectors)
}
