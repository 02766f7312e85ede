//! Both levels, in every order.

use tofsim::firmware::lvds_output::{self, In};

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    timing: timing::NONE,
    model: Some(Model::combinational::<In>(|at| {
        at.top.lvds_output = lvds_output::out(&at.input());
    })),
    ..Spec::new("lvds_output", "lvds_output", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut changes = Cover::new("i from x 2 + to", 0..4);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut last = false;
    for _ in 0..setting.cycles() {
        let i = run.draw.one_in(2);
        changes.see(bits([last, i]));
        last = i;
        run.top.lvds_output = lvds_output::out(&In { i });
        run.line(&In { i });
    }
    Ok(run.vectors([changes]))
}
