//! Activations of the whole range in the estimator's order and in any, and one product over and over
//! until the depth has wrapped both ways by either unit; with the scenario's network, but the bias
//! negative.

use tofsim::firmware::forward2::{In, MOST_NEURONS};
use tofsim::kernel::wrapped;

use crate::golden::prelude::*;

/// Cycles in one style.
const STRETCH: usize = 512;
/// A change of the depth that is larger than any two products: it has wrapped.
const WRAP: i64 = 1 << 34;
/// Cycles that a goal of wrapping may take; smaller weights would take longer.
const PATIENCE: i64 = 1000;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        Latency { from: "l1_out_0", to: "depth", cycles: |_| 3 },
        Latency { from: "depth_en", to: "depth", cycles: |_| 0 },
    ],
    configurations: &[NEURONS_16, NEURONS_31],
    model: Some(Model::new::<In>(|at| {
        at.top.depth_estimator.forward2.tick(&at.input(), &at.params.estimators.depth_estimator.forward2);
    })),
    ..Spec::new("forward2", "depth_estimator.forward2", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut rom = setting.setup.params.estimators.depth_estimator.forward2;
    if !setting.constants.has("B2File") {
        rom.b2 = S::new(-rom.b2.get().abs());
    }
    // Neuron of the strongest weight of each unit.
    let strength = |neuron: &usize| rom.w2[*neuron].get().abs();
    let strongest = |unit: usize| (unit..rom.neurons).step_by(2).max_by_key(strength);
    let (units, pairs) = (rom.neurons.min(2) as u64, rom.neurons.div_ceil(2) as u64);
    let activation = rom.datapath.l1_out;
    let feasible = |goal: &u64| {
        let weight = strongest(*goal as usize / 2).map_or(0, |neuron| rom.w2[neuron].get().abs());
        rom.datapath.depth(weight * activation.max()) * PATIENCE > 2 * WRAP
    };
    // Values that `pair` can have.
    let all_pairs = 1 << setting.setup.params.sizes().of(Size::PairBits);
    let mut situations = Cover::new(
        "rst, forward2_first, forward2_en, depth_en as bits x pairs + pair",
        0..16 * all_pairs,
    );
    let mut order = Cover::new("pair from x pairs + to, added one after the other", 0..all_pairs * all_pairs);
    let mut wraps = Cover::new("depth wraps, unit x 2 + downwards", (0..2 * units).filter(feasible));
    let mut run = Recorder::new(spec, setting, In::list());
    // Pair of the line before.
    let mut last = U::new(0);
    // More situations take more lines.
    let lines = Setting::CYCLES / 8 * all_pairs as usize;
    for cycle in 0..setting.cycles.unwrap_or(lines) {
        let draw = &mut run.draw;
        let mut any = In {
            rst: draw.one_in(8),
            pair: U::new(draw.bits() % all_pairs),
            forward2_first: draw.one_in(4),
            forward2_en: !draw.one_in(4),
            depth_en: draw.one_in(2),
            l1_out: [S::new(0); MOST_NEURONS],
        };
        let word = || S::new(wrapped(draw.signed_of(activation.width), activation.width));
        any.l1_out[..rom.neurons].fill_with(word);
        let goal = wraps.missing().next().filter(|_| cycle / STRETCH % 4 > 1);
        let i = match (cycle / STRETCH % 4, goal) {
            (1, _) => {
                let place = cycle as u64 % (pairs + 4);
                In {
                    rst: false,
                    pair: U::new(if place < pairs { place } else { 0 }),
                    forward2_first: place == 2,
                    forward2_en: (2..pairs + 2).contains(&place),
                    depth_en: place == pairs + 2,
                    ..any
                }
            }
            (_, Some(goal)) => {
                let neuron = strongest(goal as usize / 2).unwrap_or_default();
                let up = (rom.w2[neuron].get() > 0) == goal.is_multiple_of(2);
                any.l1_out = [S::new(0); MOST_NEURONS];
                any.l1_out[neuron] = S::new(if up { activation.max() } else { activation.min() });
                In {
                    rst: false,
                    pair: U::new(neuron as u64 / 2),
                    forward2_first: false,
                    forward2_en: true,
                    depth_en: true,
                    ..any
                }
            }
            _ => any,
        };
        let i = In { rst: i.rst || cycle == FIRST_RESET, ..i };
        let control = bits([i.rst, i.forward2_first, i.forward2_en, i.depth_en]);
        situations.see(control * all_pairs + i.pair.get());
        order.see(last.get() * all_pairs + i.pair.get());
        last = i.pair;
        run.line(&i);
        let forward2 = &mut run.top.depth_estimator.forward2;
        let before = forward2.depth;
        *forward2 = forward2.next(&i, &rom);
        let change = forward2.depth.get() - before.get();
        if let Some(goal) = goal {
            let far = if goal.is_multiple_of(2) { change < -WRAP } else { change > WRAP };
            wraps.see_if(far && !i.rst, goal);
        }
    }
    let memories = files(["W2File", "B2File"], mem::forward2(&rom));
    Ok(run.vectors([situations, order, wraps]).with(memories))
}
