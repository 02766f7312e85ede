//! Activations of the whole range in the estimator's order and in any, and one product over and over
//! until the depth has wrapped both ways; with the scenario's network, but the bias negative.

use tofsim::firmware::forward2::{In, MOST_NEURONS};

use crate::golden::prelude::*;

/// Cycles in one style.
const STRETCH: usize = 512;
/// A change of the depth that is larger than any product: it has wrapped.
const WRAP: i64 = 1 << 34;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[Latency { from: "l1_out_0", to: "depth", cycles: |_| 0 }],
    configurations: &[NEURONS_16],
    ..Spec::new("forward2", "depth_estimator.forward2", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let mut rom = setting.setup.params.depth_estimator.forward2;
    if !setting.constants.has("B2File") {
        rom.b2 = S::new(-rom.b2.get().abs());
    }
    // Neuron of the strongest weight but the first, which would begin the sum anew.
    let strength = |neuron: &usize| rom.w2[*neuron].get().abs();
    let strongest = (1..rom.neurons).max_by_key(strength).unwrap_or_default();
    // Values that `neuron` can have.
    let values = (rom.neurons + 2).next_power_of_two() as u64;
    let mut neurons = Cover::new("(rst x 2 + forward2_en) x values + neuron", 0..4 * values);
    let mut order = Cover::new("neuron from x values + to, both enabled", 0..values * values);
    let mut wraps = Cover::new("depth wraps upwards, downwards", 0..2);
    let mut run = Recorder::new(spec, setting, In::list());
    // Neuron of the cycle before, if it was added.
    let mut last = None;
    // Pairs of neurons come by chance.
    let lines = Setting::CYCLES.max(32 * (values * values) as usize);
    for cycle in 0..setting.cycles.unwrap_or(lines) {
        let draw = &mut run.draw;
        let mut any = In {
            rst: draw.one_in(8),
            forward2_en: !draw.one_in(4),
            neuron: U::new(draw.bits() % values),
            l1_out: [S::new(0); MOST_NEURONS],
        };
        any.l1_out[..rom.neurons].fill_with(|| draw.signed());
        let i = match (cycle / STRETCH % 4, wraps.missing().next()) {
            (1, _) => {
                let bias = rom.neurons as u64;
                let neuron = U::new((cycle as u64 % (bias + 4)) % values);
                In { rst: false, forward2_en: neuron.get() < bias + 2, neuron, ..any }
            }
            (2 | 3, Some(goal)) => {
                let up = (rom.w2[strongest].get() > 0) == (goal == 0);
                any.l1_out[strongest] = S::new(if up { 32_767 } else { -32_768 });
                In { rst: false, forward2_en: true, neuron: U::new(strongest as u64), ..any }
            }
            _ => any,
        };
        let i = In { rst: i.rst || cycle == FIRST_RESET, ..i };
        neurons.see(bits([i.rst, i.forward2_en]) * values + i.neuron.get());
        let now = (i.forward2_en && !i.rst).then(|| i.neuron.get());
        if let (Some(last), Some(now)) = (last, now) {
            order.see(last * values + now);
        }
        last = now;
        run.line(&i);
        let forward2 = &mut run.top.depth_estimator.forward2;
        let before = forward2.depth;
        *forward2 = forward2.next(&i, &rom);
        let change = forward2.depth.get() - before.get();
        let goes_on = i.forward2_en && !i.rst && i.neuron != 0;
        wraps.see_if(goes_on && change < -WRAP, 0);
        wraps.see_if(goes_on && change > WRAP, 1);
    }
    let parameters = with_neurons(files(["W2File", "B2File"], mem::forward2(&rom)), rom.neurons);
    Ok(Vectors { parameters, ..run.vectors([neurons, order, wraps]) })
}
