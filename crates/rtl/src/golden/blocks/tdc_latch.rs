//! Hits with every number of taps, in every order with start, window and reset; levels held over;
//! old pulses beside the hit.

use tofsim::firmware::carry_chain::Taps;
use tofsim::firmware::coarse_counter::Coarse;
use tofsim::firmware::tdc_latch::In;

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        Latency { from: "taps", to: "hit", cycles: |_| 0 },
        Latency { from: "taps", to: "hit_taps", cycles: |_| 0 },
        Latency { from: "coarse", to: "hit_coarse", cycles: |_| 0 },
    ],
    configurations: &[CALIBRATED],
    model: Some(Model::new::<In>(|at| {
        at.top.tdc.tdc_latch.tick(&at.input(), &at.params.tdc.delays.tap_0_position());
    })),
    ..Spec::new("tdc_latch", "tdc.tdc_latch", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    // Place of physical tap 0 in the order of arrival; taps that may be high, and those of the next hit.
    let (tap_0, taps) = (setting.setup.params.tdc.delays.tap_0_position(), setting.places());
    let count = setting.setup.params.tdc.delays.taps();
    let mut rank = tap_0 + 1;
    let ranks = tap_0 as u64 + 1..=taps as u64;
    let mut hits = Cover::new("taps that the rise of a hit has reached", ranks);
    let window = setting.setup.params.tdc.coarse_counter.window();
    let mut coarse = Cover::new("coarse of a hit", ends(window));
    let mut situations = Cover::new("rst, start, window, tap 0, before, used as bits", 0..64);
    let calibrates = setting.setup.params.tdc_calibration.is_some();
    let mut free = Cover::new("while free: window, tap 0, before, used as bits", 0..if calibrates { 16 } else { 0 });

    let mut run = Recorder::new(spec, setting, In::list());
    for cycle in 0..setting.cycles_of_chain() {
        let (latch, draw) = (run.top.tdc.tdc_latch, &mut run.draw);
        let (used, before) = latch.before();
        // A hit at the first edge shows how the registers begin.
        let first = cycle == 0;
        let high = first || draw.one_in(2);
        let i = In {
            rst: cycle == FIRST_RESET || !first && draw.one_in(10),
            start: draw.one_in(3),
            window: first || !draw.one_in(3),
            free: calibrates && !first && draw.one_in(8),
            coarse: any_coarse(window, draw),
            taps: pulses(high, if high { rank } else { tap_0 + 1 }, (taps, count), draw),
        };
        situations.see_if(!i.free, bits([i.rst, i.start, i.window, high, before, used]));
        free.see_if(i.free, bits([i.window, high, before, used]));
        if high && !before && (i.free || i.window && !used) && !i.rst {
            hits.see(rank as u64);
            coarse.see(i.coarse.get());
            rank = if rank == taps { tap_0 + 1 } else { rank + 1 };
        }
        run.line(&i);
        run.top.tdc.tdc_latch = latch.next(&i, &tap_0);
    }
    Ok(run.vectors([hits, coarse, situations, free]))
}

/// A coarse count in a window of so many cycles.
fn any_coarse(window: u64, draw: &mut Draw) -> Coarse {
    Coarse::new(if window > 16 { draw.near_ends(window) } else { draw.bits() % window })
}

/// Taps with tap 0 high or low as those up to `first`, and perhaps a pulse behind, all among the first `taps`
/// of a chain of `count`.
fn pulses(
    high: bool,
    first: usize,
    (taps, count): (usize, usize),
    draw: &mut Draw,
) -> Taps {
    let mut rank = || first + draw.below((taps - first + 1) as u64) as usize;
    let mut behind = [rank(), rank()];
    behind.sort();
    let [begin, end] = behind;
    match (high, draw.one_in(2)) {
        (true, true) => Taps::clipped(count, true, [first]),
        (true, false) => Taps::clipped(count, true, [first, begin, end]),
        (false, true) => Taps::settled(false),
        (false, false) => Taps::clipped(count, false, [begin, end]),
    }
}
