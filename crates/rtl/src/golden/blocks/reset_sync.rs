//! Reset and lock in every order, some for a single cycle.

use tofsim::firmware::reset_sync::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    timing: timing::CLK,
    latency: &[
        Latency { from: "rst", to: "rst_sync", cycles: |_| 1 },
        Latency { from: "locked", to: "rst_sync", cycles: |_| 1 },
    ],
    model: Some(Model::new::<In>(|at| at.top.reset_sync_sys.tick(&at.input(), &()))),
    ..Spec::new("reset_sync", "reset_sync_sys", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut changes = Cover::new("rst x 2 + locked, from x 4 + to", 0..16);
    let levels = |i: In| bits([i.rst, i.locked]);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut i = In { rst: false, locked: true };
    for _ in 0..setting.cycles() {
        let before = i;
        i.rst ^= run.draw.one_in(3);
        i.locked ^= run.draw.one_in(3);
        changes.see(levels(before) * 4 + levels(i));
        run.line(&i);
        run.top.reset_sync_sys = run.top.reset_sync_sys.next(&i, &());
    }
    Ok(Vectors { settles: 2, ..run.vectors([changes]) })
}
