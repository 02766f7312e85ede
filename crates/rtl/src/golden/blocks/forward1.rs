//! Histograms as the estimator feeds them, control signals in any order with every row, and one row
//! over and over until the sums of all neurons have wrapped both ways.

use std::sync::Arc;

use tofsim::firmware::forward1::{BIAS_ROW, In, Rom};

use crate::golden::prelude::*;

/// Cycles in one style.
const STRETCH: u64 = 512;
/// A change of a sum that is larger than any product: it has wrapped.
const WRAP: i64 = 1 << 34;
/// Cycles that a goal of wrapping may take; smaller weights would take longer.
const PATIENCE: i64 = 1000;

pub(super) const SPEC: Spec = Spec {
    stream: Some(7),
    reset: Some("rst"),
    latency: &[
        Latency { from: "count", to: "l1_in_0", cycles: |_| 0 },
        Latency { from: "rom_addr", to: "l1_in_0", cycles: |_| 1 },
    ],
    ..Spec::new("forward1", "depth_estimator.forward1", record::<Forward1>)
};

struct Forward1 {
    rom: Arc<Rom>,
    neurons: usize,
    /// Row of the strongest weight for each goal of `wraps`.
    strongest: Vec<u64>,
    wraps: Cover,
    rows: Cover,
    situations: Cover,
    sequence: Cover,
}

impl Block for Forward1 {
    type Stimulus = In;

    fn new(setting: &Setting) -> Self {
        let rom = setting.setup.params.depth_estimator.forward1.clone();
        let pull = |goal: u64, row: u64| {
            let weight = rom[row as usize][goal as usize / 2].get();
            if goal.is_multiple_of(2) { weight } else { -weight }
        };
        let rows = 0..BIAS_ROW as u64;
        let best = |goal| rows.clone().max_by_key(|&row| pull(goal, row)).unwrap_or_default();
        let neurons = setting.neurons();
        let goals = 0..2 * neurons as u64;
        let strongest: Vec<_> = goals.clone().map(best).collect();
        let feasible =
            |goal: &u64| pull(*goal, strongest[*goal as usize]) * PATIENCE * 65_535 > 2 * WRAP;
        Forward1 {
            wraps: Cover::new("sum wraps, neuron x 2 + downwards", goals.filter(feasible)),
            rows: Cover::new("rom_addr", 0..512),
            situations: Cover::new("rst, forward1_en, read_en, read_addr is 0 as bits", 0..16),
            sequence: Cover::new("words of a whole histogram", 0..=BIAS_ROW as u64),
            strongest,
            rom,
            neurons,
        }
    }

    fn stimulus(&mut self, cycle: usize, _: &TofTop, draw: &mut Draw) -> In {
        let (stretch, place) = (cycle as u64 / STRETCH, cycle as u64 % STRETCH);
        let count = match draw.below(4) {
            0 => U::MAX,
            1 => U::new(draw.below(300)),
            _ => draw.word(),
        };
        let any = In {
            rst: draw.one_in(16),
            forward1_en: !draw.one_in(3),
            read_en: draw.one_in(2),
            read_addr: U::new(draw.bits() & if draw.one_in(3) { 0 } else { 0xff }),
            rom_addr: if draw.one_in(2) { U::new(cycle as u64) } else { draw.word() },
            count,
        };
        let i = match (stretch % 4, self.wraps.missing().next()) {
            (0, _) if place <= BIAS_ROW as u64 + 1 => {
                // Weights are fetched a cycle ahead.
                let (word, next) = (place.wrapping_sub(1), if place > 256 { 0 } else { place });
                self.sequence.see_if(place > 0, word);
                In {
                    rst: false,
                    forward1_en: true,
                    read_en: word != BIAS_ROW as u64,
                    read_addr: U::new(word),
                    rom_addr: U::new(next),
                    count,
                }
            }
            (2 | 3, Some(goal)) => In {
                rst: false,
                forward1_en: true,
                read_en: true,
                read_addr: U::new(1 + draw.below(255)),
                rom_addr: U::new(self.strongest[goal as usize]),
                count: U::MAX,
            },
            _ => any,
        };
        self.situations.see(bits([i.rst, i.forward1_en, i.read_en, i.read_addr == 0]));
        self.rows.see_if(!i.rst, i.rom_addr.get());
        i
    }

    fn edge(&mut self, i: &In, top: &mut TofTop) {
        let forward1 = &mut top.depth_estimator.forward1;
        let before = forward1.l1_in;
        *forward1 = forward1.next(i, &self.rom);
        let goes_on = i.forward1_en && !i.rst && i.read_addr != 0;
        for (neuron, (after, before)) in forward1.l1_in.iter().zip(before).enumerate() {
            let change = after.get() - before.get();
            self.wraps.see_if(goes_on && change < -WRAP, 2 * neuron as u64);
            self.wraps.see_if(goes_on && change > WRAP, 2 * neuron as u64 + 1);
        }
    }

    fn parameters(&self) -> Parameters {
        parameters::with_neurons(files(["W1File", "B1File"], mem::forward1(&self.rom, self.neurons)), self.neurons)
    }

    fn coverage(self) -> Vec<Cover> {
        vec![self.wraps, self.rows, self.situations, self.sequence]
    }
}
