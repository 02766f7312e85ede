//! Histograms as the estimator feeds them, control signals in any order with every row, and one row
//! over and over until the sums of all neurons have wrapped both ways.

use tofsim::firmware::forward1::In;

use crate::golden::prelude::*;

/// Cycles in one style.
const STRETCH: u64 = 512;
/// Cycles that a goal of wrapping may take; smaller weights would take longer.
const PATIENCE: i64 = 1000;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[
        Latency { from: "count", to: "l1_in_0", cycles: |_| 2 },
        Latency { from: "rom_addr", to: "l1_in_0", cycles: |_| 3 },
    ],
    configurations: &[NEURONS_16, NEURONS_31],
    model: Some(Model::new::<In>(|at| {
        at.top.depth_estimator.forward1.tick(&at.input(), &at.params.estimators.depth_estimator.forward1);
    })),
    ..Spec::new("forward1", "depth_estimator.forward1", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let (rom, neurons) = (&setting.setup.params.estimators.depth_estimator.forward1, setting.neurons());
    let size = setting.histogram();
    let (words, most) = (size.bins as u64, size.most_hits());
    let stretch_of = STRETCH.max(2 * words);
    // A change of a sum that is larger than any product: it has wrapped.
    let wrap = 1i64 << (rom.sum_bits() - 2);
    let pull = |goal: u64, row: u64| {
        let weight = rom.w1[row as usize][goal as usize / 2].get();
        if goal.is_multiple_of(2) { weight } else { -weight }
    };
    // Row of the strongest weight for each goal of `wraps`.
    let best = |goal| (0..words).max_by_key(|&row| pull(goal, row)).unwrap_or_default();
    let goals = 0..2 * neurons as u64;
    let strongest: Vec<_> = goals.clone().map(best).collect();
    let feasible =
        |goal: &u64| pull(*goal, strongest[*goal as usize]) * PATIENCE * most as i64 > 2 * wrap;
    let mut wraps = Cover::new("sum wraps, neuron x 2 + downwards", goals.filter(feasible));
    let mut rows = Cover::new("rom_addr", 0..words);
    let mut situations = Cover::new("rst, forward1_first, forward1_en as bits", 0..8);
    let mut sequence = Cover::new("words of a whole histogram", 0..words);
    let mut run = Recorder::new(spec, setting, In::list());
    for cycle in 0..setting.cycles() as u64 {
        let (stretch, place, draw) = (cycle / stretch_of, cycle % stretch_of, &mut run.draw);
        let count = match draw.below(4) {
            0 => U::new(most),
            1 => U::new(draw.below(300) & most),
            _ => U::new(draw.bits() & most),
        };
        let any = In {
            rst: draw.one_in(16),
            forward1_first: draw.one_in(3),
            forward1_en: !draw.one_in(3),
            rom_addr: U::new(if draw.one_in(2) { cycle } else { draw.bits() } % words),
            count,
        };
        let i = match (stretch % 4, wraps.missing().next()) {
            (0, _) if place <= words + 2 => {
                // A weight is fetched a cycle ahead of its word, and added with it two cycles later.
                let added = place.checked_sub(3);
                added.into_iter().for_each(|word| sequence.see(word));
                In {
                    rst: false,
                    forward1_first: added == Some(0),
                    forward1_en: added.is_some(),
                    rom_addr: U::new(place % words),
                    count,
                }
            }
            (2 | 3, Some(goal)) => In {
                rst: false,
                forward1_first: false,
                forward1_en: true,
                rom_addr: U::new(strongest[goal as usize]),
                count: U::new(most),
            },
            _ => any,
        };
        let i = In { rst: i.rst || cycle == FIRST_RESET as u64, ..i };
        situations.see(bits([i.rst, i.forward1_first, i.forward1_en]));
        rows.see_if(!i.rst, i.rom_addr.get());
        run.line(&i);
        let forward1 = &mut run.top.depth_estimator.forward1;
        let before = forward1.l1_in;
        *forward1 = forward1.next(&i, rom);
        let goes_on = i.forward1_en && !i.rst && !i.forward1_first;
        for (neuron, (after, before)) in forward1.l1_in.iter().zip(before).enumerate() {
            let change = after.get() - before.get();
            wraps.see_if(goes_on && change < -wrap, 2 * neuron as u64);
            wraps.see_if(goes_on && change > wrap, 2 * neuron as u64 + 1);
        }
    }
    let memories = files(["W1File", "B1File"], mem::forward1(rom, neurons, setting.datapath()));
    Ok(run.vectors([wraps, rows, situations, sequence]).with(memories))
}
