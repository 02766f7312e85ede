//! Activations of the whole range in the estimator's order and in any, and one product over and over
//! until the depth has wrapped both ways; with the scenario's network, but the bias negative.

use tofsim::firmware::forward2::{In, L1Out, MOST_NEURONS, Rom};

use crate::golden::prelude::*;

/// Cycles in one style.
const STRETCH: usize = 512;
/// A change of the depth that is larger than any product: it has wrapped.
const WRAP: i64 = 1 << 34;

pub(super) const SPEC: Spec = Spec {
    stream: Some(8),
    reset: Some("rst"),
    latency: &[Latency { from: "l1_out_0", to: "depth", cycles: |_| 0 }],
    ..Spec::new("forward2", "depth_estimator.forward2", record::<Forward2>)
};

struct Forward2 {
    rom: Rom,
    /// Neuron of the strongest weight but the first, which would begin the sum anew.
    strongest: usize,
    /// Values that `neuron` can have.
    values: u64,
    /// Neuron of the cycle before, if it was added.
    last: Option<u64>,
    neurons: Cover,
    order: Cover,
    wraps: Cover,
}

impl Forward2 {
    /// Activations of all neurons, of every size.
    fn activations(&self, draw: &mut Draw) -> [L1Out; MOST_NEURONS] {
        let mut l1_out = [S::new(0); MOST_NEURONS];
        l1_out[..self.rom.neurons].fill_with(|| draw.signed());
        l1_out
    }
}

impl Block for Forward2 {
    type Stimulus = In;

    fn new(setting: &Setting) -> Self {
        let mut rom = setting.setup.params.depth_estimator.forward2;
        rom.b2 = S::new(-rom.b2.get().abs());
        let values = (rom.neurons + 2).next_power_of_two() as u64;
        let strength = |neuron: &usize| rom.w2[*neuron].get().abs();
        Forward2 {
            strongest: (1..rom.neurons).max_by_key(strength).unwrap_or_default(),
            values,
            rom,
            last: None,
            neurons: Cover::new("(rst x 2 + forward2_en) x values + neuron", 0..4 * values),
            order: Cover::new("neuron from x values + to, both enabled", 0..values * values),
            wraps: Cover::new("depth wraps upwards, downwards", 0..2),
        }
    }

    fn stimulus(&mut self, cycle: usize, _: &TofTop, draw: &mut Draw) -> In {
        let any = In {
            rst: draw.one_in(8),
            forward2_en: !draw.one_in(4),
            neuron: U::new(draw.bits() % self.values),
            l1_out: self.activations(draw),
        };
        let goal = self.wraps.missing().next();
        let i = match (cycle / STRETCH % 4, goal) {
            (1, _) => {
                let bias = self.rom.neurons as u64;
                let neuron = U::new((cycle as u64 % (bias + 4)) % self.values);
                In { rst: false, forward2_en: neuron.get() < bias + 2, neuron, ..any }
            }
            (2 | 3, Some(goal)) => {
                let up = (self.rom.w2[self.strongest].get() > 0) == (goal == 0);
                let mut l1_out = any.l1_out;
                l1_out[self.strongest] = S::new(if up { 32_767 } else { -32_768 });
                let neuron = U::new(self.strongest as u64);
                In { rst: false, forward2_en: true, neuron, l1_out }
            }
            _ => any,
        };
        self.neurons.see(bits([i.rst, i.forward2_en]) * self.values + i.neuron.get());
        let now = (i.forward2_en && !i.rst).then(|| i.neuron.get());
        if let (Some(last), Some(now)) = (self.last, now) {
            self.order.see(last * self.values + now);
        }
        self.last = now;
        i
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        let forward2 = &mut top.depth_estimator.forward2;
        let before = forward2.depth;
        *forward2 = forward2.next(i, &self.rom);
        let change = forward2.depth.get() - before.get();
        let goes_on = i.forward2_en && !i.rst && i.neuron != 0;
        self.wraps.see_if(goes_on && change < -WRAP, 0);
        self.wraps.see_if(goes_on && change > WRAP, 1);
    }

    fn parameters(&self) -> Parameters {
        parameters::with_neurons(files(["W2File", "B2File"], mem::forward2(&self.rom)), self.rom.neurons)
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.neurons, self.order, self.wraps]
    }
}
