//! Pulses of every width and distance, changes exactly on a clock edge and exactly on a tap's
//! boundary, and several pulses in the chain at once.

use tofsim::firmware::carry_chain::{CarryChain, Delays, In, MAX_TRANSITIONS};

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    latency: &[Latency { from: "tdc_stop", to: "taps", cycles: |_| 0 }],
    model: Some(Model::new::<In>(|at| {
        let taps = at.taps();
        at.top.tdc.carry_chain = CarryChain { taps };
    })),
    ..Spec::new("carry_chain", "tdc.carry_chain", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let delays = &setting.setup.params.tdc.delays;
    let arrivals = delays.arrivals();
    let count = delays.taps();
    let sampled = (0..=count).filter(|&n| n == 0 || n == count || arrivals[n - 1] < arrivals[n]);
    let mut ones = Cover::new("ones in the taps", sampled.map(|n| n as u64));
    let mut travelling = Cover::new("changes in the chain", 0..=MAX_TRANSITIONS as u64);
    let mut run = Recorder::new(spec, setting, Vec::new());
    let mut stops = Stops::new(setting.setup.cycle());
    for line in 0..setting.cycles_of_chain() {
        if stops.last() <= stops.edge(line) {
            plan(&mut stops, line, delays, &ones, &mut run.draw);
        }
        run.sample();
        let now = stops.edge(line);
        stops.advance(now);
        let taps = stops.sample(now, delays);
        run.top.tdc.carry_chain = CarryChain { taps };
        ones.see(taps.ones(count) as u64);
        let past = stops.times().iter().rev().skip_while(|at| **at > now);
        let changes = past.take_while(|at| now - **at < delays.longest()).count();
        travelling.see(changes as u64);
    }
    let own = files(["DelaysFile"], [parameters::tap_delays(delays)]);
    let stops = stops.times().to_vec();
    Ok(Vectors { stops, settles: 1, ..run.vectors([ones, travelling]).with(own) })
}

/// Plans changes after the edge that ends a line, now that none is left.
fn plan(stops: &mut Stops, line: usize, delays: &Delays, ones: &Cover, draw: &mut Draw) {
    let edge = stops.edge(line);
    // At that instant, or as soon after the last change as the chain can hold.
    let gap = Time::from_fs(delays.longest().fs().div_ceil(MAX_TRANSITIONS as u64));
    let toggle = |stops: &mut Stops, at: Time| {
        stops.toggle(at.max(stops.last() + gap).max(edge + Time::from_fs(1)));
    };
    let coming = stops.edge(line + 2);
    let quiet = !stops.ends_high() && stops.last() + delays.longest() <= coming;
    match (draw.below(5), ones.missing().find(|ones| *ones > 0)) {
        (0, _) => {
            let pause = stops::of_eighths(draw.below(50), stops.cycle);
            toggle(stops, stops.before(coming, delays, draw) + pause);
        }
        (1, _) => {
            for _ in 0..4 {
                let pause = Time::from_fs(draw.below(stops.cycle.fs() / 2));
                toggle(stops, stops.last() + pause);
            }
        }
        (2, _) => {
            for _ in 0..=MAX_TRANSITIONS {
                toggle(stops, stops.last() + Time::from_fs(draw.below(100)));
            }
        }
        (_, Some(ones)) if quiet => toggle(stops, coming - delays.arrivals()[ones as usize - 1]),
        _ => {
            let coming = stops.edge(line + draw.below(3) as usize + 1);
            toggle(stops, stops.before(coming, delays, draw));
        }
    }
}
