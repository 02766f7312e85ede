//! `pre_start` of every length in both modes, with the mode changed and the reset pressed in every
//! phase of it.

use tofsim::firmware::spad_control::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[Latency { from: "pre_start", to: "spad_rst", cycles: |_| 0 }],
    configurations: &[ARRAY_OF_40],
    model: Some(Model::new::<In>(|at| at.top.spad_control.tick(&at.input(), &()))),
    ..Spec::new("spad_control", "spad_control", record)
};

/// As many rows as `spad_sel` can select.
const ARRAY_OF_40: Configuration = Configuration {
    set: &["array.rows=40", "array.columns=3", "estimator.kind=network"],
    parameters: &["Rows"],
    ..ARRAY
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut changes = Cover::new("rst, mode, pre_start as bits, from x 8 + to", 0..64);
    let levels = |i: In| bits([i.rst, i.mode, i.pre_start]);
    let rows = u64::from(setting.setup.params.frame_ctrl.scan.rows);
    let mut selected = Cover::new("rows", 0..rows);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut i = In::default();
    for cycle in 0..setting.cycles() {
        let before = i;
        i.rst = cycle == FIRST_RESET || run.draw.one_in(4);
        i.mode ^= run.draw.one_in(3);
        i.pre_start = run.draw.one_in(2);
        if rows > 1 {
            i.row = U::new(run.draw.below(rows));
        }
        selected.see_if(!i.rst, i.row.get());
        changes.see(levels(before) * 8 + levels(i));
        run.line(&i);
        run.top.spad_control = run.top.spad_control.next(&i, &());
    }
    Ok(run.vectors([changes, selected]))
}
