//! Whole estimations with starts while busy in every phase, and estimations cut short by a reset in
//! every third phase and in all about a change of layer; the seed says which third.

use tofsim::firmware::estimator_ctrl::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        Latency { from: "algo_start", to: "read_en", cycles: |_| 0 },
        Latency { from: "algo_start", to: "algo_done", cycles: |vectors| vectors.sizes.network_cycles.into() },
    ],
    configurations: &[NEURONS_16, NEURONS_31],
    model: Some(Model::new::<In>(|at| {
        at.top.depth_estimator.estimator_ctrl.tick(&at.input(), &at.params.estimators.depth_estimator.ctrl());
    })),
    ..Spec::new("estimator_ctrl", "depth_estimator.estimator_ctrl", record)
};

/// Lines for each bin, in which estimations are cut short everywhere.
const LINES_A_BIN: usize = 101;
/// Lines at least.
const LINES: usize = 26_000;

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let p = setting.setup.params.estimators.depth_estimator.ctrl();
    let done = p.done();
    // The first phases and those past this one are all cut short: the changes of layer are there.
    let layers = p.bins as u64 - 2;
    let apart = 3 * (p.bins as u64 / 256).max(1);
    let is_cut =
        |phase: &u64| phase % apart == setting.seed % apart || *phase < 4 || *phase > layers;
    // Phases to reset in, the next one last; where this estimation is cut, if it is.
    let mut cuts: Vec<_> = (0..=done).filter(is_cut).collect();
    let mut cut = None;
    let mut starts = Cover::new("start in cycle after e0", 0..=done);
    let mut resets = Cover::new("reset in cycle after e0", cuts.iter().copied());
    let mut idle = Cover::new("rst x 2 + algo_start while idle", 0..4);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut begun = 0;
    for cycle in 0..setting.cycles.unwrap_or(LINES.max(LINES_A_BIN * p.bins)) {
        let (ctrl, draw) = (run.top.depth_estimator.estimator_ctrl, &mut run.draw);
        let phase = ctrl.phase(&p);
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
        if i.algo_start && !i.rst && phase.is_none_or(|phase| phase == done) {
            begun += 1;
            cut = if begun > 4 && !draw.one_in(20) { cuts.pop() } else { None };
        }
        run.line(&i);
        run.top.depth_estimator.estimator_ctrl = ctrl.next(&i, &p);
    }
    Ok(run.vectors([starts, resets, idle]))
}
