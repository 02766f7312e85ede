//! Whole estimations with starts while busy in every phase, and estimations cut short by a reset in
//! every third phase and in all about a change of layer; the seed says which third.

use tofsim::firmware::estimator_ctrl::{In, done};

use crate::golden::prelude::*;

/// Phases past this one are all cut short: the changes of layer are there.
const LAYERS: u64 = 254;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        Latency { from: "algo_start", to: "read_en", cycles: |_| 0 },
        Latency { from: "algo_start", to: "algo_done", cycles: |vectors| done(vectors.sizes.neurons) },
    ],
    configurations: &[NEURONS_16],
    ..Spec::new("estimator_ctrl", "depth_estimator.estimator_ctrl", record)
};

/// Lines in which an estimation is cut short everywhere.
const LINES: usize = 26_000;

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let (neurons, third) = (setting.neurons(), setting.seed % 3);
    let is_cut = |phase: &u64| phase % 3 == third || *phase == 0 || *phase > LAYERS;
    // Phases to reset in, the next one last; where this estimation is cut, if it is.
    let mut cuts: Vec<_> = (0..=done(neurons)).filter(is_cut).collect();
    let mut cut = None;
    let mut starts = Cover::new("start in cycle after e0", 0..=done(neurons));
    let mut resets = Cover::new("reset in cycle after e0", cuts.iter().copied());
    let mut idle = Cover::new("rst x 2 + algo_start while idle", 0..4);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut begun = 0;
    for cycle in 0..setting.cycles.unwrap_or(LINES) {
        let (ctrl, draw) = (run.top.depth_estimator.estimator_ctrl, &mut run.draw);
        let phase = ctrl.phase(neurons);
        let i = match phase {
            Some(phase) => In {
                rst: cut == Some(phase),
                // Every phase within four estimations.
                algo_start: (phase + begun).is_multiple_of(4) || draw.one_in(50),
            },
            None => In { rst: draw.one_in(6) && cycle > 0, algo_start: draw.one_in(3) },
        };
        let i = In { rst: i.rst || cycle == FIRST_RESET, ..i };
        match phase {
            Some(phase) => {
                starts.see_if(i.algo_start && !i.rst, phase);
                resets.see_if(i.rst, phase);
            }
            None => idle.see(bits([i.rst, i.algo_start])),
        }
        if i.algo_start && !i.rst && phase.is_none_or(|phase| phase == done(neurons)) {
            begun += 1;
            cut = if begun > 4 && !draw.one_in(20) { cuts.pop() } else { None };
        }
        run.line(&i);
        run.top.depth_estimator.estimator_ctrl = ctrl.next(&i, &neurons);
    }
    let parameters = parameters::neurons(neurons).into_iter().collect();
    Ok(Vectors { parameters, ..run.vectors([starts, resets, idle]) })
}
