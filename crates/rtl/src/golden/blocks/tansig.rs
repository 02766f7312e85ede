//! The lowest, the highest and any sum of each address, for each neuron apart from the others; sums
//! beyond both ends of the table.

use tofsim::firmware::forward1::L1In;
use tofsim::firmware::forward2::MOST_NEURONS;
use tofsim::firmware::tansig::{In, Rom};

use crate::golden::prelude::*;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[Latency { from: "l1_in_0", to: "l1_out_0", cycles: |_| 1 }],
    configurations: &[NEURONS_16, NEURONS_31],
    model: Some(Model::new::<In>(|at| {
        at.top.depth_estimator.tansig.tick(&at.input(), &at.params.estimators.depth_estimator.tansig);
    })),
    ..Spec::new("tansig", "depth_estimator.tansig", record)
};

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let (rom, neurons) = (&setting.setup.params.estimators.depth_estimator.tansig, setting.neurons());
    let sums = &setting.setup.params.estimators.depth_estimator.forward1;
    let (width, entries) = (sums.sum_bits(), rom.entries.len());
    let (half, step) = (entries as i64 / 2, 1i64 << rom.shift);
    // Just beyond the rounded ends of the table, and the ends of the word.
    let end = 1 << (width - 1);
    let beyond_ends = [-half * step - step / 2 - 1, half * step - step / 2, -end, end - 1];
    let cases = (neurons * entries) as u64;
    let mut lowest = Cover::new("lowest sum of neuron x entries + address", 0..cases);
    let mut highest = Cover::new("highest sum of neuron x entries + address", 0..cases);
    let mut beyond = Cover::new(
        "neuron x 4 + just below, just above, lowest, highest of all",
        0..neurons as u64 * 4,
    );
    let mut situations = Cover::new("rst, tansig_en, tansig_en before as bits", 0..8);
    let mut run = Recorder::new(spec, setting, In::list());
    let (mut swept, mut before) = (0, false);
    for cycle in 0..setting.cycles() {
        let draw = &mut run.draw;
        let (rst, tansig_en, special) = (draw.one_in(32), !draw.one_in(4), draw.one_in(8));
        let rst = rst || cycle == FIRST_RESET;
        let mut l1_in = [S::new(0); MOST_NEURONS];
        for (neuron, sum) in l1_in[..neurons].iter_mut().enumerate() {
            *sum = match (special, draw.below(3)) {
                (true, 0) => sums.sum(draw.signed_of(width)),
                (true, _) => S::new(beyond_ends[draw.below(beyond_ends.len() as u64) as usize]),
                (false, _) => sweep(rom, swept, neuron, draw),
            };
        }
        situations.see(bits([rst, tansig_en, before]));
        before = tansig_en && !rst;
        if tansig_en && !rst {
            for (neuron, &l1_in) in l1_in[..neurons].iter().enumerate() {
                let case = (neuron * entries + rom.address(l1_in)) as u64;
                let offset = (l1_in.get() + step / 2).rem_euclid(step);
                let inside = (-half * step..half * step).contains(&(l1_in.get() + step / 2));
                lowest.see_if(inside && offset == 0, case);
                highest.see_if(inside && offset == step - 1, case);
                if let Some(place) = beyond_ends.iter().position(|&sum| sum == l1_in.get()) {
                    beyond.see((neuron * beyond_ends.len() + place) as u64);
                }
            }
            swept += usize::from(!special);
        }
        let i = In { rst, tansig_en, l1_in };
        run.line(&i);
        run.top.depth_estimator.tansig = run.top.depth_estimator.tansig.next(&i, rom);
    }
    let memory = files(["TansigFile"], [mem::tansig(rom, setting.datapath())]);
    Ok(run.vectors([lowest, highest, beyond, situations]).with(memory))
}

/// The sum of a neuron in a line of the sweep: other addresses for other neurons.
fn sweep(rom: &Rom, line: usize, neuron: usize, draw: &mut Draw) -> L1In {
    let (entries, step) = (rom.entries.len(), 1i64 << rom.shift);
    let place = (line * 5 + neuron * 517) % entries;
    let offset = match line / entries {
        0 => -step / 2,
        1 => step / 2 - 1,
        _ => draw.below(step as u64) as i64 - step / 2,
    };
    S::new((place as i64 - entries as i64 / 2) * step + offset)
}
