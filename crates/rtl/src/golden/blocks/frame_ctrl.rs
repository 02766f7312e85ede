//! Frames of three shots, left in turn at every place by either reset or both; starts, ends of the
//! estimation and pauses of `dsp_en` also where they mean nothing.

use tofsim::firmware::frame_ctrl::{In, Params, State};
use tofsim::kernel::signals::Word;

use crate::golden::prelude::*;

/// Few, so that all states recur.
const SHOTS: u16 = 3;
/// Cycles of Drain.
const DRAIN: u64 = 16;

pub(super) const SPEC: Spec = Spec {
    stream: Some(9),
    reset: Some("rst"),
    latency: &[
        Latency { from: "start", to: "acquire", cycles: |_| 0 },
        Latency { from: "dsp_en", to: "algo_start", cycles: |_| 0 },
        Latency { from: "algo_done", to: "frame_done", cycles: |_| 0 },
    ],
    ..Spec::new("frame_ctrl", "frame_ctrl", record::<FrameCtrl>)
};

struct FrameCtrl {
    params: Params,
    state: State,
    /// Cycles in the state.
    phase: u64,
    /// Where to leave, state and place in it; `turn` counts them.
    exits: Vec<(State, u64)>,
    turn: usize,
    /// Whether this run is to be left there.
    leaves: bool,
    /// Frames finished.
    frames: u64,
    transitions: Cover,
    resets: Cover,
    kinds: Cover,
    inputs: Cover,
}

fn is_preloaded_state(state: State) -> bool {
    matches!(state, State::Clear | State::Estimate)
}

impl Block for FrameCtrl {
    type Stimulus = In;

    fn new(setting: &Setting) -> Self {
        let preloaded = setting.setup.params.frame_ctrl.preloaded;
        let clear = (0..256).step_by(51).map(|word| (State::Clear, word));
        let acquire = (0..SHOTS as u64).map(|shots| (State::Acquire, shots));
        let drain = (0..=DRAIN).map(|cycle| (State::Drain, cycle));
        let estimate = (0..3).map(|cycle| (State::Estimate, cycle));
        let mut exits: Vec<_> = clear.chain(acquire).chain(drain).chain(estimate).collect();
        exits.retain(|&(state, _)| !preloaded || is_preloaded_state(state));
        let states = [State::Clear, State::Acquire, State::Drain, State::Estimate];
        let states = states.into_iter().filter(|&state| !preloaded || is_preloaded_state(state));
        let each = |n: u64| states.clone().flat_map(move |s| (0..n).map(move |k| s.bits() * n + k));
        let steps: &[u64] = if preloaded { &[3, 12] } else { &[1, 6, 11, 12] };
        FrameCtrl {
            params: Params { shots_per_frame: SHOTS, preloaded },
            state: State::Clear,
            phase: 0,
            turn: 0,
            leaves: false,
            frames: 0,
            transitions: Cover::new("state from x 4 + to", steps.iter().copied()),
            resets: Cover::new(
                "reset in state x 256 + place (word, shots, cycle)",
                exits.iter().map(|(state, place)| state.bits() * 256 + place),
            ),
            kinds: Cover::new("state x 4 + rst x 2 + dsp_rst", each(4)),
            inputs: Cover::new("state x 8 + start, dsp_en, algo_done as bits", each(8)),
            exits,
        }
    }

    fn stimulus(&mut self, _: usize, top: &TofTop, draw: &mut Draw) -> In {
        let ctrl = &top.frame_ctrl;
        let state = ctrl.state();
        self.phase = if state == self.state { self.phase + 1 } else { 0 };
        let place = match state {
            State::Clear => ctrl.clear_addr.get(),
            State::Acquire => ctrl.shots(),
            State::Drain => self.phase.min(DRAIN),
            State::Estimate => self.phase.min(2),
        };
        self.transitions.see(self.state.bits() * 4 + state.bits());
        let exit = self.exits[self.turn % self.exits.len()];
        let leave = self.leaves && exit == (state, place);
        // 1, 2, 3: dsp_rst, rst, both.
        let kind = if leave { self.turn as u64 % 3 + 1 } else { 0 };
        let held = self.leaves && exit == (State::Drain, DRAIN);
        let (start, dsp_en) = match state {
            State::Estimate => (self.frames.is_multiple_of(2), self.frames % 4 < 2),
            State::Acquire => (draw.one_in(4), draw.one_in(2)),
            _ => (draw.one_in(2), draw.one_in(2)),
        };
        let i = In {
            rst: kind >= 2,
            dsp_rst: kind % 2 == 1,
            start,
            dsp_en: dsp_en && !held,
            algo_done: draw.one_in(4),
        };
        self.resets.see_if(leave, state.bits() * 256 + place);
        self.kinds.see(state.bits() * 4 + kind);
        self.inputs.see(state.bits() * 8 + bits([i.start, i.dsp_en, i.algo_done]));
        if leave {
            self.turn += 1;
        }
        self.frames += u64::from(top.frame_ctrl.frame_done);
        let begins = top.frame_ctrl.frame_done || leave;
        self.leaves = if begins { !draw.one_in(4) } else { self.leaves };
        self.state = if leave { State::Clear } else { state };
        i
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        top.frame_ctrl = top.frame_ctrl.next(i, &self.params);
    }

    fn parameters(&self) -> Parameters {
        vec![
            ("ShotsPerFrame", Parameter::Number(SHOTS.into())),
            ("Preloaded", Parameter::Number(self.params.preloaded.into())),
        ]
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.transitions, self.resets, self.kinds, self.inputs]
    }
}
