//! Whole estimations of histograms, which the bench reads out as the histogram builder would:
//! empty, level, as measured, random, and all hits in one bin such that each neuron saturates at
//! either end; starts while busy, and a reset in each layer.

use tofsim::firmware::depth_estimator::In;

use crate::golden::estimations::{Estimations, memory};
use crate::golden::prelude::*;

mod histograms;

pub(super) const SPEC: Spec = Spec {
    reset: Some("rst"),
    latency: &[Latency { from: "algo_start", to: "algo_done", cycles: |vectors| vectors.sizes.network_cycles.into() }],
    glue: Some(histograms::GLUE),
    configurations: &[NEURONS_16, NEURONS_31],
    model: Some(Model::new::<In>(|at| {
        at.top.depth_estimator.rise(&at.input(), &at.params.estimators.depth_estimator);
    })),
    ..Spec::new("depth_estimator", "depth_estimator", record)
};

signals! {
    /// Input ports, and what the bench reads `count` from.
    struct Stimulus {
        /// Synchronous reset.
        rst: bool,
        /// Starts an estimation.
        algo_start: bool,
        /// Number of the histogram in the memory.
        histogram: U<7>,
    }
}

fn record(spec: &'static Spec, setting: &Setting) -> Result<Vectors> {
    let (params, neurons) = (&setting.setup.params.estimators.depth_estimator, setting.neurons());
    let mut draw = Draw::new(setting.seed, MEMORIES);
    let (size, ctrl) = (setting.histogram(), params.ctrl());
    let (histograms, special, ends) = histograms::new(params, &size, &mut draw);
    // Words, the products that they leave behind, tansig, output layer.
    let (bins, tansig) = (size.bins as u64, ctrl.tansig());
    let layers = [0..bins, bins..tansig, tansig..tansig + 2, tansig + 2..params.ctrl().done()];
    let mut estimations = Estimations::new(layers, histograms.len(), special, setting);
    let mut ends = Cover::new("neuron x entries + address at either end of the tansig", ends);
    let mut run = Recorder::new(spec, setting, Stimulus::list());
    // One in six is cut short, and some are begun late.
    let whole = special as usize * (ctrl.done() as usize + 4) * 5 / 4;
    for _ in 0..setting.cycles.unwrap_or(whole.max(Setting::CYCLES)) {
        let estimator = &mut run.top.depth_estimator;
        let phase = estimator.estimator_ctrl.phase(&ctrl);
        let (rst, algo_start) = estimations.next(phase, &mut run.draw);
        if estimator.estimator_ctrl.tansig_en && !rst {
            for (neuron, &l1_in) in estimator.forward1.l1_in[..neurons].iter().enumerate() {
                let entries = params.tansig.entries.len();
                ends.see((neuron * entries + params.tansig.address(l1_in)) as u64);
            }
        }
        let i = Stimulus { rst, algo_start, histogram: U::new(estimations.histogram) };
        run.line(&i);
        let estimator = &mut run.top.depth_estimator;
        let ctrl = &estimator.estimator_ctrl;
        let word = histograms[i.histogram.index()][ctrl.read_addr.index()];
        let count = if ctrl.read_en { word } else { U::new(0) };
        estimator.rise(&In { rst, algo_start, count }, params);
    }
    Ok(Vectors {
        bench_memory: Some(memory(&histograms, &size)),
        ..run
            .vectors([vec![ends], estimations.coverage().into()].concat())
            .with(parameters::depth_estimator(params))
    })
}
