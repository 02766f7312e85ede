//! `pre_start` of every length in both modes, with the mode changed and the reset pressed in every
//! phase of it.

use tofsim::firmware::spad_control::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[Latency { from: "pre_start", to: "spad_rst", cycles: |_| 0 }],
    model: Some(Model::new::<In>(|at| at.top.spad_control.tick(&at.input(), &()))),
    ..Spec::new("spad_control", "spad_control", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut changes = Cover::new("rst, mode, pre_start as bits, from x 8 + to", 0..64);
    let levels = |i: In| bits([i.rst, i.mode, i.pre_start]);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut i = In::default();
    for cycle in 0..setting.cycles() {
        let before = i;
        i.rst = cycle == FIRST_RESET || run.draw.one_in(4);
        i.mode ^= run.draw.one_in(3);
        i.pre_start = run.draw.one_in(2);
        changes.see(levels(before) * 8 + levels(i));
        run.line(&i);
        run.top.spad_control = run.top.spad_control.next(&i, &());
    }
    Ok(run.vectors([changes]))
}
