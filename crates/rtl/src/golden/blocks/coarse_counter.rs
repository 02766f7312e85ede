//! Shots of every length: cut short, exactly full, and with a pause after the window.

use tofsim::firmware::coarse_counter::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[Latency { from: "start", to: "window", cycles: |_| 0 }],
    model: Some(Model::new::<In>(|at| {
        at.top.tdc.coarse_counter.tick(&at.input(), &at.params.tdc.coarse_counter);
    })),
    ..Spec::new("coarse_counter", "tdc.coarse_counter", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let params = setting.setup.params.tdc.coarse_counter;
    let window = params.window();
    let mut coarse = Cover::new("coarse", ends(window));
    let mut started_at =
        Cover::new("start at coarse, or with the window closed (its length)", ends(window).chain([window]));
    let mut run = Recorder::new(spec, setting, In::list());
    let mut edges_until_start = 0;
    let lines = Setting::CYCLES.max(128 * window as usize);
    for cycle in 0..setting.cycles.unwrap_or(lines) {
        let counter = run.top.tdc.coarse_counter;
        let start = edges_until_start == 0;
        edges_until_start = if !start {
            edges_until_start - 1
        } else if window > 16 && run.draw.one_in(2) {
            // Of a long window mostly to its ends.
            window - 9 + run.draw.below(14)
        } else {
            run.draw.below(window.min(16) + 6)
        };
        coarse.see_if(counter.window, counter.coarse.get());
        started_at.see_if(start, if counter.window { counter.coarse.get() } else { window });
        let rst = cycle == FIRST_RESET || run.draw.one_in(u64::max(100, 8 * window));
        let i = In { rst, start };
        run.line(&i);
        run.top.tdc.coarse_counter = counter.next(&i, &params);
    }
    Ok(run.vectors([coarse, started_at]))
}
