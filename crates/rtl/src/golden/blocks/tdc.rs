//! Shots at all rates and closer, with photons as in both modes and in bursts: exactly on edges and
//! on the boundaries of taps, before the shot and after its window, held over into the next; and a
//! sweep through every number of taps that a hit can have.

use tofsim::firmware::tdc::In;

use crate::golden::prelude::*;

mod goals;
mod light;

use goals::{Goals, LAST_RESET};
use light::Light;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        Latency { from: "tdc_stop", to: "tdc_valid", cycles: |_| 3 },
        Latency { from: "tdc_stop", to: "tdc_code", cycles: |_| 3 },
    ],
    ..Spec::new("tdc", "tdc", record)
};

signals! {
    /// Input ports; `tdc_stop` is no part of a line.
    struct Stimulus {
        /// Synchronous reset.
        rst: bool,
        /// A shot begins.
        start: bool,
    }
}

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let params = &setting.setup.params.tdc;
    let mut light = Light::new(&params.delays);
    let mut goals = Goals::new(&light.ages, params);
    let mut run = Recorder::new(spec, setting, Stimulus::list());
    // Cycle of the last start and of the next; cycle after a start in which the next reset comes.
    let (mut started, mut next, mut reset) = (0, 3, LAST_RESET);
    for cycle in 0..setting.cycles() {
        let draw = &mut run.draw;
        let start = cycle == next;
        let since = if start { 0 } else { cycle - started };
        let rst = since == reset && draw.one_in(6);
        if let Some(taps) = goals.see(cycle - started, start, rst, &run.top) {
            light.counted(taps);
        }
        if rst {
            reset = (reset + 1) % (LAST_RESET + 1);
        }
        if start {
            let period = match draw.below(8) {
                0 => 6,
                1 => 8,
                2 => 13,
                3 => 25,
                4 => 1 + draw.below(3),
                5 => 9 + draw.below(6),
                _ => 3 + draw.below(3),
            };
            (started, next) = (cycle, cycle + period as usize);
            let edge = |cycle: usize| Time::from_ns(8 * cycle as u64);
            light.shoot(edge(started), edge(next), draw);
        }
        run.line(&Stimulus { rst, start });
        let (now, stops) = (stops::edge(cycle), &mut light.stops);
        stops.advance(now);
        let i = In { rst, start, tdc_stop: stops.line.level() };
        run.top.tdc.rise(&i, params, &mut stops.line, now);
    }
    let memories = [roms::tap_delays(&params.delays), mem::tdc_decoder(&params.cal)];
    Ok(Vectors {
        parameters: files(["DelaysFile", "CalFile"], memories),
        stops: light.stops.times().to_vec(),
        ..run.vectors(goals.coverage())
    })
}
