//! The oscillator from power-up: before lock, the first edges, and the clocks running.

use tofsim::firmware::pll::In;
use tofsim::kernel::clock::Clock;

use crate::golden::prelude::*;
use crate::golden::top;

pub(super) const SPEC: Spec = Spec {
    timing: timing::OWN,
    configurations: &[CLOCKS],
    fast: &["clk_sys", "clk_laser", "locked"],
    model: Some(Model::combinational::<In>(|at| {
        at.top.clocks.clk_sys = level(&at.pll.clk_sys, at.now);
        at.top.clocks.clk_laser = level(&at.pll.clk_laser, at.now);
        at.top.pll.locked = at.now >= at.pll.locked_at;
    })),
    ..Spec::new("pll", "pll", record)
};

/// Level of a clock.
fn level(clock: &Clock, at: Time) -> bool {
    let (first, period) = (clock.rise(0), clock.rise(1) - clock.rise(0));
    at >= first && at < clock.fall((at - first).fs() / period.fs())
}

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    top::check(&setting.setup)?;
    let pll = setting.setup.pll();
    let mut levels = Cover::new("locked, clk_sys, clk_laser as bits", [0, 4, 5, 6, 7]);
    let mut run = Recorder::new(spec, setting, Vec::new());
    for quarter in 1..=4 * setting.cycles() as u64 {
        let at = timing::of_quarters(quarter, pll.cycle) - timing::ASIDE;
        let top = &mut run.top;
        top.clocks.clk_sys = level(&pll.clk_sys, at);
        top.clocks.clk_laser = level(&pll.clk_laser, at);
        top.pll.locked = at >= pll.locked_at;
        levels.see(bits([top.pll.locked, top.clocks.clk_sys, top.clocks.clk_laser]));
        run.sample();
    }
    let mut own = vec![("LockTime", Parameter::Number(pll.locked_at.ps()))];
    own.extend(parameters::clocks(&setting.setup.scenario.pll.params()));
    Ok(run.vectors([levels]).with(own))
}
