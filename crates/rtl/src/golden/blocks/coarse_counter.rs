//! Shots of every length: cut short, exactly full, and with a pause after the window.

use tofsim::firmware::coarse_counter::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[Latency { from: "start", to: "window", cycles: |_| 0 }],
    ..Spec::new("coarse_counter", "tdc.coarse_counter", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut coarse = Cover::new("coarse", 0..8);
    let mut started_at = Cover::new("start at coarse, or with the window closed (8)", 0..9);
    let mut run = Recorder::new(spec, setting, In::list());
    let mut edges_until_start = 0;
    for cycle in 0..setting.cycles() {
        let counter = run.top.tdc.coarse_counter;
        let start = edges_until_start == 0;
        edges_until_start = if start { run.draw.below(14) } else { edges_until_start - 1 };
        coarse.see_if(counter.window, counter.coarse.get());
        started_at.see_if(start, if counter.window { counter.coarse.get() } else { 8 });
        let i = In { rst: cycle == FIRST_RESET || run.draw.one_in(100), start };
        run.line(&i);
        run.top.tdc.coarse_counter = counter.next(&i, &());
    }
    Ok(run.vectors([coarse, started_at]))
}
